//! What people ask of a design, each on top of the search.
//!
//! | module           | answers                                                              |
//! |------------------|----------------------------------------------------------------------|
//! | [`atlas`]        | which designs of a box of parameters meet their requirements         |
//! | [`decide`]       | whether a design meets its requirements                              |
//! | [`dimensions`]   | the paper's Steps 1 to 3, enclosed                                   |
//! | [`frontier`]     | how far a number of a claim goes before its verdict changes          |
//! | [`largest_cube`] | the side of the largest cube in which a claim holds, enclosed        |
//! | [`limit`]        | how far one number of a design can go                                |
//! | [`paper`]        | what is proved of the claims of the seed paper, one by one           |
//! | [`placement`]    | the best place for a cube, as it seems                               |
//! | [`postulate`]    | the Q1/Q2 postulate for one psi_max, a range, or every one           |
//! | [`size`]         | the smallest machine for an axis-aligned cube of a given side        |
//! | [`summary`]      | what a designer reads first: how far quantities go, what limits      |
//! | [`tolerance`]    | the widest tolerances with which a design is still certified         |

pub mod atlas;
pub mod decide;
pub mod dimensions;
pub mod frontier;
pub mod largest_cube;
pub mod limit;
pub mod paper;
pub mod placement;
pub mod postulate;
pub mod size;
pub mod summary;
pub mod tolerance;
