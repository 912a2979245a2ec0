//! stub
pub mod interval;
pub mod refute;
pub mod rotation;
pub mod sample;
pub mod search;
pub mod verify;
