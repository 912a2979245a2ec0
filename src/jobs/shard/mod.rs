//! Long jobs in parts: shards that any machine can run, and their merging.
//!
//! A job's tree is grown from the root until enough cells wait; these are dealt out to the shards.
//! What becomes of a cell depends on the cell alone, so the parts, put in their places, are byte for
//! byte what one machine would have found. Every file names its job by the SHA-256 of the job's
//! text; results also name the shard that they answer, by the SHA-256 of its file, and carry the
//! SHA-256 of their content. What a shard of a paving found may be larger than memory: it is in a
//! file of its own, whose stretches the result names. What is missing, doubled, altered or of another
//! job is named ([`MergeError`]); and what was merged has still to be accepted by the exact checker
//! as a whole.

mod file;
mod merge;
mod name;
mod paving;
mod run;
mod split;
mod task;

pub use file::{
    read_job, read_shard, sha256, FileError, Job, JobTop, Nodes, Part, Place, Shard, ShardResult,
    Stretch, MAX_SHARDS,
};
pub use merge::{merge, MergeError, Merged, Whole};
pub use name::{name_of, Name, JOB_FILE};
pub use paving::Stretches;
pub use run::{result_file, run, written, Ran, RunError};
pub use split::{split, SplitError};
pub use task::{Pave, Task, Verify};
