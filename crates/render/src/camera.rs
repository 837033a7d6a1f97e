//! Cameras.

use crate::domain::{Buffer, Domain};
use crate::math::Vec3;
use crate::math::elementary::sincos_turns;
use crate::math::warp::disc;
use crate::record::record;
use crate::scene_data::SceneData;
use crate::surface::PathRay;

/// A camera: turns points of the film into rays.
pub trait Camera<D: Domain> {
    /// The ray through film coordinates in [−1, 1], x to the right, y up. Its direction is a unit vector. `lens` are two
    /// random numbers in [0, 1) where the camera [has a lens](Camera::has_lens).
    fn ray(&self, d: D, film: [D::F; 2], lens: [D::F; 2]) -> PathRay<D>;

    /// Whether rays pass through different points of a lens: others need no random numbers for it.
    #[inline(always)]
    fn has_lens(&self) -> bool {
        false
    }
}

record! {
    /// Where the camera is and what it sees, world space.
    pub struct CameraRecord in Camera {
        row {
            /// The eye, or the middle of the lens; for parallel rays, the film's centre.
            eye: vector,
            /// Radius of the lens; 0 without one.
            lens_radius: real,
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
            /// From the eye to the film's centre; for parallel rays, the direction of view, of any length. Behind a lens, and
            /// where rays go everywhere, of length 1.
            forward: vector,
            /// Distance from the lens to the plane in which all is sharp; 0 without a lens.
            focus_distance: real,
        }
    }
}

record! {
    /// What of the scene a camera ray stands for, behind the camera's record. Only where textures are filtered.
    pub struct PixelConeRecord {
        row {
            /// What half the film's height is multiplied with to give half the height of what is seen where rays begin.
            parallel: real,
            /// The same a unit of length farther on, less that.
            spread: real,
            /// Half the angle between the image's top and bottom, of cameras whose film does not say it, in radians.
            turn: real,
        }
    }
}

/// The width of a pixel of an image of so many rows where camera rays begin, and by how much it grows on a unit of length.
#[inline(always)]
pub fn pixel_cone<D: Domain>(d: D, rows: D::F) -> [D::F; 2] {
    let camera = CameraRecord::uniform(d);
    let cone = PixelConeRecord::uniform_at(d, Buffer::Camera, CameraRecord::WORDS);
    let half_height = camera.up.length(d);
    let pixel = d.lit(2.0) / rows;
    [
        half_height * cone.parallel * pixel,
        d.fma(half_height, cone.spread, cone.turn) * pixel,
    ]
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
/// A thin lens with a round opening, evenly bright: what is not in its plane of focus is blurred (PBRT 4, 5.2.3).
#[derive(Clone, Copy, Debug)]
pub struct ThinLens;
/// Parallel rays.
#[derive(Clone, Copy, Debug)]
pub struct Orthographic;
/// All directions, as a latitude-longitude image: the direction of view is in its middle, up at its top edge, and what is
/// behind the eye at its left and right.
#[derive(Clone, Copy, Debug)]
pub struct Panorama;

impl<D: Domain> Camera<D> for Perspective {
    #[inline(always)]
    fn ray(&self, d: D, film: [D::F; 2], _: [D::F; 2]) -> PathRay<D> {
        let camera = CameraRecord::uniform(d);
        let dir = (camera.forward + camera.on_film(film)).normalize(d);
        PathRay::unbounded(d, camera.eye, dir)
    }
}

impl<D: Domain> Camera<D> for ThinLens {
    #[inline(always)]
    fn ray(&self, d: D, film: [D::F; 2], lens: [D::F; 2]) -> PathRay<D> {
        let camera = CameraRecord::uniform(d);
        // What a pinhole sees in the plane of focus, every point of the lens sees in the same place of the film.
        let focus = (camera.forward + camera.on_film(film)).scale(camera.focus_distance);
        let [x, y] = disc(d, lens).map(|c| c * camera.lens_radius);
        let on_lens = camera.right.normalize(d).scale(x) + camera.up.normalize(d).scale(y);
        let dir = (focus - on_lens).normalize(d);
        PathRay::unbounded(d, camera.eye + on_lens, dir)
    }

    #[inline(always)]
    fn has_lens(&self) -> bool {
        true
    }
}

impl<D: Domain> Camera<D> for Orthographic {
    #[inline(always)]
    fn ray(&self, d: D, film: [D::F; 2], _: [D::F; 2]) -> PathRay<D> {
        let camera = CameraRecord::uniform(d);
        let org = camera.eye + camera.on_film(film);
        PathRay::unbounded(d, org, camera.forward.normalize(d))
    }
}

impl<D: Domain> Camera<D> for Panorama {
    #[inline(always)]
    fn ray(&self, d: D, [x, y]: [D::F; 2], _: [D::F; 2]) -> PathRay<D> {
        let camera = CameraRecord::uniform(d);
        let (sin_longitude, cos_longitude) = sincos_turns(d, x * d.lit(0.5));
        let (sin_latitude, cos_latitude) = sincos_turns(d, y * d.lit(0.25));
        let dir = camera.forward.scale(cos_latitude * cos_longitude)
            + camera
                .right
                .normalize(d)
                .scale(cos_latitude * sin_longitude)
            + camera.up.normalize(d).scale(sin_latitude);
        PathRay::unbounded(d, camera.eye, dir.normalize(d))
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
                lens_radius: 0.0,
                right: [0.6, 0.0, 0.8].into(),
                frame_width,
                up: [0.0, 1.5, 0.0].into(),
                frame_height,
                forward: [0.0, 0.0, -1.0].into(),
                focus_distance: 0.0,
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
