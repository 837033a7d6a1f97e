//! What a render tells its tracer: data, so that no option compiles anything anew.

use super::camera_pairs::{FILM, LENS};
use super::path_origin::PathOrigin;
use super::{MAX_DEPTH, Path, PathState};
use crate::camera::Camera;
use crate::domain::Domain;
use crate::math::Vec3;
use crate::sampler::{SampleKey, Sampler};

/// Options of a tracer, as a device gets them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct TracerOptions {
    /// Width and height of the image in pixels, each at most 2¹⁶.
    pub image: [u32; 2],
    /// Seed of the random numbers.
    pub seed: u32,
    /// Most vertices a path may have; 1 is emission seen directly, 2 adds direct light. More than [`MAX_DEPTH`] are as many.
    pub max_depth: u32,
    /// First vertex at which Russian roulette may end a path.
    pub roulette_from: u32,
    /// How far occluders count for ambient occlusion, and where the depth view turns black; in units of the scene.
    pub reach: f32,
    /// Where paths begin.
    pub origin: PathOrigin,
}

const _: () = assert!(size_of::<TracerOptions>() == 28);

/// [`TracerOptions`] in the numbers of a domain.
#[derive(Clone, Copy)]
#[expect(missing_docs, reason = "the fields are those of `TracerOptions`")]
pub struct Settings<D: Domain> {
    pub image: [D::F; 2],
    pub seed: D::U,
    pub max_depth: D::U,
    pub roulette_from: D::U,
    pub reach: D::F,
    pub origin: PathOrigin,
}

impl<D: Domain> Settings<D> {
    /// The same options for all lanes.
    #[inline(always)]
    pub fn new(d: D, options: &TracerOptions) -> Self {
        Self {
            image: options.image.map(|pixels| d.lit(f64::from(pixels))),
            seed: d.uint(options.seed),
            max_depth: d.uint(options.max_depth.min(MAX_DEPTH)),
            roulette_from: d.uint(options.roulette_from),
            reach: d.lit(f64::from(options.reach)),
            origin: options.origin,
        }
    }

    /// The camera path of a sample, through a random place of its pixel and, if the camera has one, of its lens. Every
    /// tracer begins with it.
    #[inline(always)]
    pub(super) fn camera_path<C: Camera<D>, S: Sampler<D>>(
        &self,
        d: D,
        camera: &C,
        sampler: &S,
        pixel: [D::U; 2],
        sample: D::U,
    ) -> Path<D> {
        let key = SampleKey::new(d, pixel[0], pixel[1], sample, self.seed);
        let jitter = sampler.pair(d, key, d.uint(FILM));
        let lens = match camera.has_lens() {
            true => sampler.pair(d, key, d.uint(LENS)),
            false => [d.lit(0.0); 2],
        };
        let [width, height] = self.image;
        let (two, one) = (d.lit(2.0), d.lit(1.0));
        let x = (d.to_real(pixel[0]) + jitter[0]) / width * two - one;
        let y = one - (d.to_real(pixel[1]) + jitter[1]) / height * two;
        Path {
            ray: camera.ray(d, [x, y], lens),
            throughput: Vec3::splat(one),
            pdf: d.lit(0.0),
            rivals: d.lit(0.0),
            key,
            state: PathState::first(d),
        }
    }
}
