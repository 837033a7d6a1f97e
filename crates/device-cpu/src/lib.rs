//! The CPU device: tiles in parallel; within a tile, streams of paths that are traced together, sorted by program,
//! shaded in vector lanes, and compacted (thesis, section 4.2).
//!
//! [`TileRenderer`] is the seam: [`Interpreter`] runs a scene's structure as boxed nodes, [`compiled_scene!`] makes
//! one from emitted code, and [`plugin`] loads one from a shared library. All three run the same
//! [`tile::render_tiles`] and give the same bits.

mod ahead;
mod device;
mod export;
mod first_rays;
mod interpreter;
mod job;
pub mod lanes;
pub mod plugin;
mod render_lanes;
mod samples;
mod shade;
mod stream;
pub mod tile;
pub mod traversal;

pub use device::CpuDevice;
pub use interpreter::Interpreter;
pub use job::{SceneView, TileJob, TileRenderer};
pub use lanes::LaneCount;
pub use traversal::{AnyBvh, PreciseBvh, Traversal, Width};

/// What emitted code needs, under stable names.
#[doc(hidden)]
pub mod generated {
    pub use fearless_simd;
    pub use residual_render as render;

    /// Whether a scene's paths begin at lights, too: emitted scenes say so where they do.
    pub trait LightPaths {
        /// They do not.
        const HAS_LIGHT_PATHS: bool = false;
    }

    impl<T> LightPaths for T {}
}
