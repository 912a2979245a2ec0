//! Certified workspace verification of translational parallel machines.
//!
//! Nothing in this crate has to be trusted: it reads designs and searches for proofs; what it finds
//! is re-proved in exact arithmetic by [`orthocert_checker`], which never depends on this crate.
//!
//! | module       | does                                                                    |
//! |--------------|-------------------------------------------------------------------------|
//! | [`design`]   | reads design files, written by people, into claims in exact numbers     |
//! | [`import`]   | makes design files of the configurations of motion controllers          |
//! | [`interval`] | floating-point intervals and approximations for the search              |
//! | [`sample`]   | looks around: approximate values at single points and machines          |
//! | [`machine`]  | the machine's obligations and the rules that may discharge them         |
//! | [`postulate`]| proves the Q1/Q2 postulate for one psi_max, a range, or every one       |
//! | [`refute`]   | turns a place where a requirement seems to fail into an exact witness   |
//! | [`rotation`] | finds the orthogonal matrix that the vertex rule takes as evidence      |
//! | [`search`]   | branch and bound: finds a bisection tree that discharges everything     |
//! | [`verify`]   | decides a claim: certified, refuted, or undecided                       |

pub mod design;
pub mod import;
pub mod interval;
pub mod machine;
pub mod postulate;
pub mod refute;
pub mod rotation;
pub mod sample;
pub mod search;
pub mod verify;
