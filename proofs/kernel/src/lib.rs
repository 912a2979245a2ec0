//! Machines and quantities as formulas, proofs as tests on their enclosures.
//!
//! | module         | holds                                                            |
//! |----------------|------------------------------------------------------------------|
//! | [`arithmetic`] | what a formula is evaluated in                                   |
//! | [`few`]          | a few numbers, on the stack                                      |
//! | [`fixed`]      | intervals with ends in multiples of `2^-bits`                    |
//! | [`formula`]    | formulas, shared on a tape; derivatives                          |
//! | [`slope`]      | a formula over a cell: value at the centre, range, slopes        |
//! | [`cell`]       | boxes of the bisection tree, their vertices                      |
//! | [`control`]    | polynomials at the control points of a cell                       |
//! | [`cube`]       | the machine of the paper's cube                                  |
//! | [`definite`]   | positive definiteness of interval matrices                       |
//! | [`test`](mod@test) | the tests: signs, singular values, solutions, distances     |
//! | [`machine`]    | drives and motions: the formulas of `A x' = B rho'`              |
//! | [`number`]     | numbers of a claim, exactly                                      |
//! | [`trig`]       | cosines and sines of degrees                                     |
//! | [`claim`]      | the theorem: mechanism, workspace, requirements                  |
//! | [`quantity`]   | the table of quantities that a claim may bound                   |
//! | [`input`]      | a claim's numbers, enclosed                                      |
//! | [`problem`]    | a claim as formulas, a box, and tests to be passed               |
//! | [`document`]   | texts of which there is one for each value                       |
//! | [`certificate`]| claim, verdict and proof as canonical text                       |
//! | [`step`]       | what evidence shows of an obligation on a cell                   |
//! | [`tree`]       | cells that are halved until all is shown of them                 |
//! | [`rejected`]   | why a proof is not accepted                                      |
//! | [`check`](mod@check) | what a certificate has to be to be accepted                |
//! | [`no_cube`]    | no cube of some side fits                                        |
//! | [`paving`]     | a box cut into cells within, and off, the region of a claim       |
//! | [`postulate`]  | the Q1/Q2 postulate                                              |
//! | [`witness`]    | refutations                                                      |
//! | [`vary`]       | claims over a cell of parameters                                 |
//! | [`atlas`]      | where in a box of parameters a claim holds, and where it fails    |
//! | [`work`]       | what checking costs, estimated before it is done                 |
//! | [`statement`]  | a claim in words                                                 |

#![forbid(unsafe_code)]

pub mod arithmetic;
pub mod atlas;
pub mod cell;
pub mod certificate;
pub mod check;
pub mod claim;
mod compile;
pub mod control;
pub mod cube;
pub mod definite;
pub mod document;
pub mod few;
pub mod fixed;
pub mod formula;
pub mod input;
pub mod machine;
pub mod no_cube;
pub mod number;
mod orientation;
pub mod paving;
pub mod postulate;
pub mod problem;
#[cfg(feature = "prover")]
#[path = "../prover/mod.rs"]
pub mod prover;
pub mod quantity;
pub mod rejected;
pub mod slope;
pub mod statement;
pub mod step;
pub mod test;
pub mod tree;
pub mod trig;
pub mod vary;
pub mod witness;
pub mod work;
