//! Planned scenes as files of Mitsuba 3, so that it can be measured on what we render.
//!
//! ```text
//! SceneDesc ─ plan, all numbers constant ─┬─ shapes ─ ply ───────────────────▶ *.ply ◀──┐
//!                                         ├─ textures, environment ─ raster ─▶ *.exr ◀──┤
//!                                         └─ bsdf, opacity, scene ─ xml ─────▶ scene.xml ┘ and sensor.xml
//! ```
//!
//! What is exported is the plan, not the file, so that decisions of the plan (is this glass solid or thin? has this mesh normals
//! of its own?) are taken once. Materials and lights without a faithful counterpart are refused by their names.

mod bsdf;
mod coat;
mod environment;
mod opacity;
mod ply;
mod raster;
mod scene;
mod shapes;
mod textures;
mod xml;

pub use scene::{Exported, SCENE_FILE, SENSOR_FILE, export};
