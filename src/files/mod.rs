//! What is read, and what is written: files and folders that appear whole or not at all, and their digests.

pub mod digest;
pub mod folder;
pub mod open;
pub mod output;
pub mod read;
pub mod shown;
