//! Where cameras see points: the inverse of the rays that they make, and the density of those.

use residual_render::camera::{Camera, CameraRecord, Sight};
use residual_render::domain::{Precise, Scalar};
use residual_render::math::Vec3;
use residual_render::program::CameraNode;
use residual_render::scene_data::SceneData;

const CAMERAS: [CameraNode; 4] = [
    CameraNode::Perspective,
    CameraNode::ThinLens,
    CameraNode::Orthographic,
    CameraNode::Panorama,
];

/// A camera that looks along a tilted direction, whose film is twice as wide as high.
fn data() -> SceneData {
    let mut data = SceneData::default();
    data.push(CameraRecord {
        eye: [0.5, -1.0, 2.0].into(),
        lens_radius: 0.2,
        right: [0.64, 0.0, 0.48].into(),
        frame_width: 0.0,
        up: [-0.144, 0.32, 0.192].into(),
        frame_height: 0.4,
        forward: [-0.48, -0.6, 0.64].into(),
        focus_distance: 3.0,
    });
    data
}

/// Places of the film and the lens.
fn places() -> impl Iterator<Item = ([f64; 2], [f64; 2])> {
    let steps = [-0.9, -0.4, 0.05, 0.7];
    steps
        .into_iter()
        .flat_map(move |x| steps.map(|y| [x, y]))
        .zip([[0.0, 0.3], [0.9, 0.1], [0.4, 0.8]].into_iter().cycle())
}

#[test]
fn a_point_on_a_camera_ray_is_seen_where_the_ray_began() {
    let data = data();
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    for node in &CAMERAS {
        let camera = node.boxed::<Scalar<'_>>();
        for (film, lens) in places() {
            let [film, lens] = [film, lens].map(|place| place.map(|x| x as f32));
            let ray = camera.ray(d, film, lens);
            let point = ray.org + ray.dir.scale(1.7);
            let Sight {
                from,
                film: seen,
                is_before,
            } = camera.sight(d, point, lens);
            assert!(is_before, "{node:?}");
            assert!((from - ray.org).length(d) < 2e-6, "{node:?}");
            for k in 0..2 {
                assert!(
                    (seen[k] - film[k]).abs() < 3e-6,
                    "{node:?}: {seen:?} {film:?}"
                );
            }
            if !matches!(node, CameraNode::Panorama) {
                let behind = ray.org - ray.dir.scale(1.7);
                assert!(!camera.sight(d, behind, lens).is_before, "{node:?}");
            }
        }
    }
}

/// By differences of neighbouring rays: the part of the film's area over the area across the rays.
#[test]
fn densities_are_film_over_area() {
    let data = data();
    let buffers = data.buffers();
    let d = Precise::new(&buffers);
    for node in &CAMERAS {
        let camera = node.boxed::<Precise<'_>>();
        for (film, lens) in places() {
            let at = |film: [f64; 2]| camera.ray(d, film, lens);
            let ray = at(film);
            let distance = 2.3;
            let step = 1e-4;
            let beside = |k: usize| {
                let ends = [-1.0, 1.0].map(|sign| {
                    let mut place = film;
                    place[k] += sign * step;
                    let ray = at(place);
                    ray.org + ray.dir.scale(distance)
                });
                let difference = ends[1] - ends[0];
                let along = difference.dot(d, ray.dir);
                difference - ray.dir.scale(along)
            };
            let across: Vec3<f64> = beside(0).cross(beside(1));
            let expected = (2.0 * step).powi(2) / 4.0 / across.length(d);
            let density = camera.density(d, ray.dir, distance);
            assert!(
                (density / expected - 1.0).abs() < 1e-5,
                "{node:?} at {film:?}: {density} {expected}"
            );
        }
    }
}
