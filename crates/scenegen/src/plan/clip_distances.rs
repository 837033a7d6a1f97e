//! Clip distances of cameras: everything is rendered however near or far it is, and where a file's camera would not show
//! that, this says so.

use glam::Vec3;
use residual_render::camera::CameraRecord;
use residual_render::scene_data::SceneData;
use residual_render::triangle::TriangleRecord;

use crate::desc::{CameraDesc, ClipDistances, Dismissed, Projection, Warning, WarningKind};

/// Distances may differ by so much before it counts as a difference.
const SLACK: f32 = 1e-3;

/// What a camera's clip distances come to.
pub(super) enum Clipping {
    /// They would cut off nothing.
    Nothing(Dismissed),
    /// They would cut off something that is rendered.
    Something(Warning),
}

/// Looks for triangles within the image that the file's camera would not show.
pub(super) fn look(
    clip: ClipDistances,
    camera: &CameraDesc,
    record: &CameraRecord,
    data: &SceneData,
) -> Clipping {
    let view = View::new(camera.projection, record);
    let far = clip.far.unwrap_or(f32::INFINITY);
    let (mut nearer, mut farther) = (false, false);
    for triangle in data.records::<TriangleRecord>() {
        let corners = triangle.corners().map(|corner| view.seen(corner.into()));
        let depths = corners.map(|corner| corner.z);
        let least = depths.into_iter().fold(f32::INFINITY, f32::min);
        let greatest = depths.into_iter().fold(f32::NEG_INFINITY, f32::max);
        let may_be_nearer = !nearer && least < clip.near * (1.0 - SLACK) && greatest > 0.0;
        let may_be_farther = !farther && greatest > far * (1.0 + SLACK);
        if !(may_be_nearer || may_be_farther) {
            continue;
        }
        for corner in view.clip(&corners) {
            nearer |= corner.z < clip.near * (1.0 - SLACK);
            farther |= corner.z > far * (1.0 + SLACK);
        }
        if nearer && (farther || clip.far.is_none()) {
            break;
        }
    }
    let place = format!("camera {:?}", camera.name);
    let cut = match (nearer, farther) {
        (false, false) => {
            return Clipping::Nothing(Dismissed {
                effect: None,
                place,
                reason: "znear and zfar cut off nothing that is seen".to_owned(),
            });
        }
        (true, false) => format!("nearer than znear {}", clip.near),
        (false, true) => format!("farther than zfar {far}"),
        (true, true) => format!("nearer than znear {} or farther than zfar {far}", clip.near),
    };
    Clipping::Something(Warning {
        kind: WarningKind::Unfaithful,
        place,
        message: format!("clip distances are ignored: what is {cut} is rendered"),
    })
}

/// From world space to that of the camera, where z is the depth.
struct View {
    eye: Vec3,
    right: Vec3,
    up: Vec3,
    forward: Vec3,
    /// Half the size of the image: at depth 1, or at any where rays are parallel.
    half: [f32; 2],
    is_perspective: bool,
}

impl View {
    fn new(projection: Projection, camera: &CameraRecord) -> Self {
        let [eye, right, up, forward] =
            [camera.eye, camera.right, camera.up, camera.forward].map(|v| Vec3::from(v.to_array()));
        Self {
            eye,
            right: right.normalize_or_zero(),
            up: up.normalize_or_zero(),
            forward: forward.normalize_or_zero(),
            half: [right, up].map(|edge| edge.length()),
            is_perspective: match projection {
                Projection::Perspective { .. } => true,
                Projection::Orthographic { .. } => false,
            },
        }
    }

    fn seen(&self, point: Vec3) -> Vec3 {
        let from_eye = point - self.eye;
        Vec3::new(
            from_eye.dot(self.right),
            from_eye.dot(self.up),
            from_eye.dot(self.forward),
        )
    }

    /// The part of a triangle that is in front of the eye and within the image (Sutherland and Hodgman 1974).
    fn clip(&self, corners: &[Vec3; 3]) -> Vec<Vec3> {
        let [x, y] = self.half;
        let width = |p: Vec3| if self.is_perspective { p.z } else { 1.0 };
        let sides: [&dyn Fn(Vec3) -> f32; 5] = [
            &|p| p.z,
            &|p| width(p) * x - p.x,
            &|p| width(p) * x + p.x,
            &|p| width(p) * y - p.y,
            &|p| width(p) * y + p.y,
        ];
        let mut polygon = corners.to_vec();
        for inside in sides {
            let mut clipped = Vec::with_capacity(polygon.len() + 1);
            for (k, &here) in polygon.iter().enumerate() {
                let next = polygon[(k + 1) % polygon.len()];
                let (a, b) = (inside(here), inside(next));
                if a > 0.0 {
                    clipped.push(here);
                }
                if (a > 0.0) != (b > 0.0) {
                    clipped.push(here.lerp(next, a / (a - b)));
                }
            }
            polygon = clipped;
        }
        polygon
    }
}
