//! The sources of this crate, by whose digest reports name the checker.

/// Every file of `src`, with its path there, in the order of the paths' bytes; listed by `build.rs`.
pub const SOURCES: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/sources.rs"));
