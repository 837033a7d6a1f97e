//! glTF 2.0 files: nodes are walked, and what they show is read when it is first asked for.
//!
//! ```text
//! file ─ glb, json_text, root, repair ─▶ Document ─ animation, nodes ─▶ PlacedNode ─┬─ meshes ─ primitives ─ accessors ─▶ RawMesh ─ deform, placements ─ poses
//!    (JSON, buffers; meshopt, draco)                             │   └─ skins
//!                                                                ├─ materials ─ material ─ surface, layers ─▶ MaterialDesc
//!                                                                │   └─ textures ─ images ─▶ TextureDesc, ImageRequest
//!                                                                └─ lights, area_lights, cameras, instancing
//! ```

mod accessors;
mod animation;
mod area_lights;
mod cameras;
mod deform;
mod document;
mod draco;
mod elements;
mod extension_members;
mod extensions;
mod external_files;
mod glb;
mod images;
mod instancing;
mod json_text;
mod layers;
mod lights;
mod lookup;
mod material;
mod materials;
mod members;
mod meshes;
mod meshopt;
mod nodes;
mod placements;
mod poses;
mod primitives;
mod repair;
mod root;
mod scene;
mod skins;
mod surface;
mod texture_reference;
mod textures;
mod translations;
mod uri;
mod uv_sets;
mod variants;

pub(crate) use external_files::external_files;
pub(super) use scene::import;
