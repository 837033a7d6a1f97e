//! Embree 4, loaded at run time: the yardstick, never a dependency.
//!
//! `ffi` declares what we call, `library` loads it and builds scenes, `trace` makes contenders of them, `renderer` puts them
//! into our renderer. I. Wald et al., "Embree: A Kernel Framework for Efficient CPU Ray Tracing", TOG 33(4), 2014.

mod ffi;
mod library;
mod renderer;
mod trace;

pub use library::{Embree, EmbreeScene, Missing, PATH_VARIABLE, Quality};
pub use renderer::EmbreeTraversal;
pub use trace::{EmbreeContender, Mode};
