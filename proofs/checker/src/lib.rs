#![doc = "stub"]
pub mod claim;
pub mod enclosure;
pub mod fixed;
pub mod number;
