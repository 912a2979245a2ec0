//! Certified workspace verification of parallel machines.
//!
//! Nothing in this crate has to be trusted: it reads designs and searches for proofs; what it finds
//! is re-proved in exact arithmetic by [`orthocert_checker`], which never depends on this crate.
//!
//! | module        | does                                                                  |
//! |---------------|-----------------------------------------------------------------------|
//! | [`exact`]     | exact numbers as they are written, their decimals and arithmetic      |
//! | [`design`]    | reads design files, written by people, into claims in exact numbers   |
//! | [`import`]    | makes design files of the configurations of motion controllers        |
//! | [`search`]    | branch and bound: evidence, sampling, refutation, proofs and pavings  |
//! | [`questions`] | what people ask: limits, tolerances, sizes, atlases, the paper        |
//! | [`report`]    | what was found, for people and for scripts                            |
//! | [`jobs`]      | many designs and long work: batches, shards, engines, attestations    |
//! | [`files`]     | files and folders that appear whole or not at all                     |
//! | `cli`         | the commands of the program, with the feature `command-line`          |

#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_macros))]

#[cfg(feature = "command-line")]
pub mod cli;
pub mod design;
pub mod exact;
pub mod files;
pub mod import;
pub mod jobs;
pub mod questions;
pub mod report;
pub mod search;
