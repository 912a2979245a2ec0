//! Tests of the checker through its library; those of the broken certificates are `rejected/`.
//!
//! | module        | tests                                                                     |
//! |---------------|---------------------------------------------------------------------------|
//! | `mathematics` | exact values inside enclosures, and nothing accepted that is not true     |
//! | `adversary`   | false claims, and what would prove them                                   |
//! | `drives`      | drives and the rules about their joints                                   |
//! | `paving`      | pavings: accepted, rejected, volumes                                      |
//! | `no_cube`     | claims that no cube of some side fits                                     |
//! | `postulate`   | proofs of the postulate for a range of `psi_max`                          |
//! | `hostile`     | files made to exhaust the checker or to mislead                           |

mod adversary;
mod drives;
mod hostile;
mod mathematics;
mod no_cube;
mod paving;
mod postulate;
