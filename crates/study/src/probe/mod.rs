//! Failures that are too rare to be seen in an image of a few samples, looked for where they happen.

pub mod misses;
mod random;
pub mod sums;
