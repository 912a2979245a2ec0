//! False claims, and what would prove them: nothing here may be accepted.

mod cube;
mod falsehoods;
mod identities;
mod random;
mod truth;
mod witnesses;
