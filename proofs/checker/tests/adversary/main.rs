//! False claims, and what would prove them: nothing here may be accepted.

mod witnesses;
