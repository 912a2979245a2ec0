//! Tests of the checker through its library; those of the broken certificates are `rejected/`.
//!
//! | module        | tests                                                                     |
//! |---------------|---------------------------------------------------------------------------|
//! | `mathematics` | exact values inside enclosures, and nothing accepted that is not true     |
//! | `adversary`   | false claims, and what would prove them                                   |
//! | `drives`      | drives and the rules about their joints                                   |
//! | `hostile`     | files made to exhaust the checker or to mislead                           |

mod adversary;
mod drives;
mod hostile;
mod mathematics;
