//! Which pair of random numbers is for what before the first vertex of a path. Uses that may meet in one sample have pairs of
//! their own, and the path tracer begins with the next. Paths that begin at lights use those of the camera in their way.

/// The place in the pixel.
pub(super) const FILM: u32 = 0;
/// The direction in which ambient occlusion looks.
pub(super) const OCCLUSION: u32 = 1;
/// The place on the lens.
pub(super) const LENS: u32 = 2;
/// Of a light path: the light, and the place on it.
pub(super) const EMISSION_PLACE: u32 = 0;
/// Of a light path: the direction in which it leaves the light.
pub(super) const EMISSION_DIRECTION: u32 = 1;
/// Of a light path, by its first number: the texel of an environment.
pub(super) const EMISSION_TEXEL: u32 = 2;
/// The wavelength, by its first number.
pub(super) const WAVELENGTH: u32 = 3;
/// How many there are.
pub(super) const COUNT: u32 = 4;
