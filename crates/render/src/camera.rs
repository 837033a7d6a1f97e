//! Cameras.
//!
//! [`Buffer::Camera`], twelve `f32`: eye; the vectors from the film's centre to the middles of its right and top
//! edges; and the vector from the eye to the film's centre (perspective) or the direction of view (orthographic).

use crate::domain::{Buffer, Domain};
use crate::math::Vec3;
use crate::math::vec3::vec3;
use crate::scene_data::SceneData;
use crate::surface::Ray;

/// A camera: turns places on the film into rays.
pub trait Camera<D: Domain> {
    /// The ray through film coordinates in [−1, 1], x to the right, y up. Its direction is a unit vector.
    fn ray(&self, d: D, film: [D::F; 2]) -> Ray<D>;
}

/// A pinhole.
#[derive(Clone, Copy, Debug)]
pub struct Perspective;
/// Parallel rays.
#[derive(Clone, Copy, Debug)]
pub struct Orthographic;

#[inline(always)]
fn vector<D: Domain>(d: D, first: u32) -> Vec3<D::F> {
    let [x, y, z] = [0, 1, 2].map(|k| d.uniform_real(Buffer::Camera, first + k));
    vec3(x, y, z)
}

#[inline(always)]
fn on_film<D: Domain>(d: D, film: [D::F; 2]) -> Vec3<D::F> {
    vector(d, 3).scale(film[0]) + vector(d, 6).scale(film[1])
}

impl<D: Domain> Camera<D> for Perspective {
    #[inline(always)]
    fn ray(&self, d: D, film: [D::F; 2]) -> Ray<D> {
        let dir = (vector(d, 9) + on_film(d, film)).normalize(d);
        Ray::unbounded(d, vector(d, 0), dir)
    }
}

impl<D: Domain> Camera<D> for Orthographic {
    #[inline(always)]
    fn ray(&self, d: D, film: [D::F; 2]) -> Ray<D> {
        let org = vector(d, 0) + on_film(d, film);
        Ray::unbounded(d, org, vector(d, 9).normalize(d))
    }
}

/// Fits a scene's camera to images of this width over height. What is seen from bottom to top stays.
pub fn set_aspect(data: &mut SceneData, aspect: f32) {
    let words = data.buffer_mut(Buffer::Camera);
    let length = |words: &[u32]| {
        let squares = words.iter().map(|&word| f32::from_bits(word).powi(2));
        squares.sum::<f32>().sqrt()
    };
    let scale = aspect * length(&words[6..9]) / length(&words[3..6]);
    for word in &mut words[3..6] {
        *word = (f32::from_bits(*word) * scale).to_bits();
    }
}

/// A camera chosen at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum AnyCamera {
    /// [`Perspective`].
    Perspective,
    /// [`Orthographic`].
    Orthographic,
}

impl<D: Domain> Camera<D> for AnyCamera {
    #[inline(always)]
    fn ray(&self, d: D, film: [D::F; 2]) -> Ray<D> {
        match self {
            Self::Perspective => Perspective.ray(d, film),
            Self::Orthographic => Orthographic.ray(d, film),
        }
    }
}
