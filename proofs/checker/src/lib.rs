//! Exact, independent checker of orthocert certificates.
//!
//! A certificate states a theorem about a translational parallel machine (its [`claim`]) and an
//! argument for it or against it. [`read`] and [`check`](fn@check) accept it only if the argument,
//! recomputed from the claim in integer arithmetic, is complete. There is no floating point and no
//! `unsafe` here, and nothing of the program that searched for the proof.
//!
//! | module          | holds                                                                  |
//! |-----------------|------------------------------------------------------------------------|
//! | [`number`]      | exact real numbers as written: rationals, expressions with roots       |
//! | [`claim`]       | the theorem: mechanism, workspace, requirements                        |
//! | [`certificate`] | the format: tree, steps, witness                                       |
//! | [`fixed`]       | fixed-point intervals over big integers                                |
//! | [`enclosure`]   | the arithmetic that formulas are written in                            |
//! | [`linear`]      | vectors and 3x3 matrices                                               |
//! | [`kernel`]      | certificates of the kernel, which are about any mechanism              |
//! | [`kinematics`]  | legs: row of `M = J^-1`, joint coordinate, slopes                      |
//! | [`model`]       | a claim's numbers, enclosed                                            |
//! | [`cell`]        | boxes of the bisection tree                                            |
//! | [`hull`]        | the vertices between which a cell's points lie                         |
//! | [`expansion`]   | `M` over a cell, as a point value and slopes                           |
//! | [`definite`]    | positive definiteness of interval matrices                             |
//! | [`rule`]        | the rules, each with its lemma and proof                               |
//! | [`trig`]        | cosines and sines of degrees, enclosed                                 |
//! | [`witness`]     | refutations                                                            |
//! | [`word`]        | fixed-point intervals over machine words, as [`fixed`] but faster      |
//! | [`statement`]   | the claim in words                                                     |
//! | [`file`](mod@file) | reading files: regular ones, and no more of them than is admissible |
//! | [`shown`]       | names and texts of strangers, as a terminal may be given them          |

#![forbid(unsafe_code)]
#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_macros))]

pub mod cell;
pub mod certificate;
mod check;
pub mod claim;
pub mod definite;
pub mod enclosure;
pub mod expansion;
pub mod file;
pub mod fixed;
pub mod hull;
pub mod kernel;
pub mod kinematics;
pub mod linear;
pub mod model;
pub mod number;
pub mod rule;
pub mod shown;
pub mod statement;
mod strict;
pub mod trig;
pub mod witness;
pub mod word;

pub use orthocert_kernel::paving;

pub use check::{check, check_part, obligations, read, Accepted, Rejected, TreeSize};
