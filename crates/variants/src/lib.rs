//! What the CPU device could be compiled as besides: the interpreter with any number of lanes, and traversal of any precision.
//!
//! Images do not depend on lanes, and renderers are watertight, so that these are of use to those alone who test or measure. Compiling
//! them takes longer than the whole CPU device, hence a crate of their own, in which it is done once.

mod lanes;
mod precision;

pub use lanes::AnyLanes;
pub use precision::TraversalPrecision;
