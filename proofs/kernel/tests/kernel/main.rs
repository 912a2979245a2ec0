//! The kernel: arithmetic and lemmas on random and adverse inputs, claims proved and refuted by a small
//! search in doubles, and what has to be rejected.

mod accuracies;
mod arithmetic;
mod atlas;
mod certificates;
mod clearances;
mod controls;
mod cuts;
mod directions;
mod document;
mod false_claims;
mod false_poses;
mod for_all;
mod leaves;
mod machines;
mod modules;
mod motions;
mod no_cube;
mod oracle;
mod pavings;
mod poses;
mod postulate;
mod prover;
mod quantities;
mod rejected;
mod rocq;
mod rough;
mod sampled;
mod singular;
mod slopes;
mod statements;
mod tolerances;
mod turned;
mod turned_atlas;
mod turning;
mod witnesses;
