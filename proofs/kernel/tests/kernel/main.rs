//! The kernel: arithmetic and lemmas on random and adverse inputs, claims proved and refuted by a small
//! search in doubles, and what has to be rejected.

mod arithmetic;
mod certificates;
mod controls;
mod leaves;
mod machines;
mod motions;
mod prover;
mod rejected;
mod rough;
mod sampled;
mod slopes;
mod statements;
mod turned;
mod turning;
mod witnesses;
