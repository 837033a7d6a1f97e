//! Cameras.

use crate::domain::Domain;
use crate::math::Vec3;
use crate::record::record;
use crate::scene_data::SceneData;
use crate::surface::PathRay;

/// A camera: turns points of the film into rays.
pub trait Camera<D: Domain> {
    /// The ray through film coordinates in [−1, 1], x to the right, y up. Its direction is a unit vector.
    fn ray(&self, d: D, film: [D::F; 2]) -> PathRay<D>;
}

record! {
    /// Where the camera is and what it sees, world space.
    pub struct CameraRecord in Camera {
        row {
            /// The eye; for parallel rays, the film's centre.
            eye: vector,
        }
        row {
            /// From the film's centre to the middle of its right edge.
            right: vector,
        }
        row {
            /// From the film's centre to the middle of its top edge.
            up: vector,
        }
        row {
            /// From the eye to the film's centre; for parallel rays, the direction of view, of any length.
            forward: vector,
        }
    }
}

impl<D: Domain> CameraRecord<D> {
    /// From the film's centre to a point of the film.
    #[inline(always)]
    fn on_film(&self, [x, y]: [D::F; 2]) -> Vec3<D::F> {
        self.right.scale(x) + self.up.scale(y)
    }
}

/// A pinhole.
#[derive(Clone, Copy, Debug)]
pub struct Perspective;
/// Parallel rays.
#[derive(Clone, Copy, Debug)]
pub struct Orthographic;

impl<D: Domain> Camera<D> for Perspective {
    #[inline(always)]
    fn ray(&self, d: D, film: [D::F; 2]) -> PathRay<D> {
        let camera = CameraRecord::uniform(d);
        let dir = (camera.forward + camera.on_film(film)).normalize(d);
        PathRay::unbounded(d, camera.eye, dir)
    }
}

impl<D: Domain> Camera<D> for Orthographic {
    #[inline(always)]
    fn ray(&self, d: D, film: [D::F; 2]) -> PathRay<D> {
        let camera = CameraRecord::uniform(d);
        let org = camera.eye + camera.on_film(film);
        PathRay::unbounded(d, org, camera.forward.normalize(d))
    }
}

/// Fits a scene's camera to images of this width over height. What is seen from bottom to top stays.
pub fn set_aspect(data: &mut SceneData, aspect: f32) {
    data.change(0, |camera: CameraRecord| {
        let length = |v: Vec3<f32>| {
            let squares = v.to_array().map(|component| component.powi(2));
            squares.iter().sum::<f32>().sqrt()
        };
        let scale = aspect * length(camera.up) / length(camera.right);
        CameraRecord {
            right: camera.right.scale(scale),
            ..camera
        }
    });
}
