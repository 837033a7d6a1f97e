//! Meshes that both importers make: [`RawMesh`] is what a file says, [`finish`] makes it valid.
//!
//! Non-finite values are dealt with, normals and tangents completed.

mod finish;
mod normals;
mod polygon;
mod raw;
mod tangents;
mod vertices;

pub(super) use finish::finish;
pub(super) use polygon::{Coverage, Triangulator, vector_area};
pub(super) use raw::RawMesh;
