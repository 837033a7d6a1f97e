//! glTF 2.0 files.

mod accessors;
mod document;
mod extensions;
mod lights;
mod materials;
mod nodes;
mod primitives;
mod scene;
mod textures;

pub(super) use scene::import;
