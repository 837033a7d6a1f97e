//! Images: decoded within a budget, and never a reason to give a scene up.

mod basis;
mod decode;
mod limits;
mod luminance_chroma;
mod openexr;
mod primaries;
mod radiance;
#[cfg(test)]
mod radiance_tests;
mod requests;
mod scalar_map;
mod sixteen_bits;
mod subsampled;
#[cfg(test)]
mod subsampled_tests;
mod unreadable;

pub(super) use decode::decode_one;
pub(super) use requests::{Derived, ImageRequest, ImageRole, decode_all};
pub(super) use scalar_map::{ScalarMap, ScalarSource};
