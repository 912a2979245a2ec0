//! Machines and quantities as formulas, proofs as tests on their enclosures.
//!
//! Each module uses those above it alone: who reads from top to bottom meets nothing that is not known.
//!
//! | module               | holds                                                          |
//! |----------------------|----------------------------------------------------------------|
//! | [`arithmetic`]       | what a formula is evaluated in                                 |
//! | [`few`]              | a few numbers, on the stack                                    |
//! | [`fixed`]            | intervals with ends in multiples of `2^-bits`                  |
//! | [`trig`]             | cosines and sines of degrees                                   |
//! | [`formula`]          | formulas, shared on a tape; derivatives                        |
//! | [`cell`]             | boxes of the bisection tree, their vertices                    |
//! | [`slope`]            | a formula over a cell: value at the centre, range, slopes      |
//! | [`control`]          | polynomials at the control points of a cell                    |
//! | [`definite`]         | positive definiteness of interval matrices                     |
//! | [`number`]           | numbers of a claim, exactly                                    |
//! | [`claim`]            | the theorem: mechanism, workspace, requirements                |
//! | [`test`](mod@test)   | the tests: signs, singular values, solutions, distances        |
//! | [`machine`]          | drives and motions: the formulas of `A x' = B rho'`            |
//! | [`document`]         | texts of which there is one for each value                     |
//! | [`certificate`]      | claim, verdict and proof as canonical text                     |
//! | [`vary`]             | claims over a cell of parameters                               |
//! | [`input`]            | a claim's numbers, enclosed                                    |
//! | `compile`            | legs and joints as formulas                                    |
//! | `orientation`        | orientations: rotations and their sets                         |
//! | [`quantity`]         | the table of quantities that a claim may bound                 |
//! | [`cube`]             | the machine of the paper's cube                                |
//! | [`problem`]          | a claim as formulas, a box, and tests to be passed             |
//! | [`witness`]          | refutations                                                    |
//! | [`step`]             | what evidence shows of an obligation on a cell                 |
//! | [`rejected`]         | why a proof is not accepted                                    |
//! | [`tree`]             | cells that are halved until all is shown of them               |
//! | [`paving`]           | a box cut into cells within, and off, the region of a claim    |
//! | [`statement`]        | a claim in words                                               |
//! | [`no_cube`]          | no cube of some side fits                                      |
//! | [`postulate`]        | the Q1/Q2 postulate                                            |
//! | [`work`]             | what checking costs, estimated before it is done               |
//! | [`atlas`]            | where in a box of parameters a claim holds, and where it fails |
//! | [`check`](mod@check) | what a certificate has to be to be accepted                    |

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
