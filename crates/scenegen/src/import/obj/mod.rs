//! OBJ files and their material libraries.
//!
//! ```text
//! .obj ─ source (checked by references) ─▶ text ─ models (tobj) ─▶ RawMesh
//! .mtl ─ mtl ─▶ MtlMaterial ─ statements ─ material ─▶ MaterialDesc
//!                                             └─ textures ─▶ TextureDesc, ImageRequest
//! ```

mod counting_lines;
mod find;
mod lines;
mod map_statement;
mod material;
mod materials;
mod models;
mod mtl;
mod references;
mod scene;
mod source;
mod statements;
mod textures;

pub(super) use scene::import;
