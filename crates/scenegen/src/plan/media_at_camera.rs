//! The media that the camera is in, where its paths begin.
//!
//! They are those of a ray that comes in from outside: it meets surfaces as paths do, by the same rules. Rays may slip through an edge, so that
//! three are asked, and two decide.

use glam::DVec3;
use residual_render::camera::CameraRecord;
use residual_render::domain::{Buffer, Scalar, Uint};
use residual_render::scene_data::SceneData;
use residual_render::tracer::{AnyNesting, MediumRecord, Nesting};
use residual_render::triangle::TriangleRecord;

use super::planned::PlannedObject;
use super::planned_materials::Materials;

/// Where rays come from: along no axis or diagonal, in which surfaces are modelled.
const DIRECTIONS: [DVec3; 3] = [
    DVec3::new(0.3217, 0.8931, 0.2143),
    DVec3::new(-0.7423, 0.1871, 0.5719),
    DVec3::new(0.2837, -0.4129, -0.8117),
];

/// The records of all media of a scene whose triangles are those of `data`, with the media around the eye in the first.
pub(super) fn media_words(
    materials: &Materials,
    camera: &CameraRecord,
    data: &SceneData,
    objects: &[PlannedObject],
) -> Vec<u32> {
    let mut media = SceneData::default();
    media
        .buffer_mut(Buffer::Media)
        .clone_from(&materials.media_words);
    if let Some(node) = materials.media {
        let eye = DVec3::new(
            camera.eye.x.into(),
            camera.eye.y.into(),
            camera.eye.z.into(),
        );
        let around = |direction: &DVec3| {
            let crossed = crossings(eye, *direction, materials, data, objects);
            media_of(node.nesting, &media, &crossed)
        };
        let [a, b, c] = DIRECTIONS.each_ref().map(around);
        let agreed = if b == c { b } else { a };
        media.change(0, |outside: MediumRecord| MediumRecord {
            around_camera: agreed,
            ..outside
        });
    }
    std::mem::take(media.buffer_mut(Buffer::Media))
}

/// A surface of a body that a ray goes through on its way to the eye.
struct Crossed {
    /// Distance from the eye.
    distance: f64,
    /// It is met from its front.
    front: bool,
    /// The medium behind it.
    interior: u32,
}

/// The surfaces between a place far away in this direction and the eye, as a ray meets them.
fn crossings(
    eye: DVec3,
    direction: DVec3,
    materials: &Materials,
    data: &SceneData,
    objects: &[PlannedObject],
) -> Vec<Crossed> {
    let mut crossed = Vec::new();
    for object in objects {
        let Some(interior) = materials.of(object.material).interior else {
            continue;
        };
        for index in object.triangles.clone() {
            let triangle: TriangleRecord = data.record(index as usize);
            let corners = triangle.corners().map(|p| DVec3::from(p.map(f64::from)));
            if let Some((distance, front)) = meets(eye, direction, corners) {
                crossed.push(Crossed {
                    distance,
                    front,
                    interior,
                });
            }
        }
    }
    crossed.sort_by(|a, b| b.distance.total_cmp(&a.distance));
    crossed
}

/// The distance at which the ray leaves the eye's side of a triangle, and whether one that comes in meets its front (Möller and
/// Trumbore 1997).
fn meets(eye: DVec3, direction: DVec3, [a, b, c]: [DVec3; 3]) -> Option<(f64, bool)> {
    let (ab, ac) = (b - a, c - a);
    let p = direction.cross(ac);
    let determinant = ab.dot(p);
    if determinant == 0.0 {
        return None;
    }
    let to_eye = eye - a;
    let q = to_eye.cross(ab);
    let [u, v, t] = [to_eye.dot(p), direction.dot(q), ac.dot(q)].map(|x| x / determinant);
    let is_hit = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0;
    is_hit.then(|| (t, ab.cross(ac).dot(direction) > 0.0))
}

/// The media of a ray that has gone through these surfaces.
fn media_of(nesting: AnyNesting, media: &SceneData, crossed: &[Crossed]) -> u32 {
    let buffers = media.buffers();
    let d = Scalar::new(&buffers);
    crossed.iter().fold(0, |inside, surface| {
        let interior = Uint(surface.interior);
        nesting
            .crossing(d, Uint(inside), surface.front, interior)
            .beyond
            .0
    })
}
