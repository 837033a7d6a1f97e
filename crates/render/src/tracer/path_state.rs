//! What a path remembers, in one word.

use crate::domain::Domain;

/// Bits of the depth; above them are the media, and in the last bit whether the path is of one wavelength.
const DEPTH_BITS: u32 = 10;
const SPECTRAL_BIT: u32 = 31;

/// The most vertices that a path can have.
pub const MAX_DEPTH: u32 = (1 << DEPTH_BITS) - 1;
/// The most media that a scene can have.
pub const MAX_MEDIA: u32 = (1 << (SPECTRAL_BIT - DEPTH_BITS)) - 1;

/// What a path remembers of its way: how many vertices it has, the media that it is in, and whether it is of one wavelength.
/// Devices keep the word, and see in it only whether a path is looking for its first vertex.
#[derive(Clone, Copy, Debug)]
pub struct PathState<U>(pub U);

impl<U> PathState<U> {
    /// Of a path that begins: outside of everything, of all wavelengths.
    #[inline(always)]
    pub fn first<D: Domain<U = U>>(d: D) -> Self {
        Self(d.uint(1))
    }
}

impl<U: crate::domain::Unsigned> PathState<U> {
    /// Index of the vertex that the path's ray is looking for; the first is 1.
    #[inline(always)]
    pub fn depth<D: Domain<U = U>>(self, d: D) -> U {
        self.0 & d.uint(MAX_DEPTH)
    }

    /// Whether the path's ray comes from the camera.
    #[inline(always)]
    pub fn is_first<D: Domain<U = U>>(self, d: D) -> D::M {
        d.eq_u(self.depth(d), d.uint(1))
    }

    /// The next vertex. A path that has [`MAX_DEPTH`] goes on no more.
    #[inline(always)]
    pub fn next<D: Domain<U = U>>(self, d: D) -> Self {
        Self(self.0 + d.uint(1))
    }

    /// The media that the path's ray is in, as [`Nesting`](super::Nesting) writes them down; 0 is the outside.
    #[inline(always)]
    pub fn media<D: Domain<U = U>>(self, d: D) -> U {
        (self.0 >> DEPTH_BITS) & d.uint(MAX_MEDIA)
    }

    /// The same path in other media.
    #[inline(always)]
    pub fn in_media<D: Domain<U = U>>(self, d: D, media: U) -> Self {
        let rest = self.0 & d.uint(!(MAX_MEDIA << DEPTH_BITS));
        Self(rest | (media << DEPTH_BITS))
    }

    /// Whether the path is of one wavelength.
    #[inline(always)]
    pub fn is_spectral<D: Domain<U = U>>(self, d: D) -> D::M {
        d.eq_u(self.0 >> SPECTRAL_BIT, d.uint(1))
    }

    /// The same path, of one wavelength.
    #[inline(always)]
    pub fn spectral<D: Domain<U = U>>(self, d: D) -> Self {
        Self(self.0 | d.uint(1 << SPECTRAL_BIT))
    }
}
