//! Meshes made valid.

mod finish;
mod normals;
mod tangents;

pub(super) use finish::{RawMesh, finish};
