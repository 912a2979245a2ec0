//! Certified workspace verification of translational parallel machines.
//!
//! Nothing in this crate has to be trusted: it reads designs and searches for proofs; what it finds
//! is re-proved in exact arithmetic by [`orthocert_checker`], which never depends on this crate.
//!
//! | module | does |
//! |---|---|
//! | [`design`] | reads design files, written by people, into claims in exact numbers |

pub mod design;
