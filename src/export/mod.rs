//! Certificates in the languages of other checkers.

pub mod rocq;
