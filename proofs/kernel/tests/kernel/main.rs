//! The kernel: arithmetic and lemmas on random and adverse inputs, claims proved and refuted by a small
//! search in doubles, and what has to be rejected.

mod accuracies;
mod arithmetic;
mod certificates;
mod clearances;
mod directions;
mod false_claims;
mod leaves;
mod machines;
mod prover;
mod quantities;
mod rejected;
mod rough;
mod slopes;
mod statements;
mod witnesses;
