//! Which pair of random numbers is for what before the first vertex of a path. Uses that may meet in one sample have pairs of
//! their own, and the path tracer begins with the next.

/// The place in the pixel.
pub(super) const FILM: u32 = 0;
/// The direction in which ambient occlusion looks.
pub(super) const OCCLUSION: u32 = 1;
/// The place on the lens.
pub(super) const LENS: u32 = 2;
/// The wavelength, by its first number.
pub(super) const WAVELENGTH: u32 = 3;
/// How many there are.
pub(super) const COUNT: u32 = 4;
