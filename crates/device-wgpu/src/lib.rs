//! Renders on GPUs, through wgpu: the wavefront of the thesis, section 4.1.
//!
//! Everything that is computed along paths is recorded from the formulas of `residual-render` and printed by
//! `residual-wgsl`; written here are traversal and scheduling only. Samples go back to the same
//! [`Film`](residual_render::film::Film) as the processor's.

mod adding;
mod bindings;
mod compiled;
mod error;
mod exact;
mod experimental;
mod gpu;
mod launch;
mod light_pass;
mod megakernel;
mod probe;
mod rays;
mod renderer;
mod scene;
mod shader;
mod stages;
mod state;
mod tree;
mod wavefront;

pub use error::Error;
pub use exact::FloatControls;
pub use gpu::{AdapterDescription, Gpu, list_adapters};
pub use probe::{Answers, Probe, Question, Tally};
pub use rays::RayQueries;
pub use renderer::{GpuPose, WgpuRenderer};
pub use residual_wgsl::{Arithmetic, KernelSet, Mapping};
pub use shader::{Dialect, Mode};

/// The wgpu that programs have to use with this crate.
pub use wgpu;
