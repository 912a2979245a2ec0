//! What needs no terminal: the prover through its library, and what the project holds.
//!
//! | module         | holds                                                                   |
//! |----------------|-------------------------------------------------------------------------|
//! | [`schema`]     | the JSON Schema of certificates                                         |
//! | `prover`       | values and verdicts against what is known in closed form                |
//! | `certificates` | the committed certificates are what the prover writes, and accepted     |
//! | `gallery`      | every committed design has its stated verdict                           |
//! | `export_rocq`  | what certificates export to                                             |
//! | `ci_steps`     | what is offered to continuous integration runs as it is written         |

mod schema;

mod certificates;
#[cfg(unix)]
mod ci_steps;
mod export_rocq;
mod gallery;
mod prover;
