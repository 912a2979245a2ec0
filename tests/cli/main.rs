//! End to end, through the built binary: what a user sees, and what scripts rely on.
//!
//! | module         | holds                                                             |
//! |----------------|-------------------------------------------------------------------|
//! | [`support`]    | running the binary in a folder of its own                         |
//! | `verdicts`     | every verdict of `verify`: exit code, report, certificate         |
//! | `certificates` | `check` and `show`: accepted, refused, about another design       |
//! | `calculator`   | `design`, `init`, `completions`, help                             |
//! | `paving`       | `pave` and `check` of pavings                                     |
//! | `surface`      | `export vtk` and `export stl`                                     |
//! | `largest_cube` | `largest-cube`                                                    |
//! | `postulate`    | `postulate`                                                       |
//! | `bad_input`    | every class of bad usage and bad input                            |
//! | `files`        | certificates appear whole or not at all                           |
//! | `interruption` | signals, closed and full outputs                                  |
//! | `json`         | `--format json`: the same facts                                   |

mod support;

mod bad_input;
mod calculator;
mod certificates;
mod files;
mod interruption;
mod json;
mod largest_cube;
mod paving;
mod postulate;
mod surface;
mod verdicts;
