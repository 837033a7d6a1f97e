//! Two-level hierarchies: objects, each in a space of its own, placed in the world any number of
//! times.
//!
//! A ray is taken to an object's space without normalising its direction, so that distances mean
//! the same in both. What holds within a hierarchy (no holes between triangles, ties) holds within
//! an instance, in the object's space.

pub(crate) mod instance;
pub(crate) mod instanced_bvh;
mod placed;
pub(crate) mod query;
mod top_level;
