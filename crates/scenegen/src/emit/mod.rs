//! Emitters: they print what the plan decided, and decide nothing.
//!
//! Printing is deterministic: programs and lights have numbers, floats are printed so that they read back as the
//! same bits, and the source's names stand in comments.

pub mod rust;
