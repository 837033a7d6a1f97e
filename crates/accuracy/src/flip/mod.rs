//! ꟻLIP: how different two images look to somebody who flips between them, on a screen that clips at 1 ([`flip()`], Andersson
//! et al. 2020) and at all exposures that show something of a high dynamic range ([`HdrFlip`], Andersson et al. 2021).

mod hdr;
mod ldr;
mod map;

pub use hdr::{Exposures, HdrFlip};
pub use ldr::{flip, flip_map};
pub use map::FlipMap;
