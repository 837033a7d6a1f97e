//! Cameras.

use crate::domain::{Buffer, Domain};
use crate::math::Vec3;
use crate::math::elementary::{atan2, sincos_turns};
use crate::math::warp::{FRAC_1_PI, disc};
use crate::record::record;
use crate::scene_data::SceneData;
use crate::surface::PathRay;

/// A camera: turns points of the film into rays.
pub trait Camera<D: Domain> {
    /// The ray through film coordinates in [−1, 1], x to the right, y up. Its direction is a unit vector. `lens` are two
    /// random numbers in [0, 1) where the camera [has a lens](Camera::has_lens).
    fn ray(&self, d: D, film: [D::F; 2], lens: [D::F; 2]) -> PathRay<D>;

    /// Where a point is seen, by way of the place of the lens that `lens` stands for.
    fn sight(&self, d: D, point: Vec3<D::F>, lens: [D::F; 2]) -> Sight<D>;

    /// Density, per area across the ray, with which rays through places that are evenly spread over the film arrive at this
    /// distance in the unit direction `dir`: the importance of a place there, divided by that of the whole film.
    fn density(&self, d: D, dir: Vec3<D::F>, distance: D::F) -> D::F;

    /// Whether rays pass through different points of a lens: others need no random numbers for it.
    #[inline(always)]
    fn has_lens(&self) -> bool {
        false
    }
}

/// Where a camera sees a point.
#[derive(Clone, Copy, Debug)]
pub struct Sight<D: Domain> {
    /// The place where the ray to the point begins.
    pub from: Vec3<D::F>,
    /// Film coordinates; within [−1, 1] if the point is in the image.
    pub film: [D::F; 2],
    /// The point is before the camera, not behind it.
    pub is_before: D::M,
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

    /// A place on the lens, given from its middle.
    #[inline(always)]
    fn on_lens(&self, d: D, lens: [D::F; 2]) -> Vec3<D::F> {
        let [x, y] = disc(d, lens).map(|c| c * self.lens_radius);
        self.right.normalize(d).scale(x) + self.up.normalize(d).scale(y)
    }

    /// Film coordinates of a place in the film's plane, given from the film's centre.
    #[inline(always)]
    fn film(&self, d: D, place: Vec3<D::F>) -> [D::F; 2] {
        [self.right, self.up].map(|edge| place.dot(d, edge) / edge.dot(d, edge))
    }

    /// The film's area.
    #[inline(always)]
    fn film_area(&self, d: D) -> D::F {
        self.right.length(d) * self.up.length(d) * d.lit(4.0)
    }

    /// [`Camera::density`] of rays from a point through the film, whose distance to the point is the length of `forward` (PBRT 3,
    /// section 16.1.1).
    #[inline(always)]
    fn density_from_point(&self, d: D, dir: Vec3<D::F>, distance: D::F) -> D::F {
        let squared = self.forward.dot(d, self.forward);
        let along = dir.dot(d, self.forward);
        let cos = d.max(along / d.sqrt(squared), d.lit(1e-6));
        let of_film = self.film_area(d) * cos * cos * cos;
        squared / (of_film * distance * distance)
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

    #[inline(always)]
    fn sight(&self, d: D, point: Vec3<D::F>, _: [D::F; 2]) -> Sight<D> {
        let camera = CameraRecord::uniform(d);
        let towards = point - camera.eye;
        let depth = towards.dot(d, camera.forward);
        let is_before = d.lt(d.lit(0.0), depth);
        let scale = camera.forward.dot(d, camera.forward) / d.select(is_before, depth, d.lit(1.0));
        Sight {
            from: camera.eye,
            film: camera.film(d, towards.scale(scale)),
            is_before,
        }
    }

    #[inline(always)]
    fn density(&self, d: D, dir: Vec3<D::F>, distance: D::F) -> D::F {
        CameraRecord::uniform(d).density_from_point(d, dir, distance)
    }
}

impl<D: Domain> Camera<D> for ThinLens {
    #[inline(always)]
    fn ray(&self, d: D, film: [D::F; 2], lens: [D::F; 2]) -> PathRay<D> {
        let camera = CameraRecord::uniform(d);
        // What a pinhole sees in the plane of focus, every point of the lens sees in the same place of the film.
        let focus = (camera.forward + camera.on_film(film)).scale(camera.focus_distance);
        let on_lens = camera.on_lens(d, lens);
        let dir = (focus - on_lens).normalize(d);
        PathRay::unbounded(d, camera.eye + on_lens, dir)
    }

    #[inline(always)]
    fn sight(&self, d: D, point: Vec3<D::F>, lens: [D::F; 2]) -> Sight<D> {
        let camera = CameraRecord::uniform(d);
        let on_lens = camera.on_lens(d, lens);
        let towards = point - (camera.eye + on_lens);
        let depth = towards.dot(d, camera.forward);
        let is_before = d.lt(d.lit(0.0), depth);
        let scale = camera.focus_distance / d.select(is_before, depth, d.lit(1.0));
        let focus = on_lens + towards.scale(scale);
        let on_film = focus.scale(d.lit(1.0) / camera.focus_distance);
        Sight {
            from: camera.eye + on_lens,
            film: camera.film(d, on_film),
            is_before,
        }
    }

    #[inline(always)]
    fn density(&self, d: D, dir: Vec3<D::F>, distance: D::F) -> D::F {
        CameraRecord::uniform(d).density_from_point(d, dir, distance)
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

    #[inline(always)]
    fn sight(&self, d: D, point: Vec3<D::F>, _: [D::F; 2]) -> Sight<D> {
        let camera = CameraRecord::uniform(d);
        let towards = point - camera.eye;
        let film = camera.film(d, towards);
        Sight {
            from: camera.eye + camera.on_film(film),
            film,
            is_before: d.lt(d.lit(0.0), towards.dot(d, camera.forward)),
        }
    }

    #[inline(always)]
    fn density(&self, d: D, _: Vec3<D::F>, _: D::F) -> D::F {
        d.lit(1.0) / CameraRecord::uniform(d).film_area(d)
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

    #[inline(always)]
    fn sight(&self, d: D, point: Vec3<D::F>, _: [D::F; 2]) -> Sight<D> {
        let camera = CameraRecord::uniform(d);
        let towards = point - camera.eye;
        let [along, across, above] =
            [camera.forward, camera.right, camera.up].map(|axis| towards.dot(d, axis.normalize(d)));
        let level = d.sqrt(d.fma(along, along, across * across));
        let longitude = atan2(d, across, along);
        let latitude = atan2(d, above, level);
        Sight {
            from: camera.eye,
            film: [
                longitude * d.lit(FRAC_1_PI),
                latitude * d.lit(2.0 * FRAC_1_PI),
            ],
            is_before: d.truth(true),
        }
    }

    #[inline(always)]
    fn density(&self, d: D, dir: Vec3<D::F>, distance: D::F) -> D::F {
        let camera = CameraRecord::uniform(d);
        let sin = dir.dot(d, camera.up.normalize(d));
        let cos = d.sqrt(d.max(d.lit(1.0) - sin * sin, d.lit(1e-9)));
        // Film coordinates are π of longitude and π/2 of latitude, and the film is two of each.
        let per_steradian = d.lit(0.5 * FRAC_1_PI * FRAC_1_PI) / cos;
        per_steradian / (distance * distance)
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
