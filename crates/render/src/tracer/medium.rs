//! What bodies are filled with.

use crate::domain::Domain;
use crate::math::Color;
use crate::math::elementary::exp2;
use crate::record::record;

record! {
    /// A homogeneous medium. The first of a scene is the outside, which is empty.
    pub struct MediumRecord in Media {
        row {
            /// How often a unit of length halves the light that goes straight on: what is absorbed and what is scattered.
            halvings: vector,
            /// Index of refraction.
            ior: real,
        }
        row {
            /// The share of what is lost that is scattered (single-scattering albedo), in [0, 1].
            albedo: vector,
            /// Mean cosine between the directions before and after a scattering, in (−1, 1).
            anisotropy: real,
        }
        row {
            /// Index of the first medium of a higher priority.
            above: word,
            /// Of the outside: the media that the camera is in, as paths remember them.
            around_camera: word,
        }
    }
}

impl<D: Domain> MediumRecord<D> {
    /// The share of light that goes straight on over a length: Beer's law.
    #[inline(always)]
    pub(super) fn transmittance(&self, d: D, length: D::F) -> Color<D::F> {
        self.halvings.map(|h| exp2(d, -(h * length)))
    }
}
