//! Machines and quantities as formulas, proofs as tests on their enclosures.
//!
//! | module         | holds                                                            |
//! |----------------|------------------------------------------------------------------|
//! | [`arithmetic`] | what a formula is evaluated in                                   |
//! | [`fixed`]      | intervals with ends in multiples of `2^-bits`                    |
//! | [`formula`]    | formulas, shared on a tape; derivatives                          |
//! | [`slope`]      | a formula over a cell: value at the centre, range, slopes        |
//! | [`cell`]       | boxes of the bisection tree, their vertices                      |
//! | [`definite`]   | positive definiteness of interval matrices                       |
//! | [`test`]       | the tests: a formula's sign, `sigma_min`, `sigma_max`, `solve`   |
//! | [`machine`]    | drives and motions: the formulas of `A x' = B rho'`              |

#![forbid(unsafe_code)]

pub mod arithmetic;
pub mod cell;
pub mod definite;
pub mod fixed;
pub mod formula;
pub mod machine;
pub mod slope;
pub mod test;
