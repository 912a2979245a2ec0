//! End to end, through the built binary: what a user sees, and what scripts rely on.
//!
//! | module         | holds                                                             |
//! |----------------|-------------------------------------------------------------------|
//! | [`support`]    | running the binary in a folder of its own                         |
//! | [`junit`]      | reading and judging JUnit reports                                 |
//! | `verdicts`     | every verdict of `verify`: exit code, report, certificate         |
//! | `kinds`        | machines of every kind: refused, checked against their designs    |
//! | `certificates` | `check` and `show`: accepted, refused, about another design       |
//! | `batch`        | `verify` of many designs, and its reports                         |
//! | `cache`        | certificates that are there are re-checked                        |
//! | `audit`        | `check` of a folder, and `attest`                                 |
//! | `calculator`   | `design`, `init`, `completions`, `man`, help                      |
//! | `paving`       | `pave` and `check` of pavings                                     |
//! | `surface`      | `export vtk` and `export stl`                                     |
//! | `largest_cube` | `largest-cube`                                                    |
//! | `limit`        | `limit`: every kind of key, ends, certificates, refused           |
//! | `postulate`    | `postulate`                                                       |
//! | `report`       | `report`: pages and figures                                       |
//! | `atlas`        | `atlas`: maps, and what is refused                                |
//! | `bad_input`    | every class of bad usage and bad input                            |
//! | `files`        | certificates appear whole or not at all                           |
//! | `import`       | `import`: what is told, what is refused                           |
//! | `shards`       | `split`, `run-shard`, `merge`, `submit`                           |
//! | `paving_shards` | the same of pavings                                              |
//! | `interruption` | signals, closed and full outputs                                  |
//! | `json`         | `--format json`: the same facts                                   |
//! | `answers`      | `--format json` is as its schema says                             |
//! | `designer`     | what is left out is said, refusals name the line                  |
//! | `tolerance`    | `tolerance`: both ends, together, refused                         |
//! | `hostile`      | checkouts and names of strangers                                  |
//! | `summary`      | `summary`: closed forms, the nearest requirement, every kind      |
//! | `size`         | `size`: against the closed form, scaled, refused                  |

mod junit;
mod support;

mod answers;
mod atlas;
mod audit;
mod bad_input;
mod batch;
mod cache;
mod calculator;
mod certificates;
mod designer;
mod files;
mod for_all;
mod hostile;
mod import;
mod interruption;
mod json;
mod kinds;
mod largest_cube;
mod limit;
mod paving;
mod paving_shards;
mod postulate;
mod report;
mod shards;
mod size;
mod summary;
mod surface;
mod tolerance;
mod verdicts;
