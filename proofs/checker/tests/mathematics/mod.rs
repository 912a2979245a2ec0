//! Mathematical tests of the checker: exact values inside enclosures, and nothing accepted that
//! is not true. Random choices have fixed seeds.
//!
//! | module       | tests                                                                     |
//! |--------------|---------------------------------------------------------------------------|
//! | `arithmetic` | fixed-point intervals against exact rationals                             |
//! | `numbers`    | random expressions: values, canonical texts, signs                        |
//! | `definite`   | definiteness of interval matrices against brute force                     |
//! | `oracle`     | kinematics and singular values against an independent program             |
//! | `rules`      | each rule: what it accepts, and what it rejects, named after the defect   |
//! | `paper`      | the cube of a claim is the one of the paper's Steps 1 to 3                |
//! | `slopes`     | expansions over random cells against exact values                         |
//! | `acceptance` | rules on random cells, bounds near the truth: what is accepted is true    |
//! | `tree`       | the walk over a tree: complete ones, and one defect each                  |
//! | `violated`   | violations over a cell: accepted, rejected, and right                     |
//! | `words`      | machine words against big integers                                        |

mod acceptance;
mod approximate;
mod arithmetic;
mod definite;
mod machines;
mod numbers;
mod oracle;
mod paper;
mod random;
mod rules;
mod slopes;
mod tree;
mod violated;
mod words;
