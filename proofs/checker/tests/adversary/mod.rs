//! False claims, and what would prove them: nothing here may be accepted.

mod case;
mod cube;
mod falsehoods;
mod identities;
mod mutation;
mod oracle;
mod random;
mod statements;
mod truth;
mod witnesses;
