//! OBJ files and their material libraries.

mod materials;
mod mtl;
mod scene;
mod source;

pub(super) use scene::import;
