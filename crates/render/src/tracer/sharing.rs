//! How paths from both ends share an image.

/// How paths from both ends share the image.
pub trait Sharing: Copy {
    /// Both find what they can, weighed against each other. If not, light paths find all but what the camera sees of lights.
    fn is_shared(self) -> bool;
}

/// By multiple importance sampling.
#[derive(Clone, Copy, Debug)]
pub struct Combined;
/// Light paths find all that they can; from the camera only lights and backgrounds are seen, and layers filled.
#[derive(Clone, Copy, Debug)]
pub struct LightPathsOnly;

impl Sharing for Combined {
    #[inline(always)]
    fn is_shared(self) -> bool {
        true
    }
}

impl Sharing for LightPathsOnly {
    #[inline(always)]
    fn is_shared(self) -> bool {
        false
    }
}

/// [`Sharing`] chosen at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum AnySharing {
    /// [`Combined`].
    Combined,
    /// [`LightPathsOnly`].
    LightPathsOnly,
}

impl Sharing for AnySharing {
    #[inline(always)]
    fn is_shared(self) -> bool {
        self == Self::Combined
    }
}
