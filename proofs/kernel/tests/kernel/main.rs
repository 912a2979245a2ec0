//! The kernel: arithmetic and lemmas on random and adverse inputs, claims proved and refuted by a small
//! search in doubles, and what has to be rejected.

mod arithmetic;
mod atlas;
mod certificates;
mod leaves;
mod machines;
mod no_cube;
mod postulate;
mod prover;
mod regions;
mod rejected;
mod rough;
mod slopes;
mod statements;
mod witnesses;
