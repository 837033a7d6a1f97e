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
            /// Half the width that is seen whole in images of any shape, as long as `right` where it just fits; 0 where
            /// only the height counts.
            frame_width: real,
        }
        row {
            /// From the film's centre to the middle of its top edge.
            up: vector,
            /// Half the height that is seen whole.
            frame_height: real,
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

/// Half the height of what images of this width over height show, so that they show all of a frame, given by half its
/// width, or 0 where only its height counts, and half its height.
pub fn fitted_height([frame_width, frame_height]: [f32; 2], aspect: f32) -> f32 {
    // Images have whole pixels: a frame of which less than a thousandth is missing fits.
    const SLACK: f32 = 1.001;
    let needed = frame_width / aspect;
    if needed > frame_height * SLACK {
        needed
    } else {
        frame_height
    }
}

/// Fits a scene's camera to images of this width over height: all of its frame is seen, and more above and below it or
/// beside it.
pub fn set_aspect(data: &mut SceneData, aspect: f32) {
    data.change(0, |camera: CameraRecord| {
        let length = |v: Vec3<f32>| {
            let squares = v.to_array().map(|component| component.powi(2));
            squares.iter().sum::<f32>().sqrt()
        };
        let height = fitted_height([camera.frame_width, camera.frame_height], aspect);
        CameraRecord {
            right: camera.right.scale(aspect * height / length(camera.right)),
            up: camera.up.scale(height / length(camera.up)),
            ..camera
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_of_any_shape_show_all_of_the_frame() {
        let half = |camera: &CameraRecord| {
            let length = |v: Vec3<f32>| v.to_array().map(|c| c * c).iter().sum::<f32>().sqrt();
            [length(camera.right), length(camera.up)]
        };
        for (frame_width, frame_height) in [(2.0, 1.0), (0.5, 1.0), (0.0, 0.25)] {
            let mut data = SceneData::default();
            data.push(CameraRecord {
                eye: [0.0; 3].into(),
                right: [0.6, 0.0, 0.8].into(),
                frame_width,
                up: [0.0, 1.5, 0.0].into(),
                frame_height,
                forward: [0.0, 0.0, -1.0].into(),
            });
            // In any order: what was cut off or added once leaves no trace.
            for aspect in [1.0, 4.0, 2.0, 0.1, 0.5, 1.9995, 1.0] {
                set_aspect(&mut data, aspect);
                let [width, height] = half(&data.record(0));
                assert!((width / height / aspect - 1.0).abs() < 1e-5, "{aspect}");
                assert!(width >= frame_width * 0.9989 && height >= frame_height * 0.9999);
                let is_tight = |seen: f32, frame: f32| (seen / frame - 1.0).abs() < 1.1e-3;
                assert!(
                    is_tight(width, frame_width) || is_tight(height, frame_height),
                    "{aspect}: {width} {height}"
                );
            }
        }
    }
}
