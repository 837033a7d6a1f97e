//! OBJ files and their material libraries.
//!
//! ```text
//! .obj ─ text ─ lines ─ parser ─▶ Geometry (checked by references) ─ part_mesh ─▶ RawMesh
//!                                    │ mtllib, usemtl              ├─ smoothing
//!                                    ▼                             └─ mesh::Triangulator
//! .mtl ─ text ─ lines ─ mtl ─▶ libraries ─ statements ─ inputs ─ material ─▶ MaterialDesc (bounded by energy)
//!                                                         └─ textures ─▶ TextureDesc, ImageRequest
//! ```
//!
//! Files in the wild are read as their writers meant them: what is unclear is guessed, what is wrong costs no more
//! than itself, and both are warnings. There are crates that read OBJ. They cut polygons into fans, know no smoothing
//! groups, want every corner to have the same attributes and the whole file to be without a fault, so that a pass that
//! made files fit for them was larger than this parser.

mod corner;
mod energy;
mod find;
mod geometry;
mod illumination;
mod inputs;
mod libraries;
mod lines;
mod map_statement;
mod material;
mod materials;
mod mtl;
mod names;
mod numbers;
mod occurrences;
mod origin;
mod parser;
mod part_mesh;
mod polypaint;
mod references;
mod scene;
mod smoothing;
mod statements;

mod textures;
mod transparency;
mod vertex_colors;

pub(super) use scene::import;
