//! Many designs, and long work in parts: on any machines, in continuous integration, for auditors.
//!
//! | module          | does                                                         |
//! |-----------------|--------------------------------------------------------------|
//! | [`attestation`] | what the checker accepts, as an in-toto statement            |
//! | [`batch`]       | many designs at once, and reports for continuous integration |
//! | [`engine`]      | hands the shards of a job to Slurm or HyperQueue             |
//! | [`shard`]       | long jobs in parts: shards, their results, their merging     |

pub mod attestation;
pub mod batch;
pub mod engine;
pub mod shard;
