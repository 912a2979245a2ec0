//! Certified workspace verification of parallel machines.
//!
//! Nothing in this crate has to be trusted: it reads designs and searches for proofs; what it finds
//! is re-proved in exact arithmetic by [`orthocert_checker`], which never depends on this crate.
//!
//! | module           | does                                                                  |
//! |------------------|-----------------------------------------------------------------------|
//! | [`accepted`]     | accepted certificates, and the size of their proofs                   |
//! | [`arithmetic`]   | arithmetic with the exact numbers of claims                           |
//! | [`atlas`]        | maps which designs of a box of parameters meet their requirements     |
//! | [`attestation`]  | what the checker accepts, as an in-toto statement                     |
//! | [`batch`]        | many designs at once, and reports for continuous integration          |
//! | [`decide`]       | what a decision about a machine amounts to                            |
//! | [`decimal`]      | decimal notation of exact numbers, certified digits                   |
//! | [`design`]       | reads design files, written by people, into claims in exact numbers   |
//! | [`digest`]       | SHA-256 as people and browsers compare it                             |
//! | [`dimensions`]   | the paper's Steps 1 to 3, enclosed                                    |
//! | [`engine`]       | hands the shards of a job to Slurm or HyperQueue                      |
//! | [`escape`]       | text in XML, Markdown and JSON: it stays text                         |
//! | [`exact`]        | exact numbers as they are written                                     |
//! | [`export`]       | writes certificates for the formal checker in Rocq                    |
//! | [`folder`]       | folders that appear whole or not at all                               |
//! | [`frontier`]     | how far a number of a claim goes before its verdict changes           |
//! | [`import`]       | makes design files of the configurations of motion controllers        |
//! | [`largest_cube`] | encloses the side of the largest cube in which a claim holds          |
//! | [`limit`]        | how far one number of a design can go                                 |
//! | [`output`]       | files that appear whole or not at all                                 |
//! | [`page`]         | a certificate as a page to read and to file, and its figures          |
//! | [`paper`]        | the claims of the seed paper, one by one                              |
//! | [`paving`]       | the region of a box where a claim holds, from within and from without |
//! | [`placement`]    | the best place for a cube, as it seems                                |
//! | [`postulate`]    | proves the Q1/Q2 postulate for one psi_max, a range, or every one     |
//! | [`report`]       | what a verification found, for people and for scripts                 |
//! | [`search`]       | what a search may take, and how it ends                              |
//! | [`shard`]        | long jobs in parts: shards, their results, their merging              |
//! | [`size`]         | the smallest machine for an axis-aligned cube of a given side         |
//! | [`solver`]       | decides claims about machines of every kind; encloses extremes        |
//! | [`summary`]      | what a designer reads first: how far quantities go, the nearest limit |
//! | [`tolerance`]    | the widest tolerances with which a design is still certified          |

#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_macros))]

pub mod accepted;
pub mod arithmetic;
pub mod atlas;
pub mod attestation;
pub mod batch;
pub mod decide;
pub mod decimal;
pub mod design;
pub mod digest;
pub mod dimensions;
pub mod engine;
pub mod escape;
pub mod exact;
pub mod export;
pub mod folder;
pub mod frontier;
pub mod import;
pub mod largest_cube;
pub mod limit;
pub mod output;
pub mod page;
pub mod paper;
pub mod paving;
pub mod placement;
pub mod postulate;
pub mod report;
pub mod search;
pub mod shard;
pub mod size;
pub mod solver;
pub mod summary;
pub mod tolerance;
