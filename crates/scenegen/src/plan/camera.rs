//! The camera: one of the scene's, one given by the user, or one that frames the scene.

use glam::{DVec3, Quat, Vec3};
use residual_render::camera::{CameraRecord, PixelConeRecord, fitted_height};
use residual_render::domain::Buffer;
use residual_render::light::SceneSphereRecord;
use residual_render::program::CameraNode;
use residual_render::record::BufferRecord;
use residual_render::scene_data::SceneData;

use super::camera_choice::CameraChoice;
use super::error::PlanError;
use super::optics::{Focus, Optics, distance_in_the_middle};
use super::options::PlanOptions;
use crate::desc::{CameraDesc, Pose, Projection, SceneDesc, Warning, WarningKind};

/// Bounds of the scene in world space.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    pub(super) lo: Vec3,
    pub(super) hi: Vec3,
}

impl Bounds {
    pub(super) const EMPTY: Self = Self {
        lo: Vec3::splat(f32::INFINITY),
        hi: Vec3::splat(f32::NEG_INFINITY),
    };

    pub(super) fn add(&mut self, p: Vec3) {
        self.lo = self.lo.min(p);
        self.hi = self.hi.max(p);
    }

    /// Centre and radius of the sphere around the box; the unit sphere where there is nothing.
    pub(super) fn sphere(&self) -> (Vec3, f32) {
        if self.lo.cmpgt(self.hi).any() {
            return (Vec3::ZERO, 1.0);
        }
        // Halved first: the sum of two large coordinates may overflow.
        let half = self.hi * 0.5 - self.lo * 0.5;
        (
            self.lo * 0.5 + self.hi * 0.5,
            half.length().clamp(1e-6, 1e30),
        )
    }

    /// Nothing in the box is farther away from a place than this.
    pub(super) fn farthest(&self, from: Vec3) -> f32 {
        let (centre, radius) = self.sphere();
        let corner = (from - centre).abs() + (self.hi * 0.5 - self.lo * 0.5);
        match corner.is_finite() {
            true => corner.length(),
            false => (from - centre).length() + radius,
        }
    }
}

const FRAMING_FOV: f32 = 0.7;
/// The part of the image's width or height that the scene fills.
const FRAMING_PART: f32 = 0.92;

/// A camera from the front, somewhat above and to the right, whose image the scene's box fills.
fn framing(bounds: &Bounds, aspect: f32) -> CameraDesc {
    let (centre, radius) = bounds.sphere();
    let dir = Vec3::new(-0.27, -0.32, -0.91).normalize();
    let rotation = look(dir, Vec3::Y);
    let tan = (FRAMING_FOV * 0.5).tan();
    let half = match bounds.lo.cmpgt(bounds.hi).any() {
        true => Vec3::ONE,
        false => bounds.hi * 0.5 - bounds.lo * 0.5,
    };
    let sides = [-1.0, 1.0];
    let corners = sides.into_iter().flat_map(|x| {
        sides
            .into_iter()
            .flat_map(move |y| sides.map(|z| half * Vec3::new(x, y, z)))
    });
    // Each corner says how far away the camera has to be to see it.
    let distance = corners.map(|corner| {
        let seen = rotation.inverse() * corner;
        let across = (seen.x.abs() / aspect).max(seen.y.abs());
        across / (tan * FRAMING_PART) + seen.z
    });
    let distance = distance.fold(radius, f32::max);
    CameraDesc {
        name: "framing".to_owned(),
        position: centre - dir * distance,
        rotation,
        projection: Projection::Perspective { yfov: FRAMING_FOV },
        frame_aspect: None,
        clip: None,
    }
}

/// A direction of any length as one of length 1; zero stays.
fn unit(direction: DVec3) -> Vec3 {
    let largest = direction.abs().max_element();
    (direction / largest).normalize_or_zero().as_vec3()
}

fn are_parallel(a: DVec3, b: DVec3) -> bool {
    unit(a).cross(unit(b)).length() < 1e-6
}

/// The rotation that looks along `dir` with `up` upwards; both may have any length, and be parallel.
fn look(dir: Vec3, up: Vec3) -> Quat {
    let back = -dir.normalize_or(Vec3::NEG_Z);
    // Maps have north, which is -Z, at the top.
    let north = Vec3::NEG_Z.cross(back).normalize_or(Vec3::X);
    let right = up.cross(back).normalize_or(north);
    Quat::from_mat3(&glam::Mat3::from_cols(right, back.cross(right), back))
}

fn named<'a>(pose: Pose<'a>, wanted: &str) -> Result<&'a CameraDesc, PlanError> {
    let by_name = pose.cameras.iter().find(|camera| camera.name == wanted);
    let by_index = || {
        wanted
            .parse::<usize>()
            .ok()
            .and_then(|index| pose.cameras.get(index))
    };
    by_name.or_else(by_index).ok_or_else(|| {
        let list = |(index, camera): (usize, &CameraDesc)| format!("{index} {:?}", camera.name);
        let names: Vec<_> = pose.cameras.iter().enumerate().map(list).collect();
        let available = if names.is_empty() {
            "no cameras".to_owned()
        } else {
            names.join(", ")
        };
        PlanError::NoSuchCamera {
            wanted: format!("{wanted:?}"),
            available,
        }
    })
}

/// A camera, and what it is focused on.
pub(super) struct Shot {
    pub(super) camera: CameraDesc,
    /// 0 of cameras without a lens.
    pub(super) focus_distance: f32,
}

/// Chooses the camera of a pose and writes its buffer. Its clip distances are not rendered. `focused` is how far away all is sharp
/// if that is known: focus does not follow what moves while the shutter is open.
pub(super) fn choose(
    (scene, pose): (&SceneDesc, Pose<'_>),
    options: &PlanOptions,
    bounds: &Bounds,
    focused: Option<f32>,
    data: &mut SceneData,
    warnings: &mut Vec<Warning>,
) -> Result<(CameraNode, Shot), PlanError> {
    let aspect = options.size[0] as f32 / options.size[1] as f32;
    let default = || {
        pose.cameras
            .first()
            .cloned()
            .unwrap_or_else(|| framing(bounds, aspect))
    };
    let mut camera = match &options.camera {
        CameraChoice::Default => {
            if pose.cameras.is_empty() {
                warnings.push(Warning {
                    kind: WarningKind::NoCamera,
                    place: "cameras".to_owned(),
                    message: "the scene has no camera; using one that frames it".to_owned(),
                });
            }
            default()
        }
        CameraChoice::Named(wanted) => named(pose, wanted)?.clone(),
        CameraChoice::View(view) => {
            let default = default();
            // A direction given without "up" means an upright camera, whatever the default's tilt.
            let dir = view.dir.map_or(
                (default.rotation * Vec3::NEG_Z).as_dvec3(),
                DVec3::from_array,
            );
            let up = view.up.map(DVec3::from_array);
            if let Some(up) = up.filter(|up| are_parallel(*up, dir)) {
                let [dir, up] = [dir, up].map(|v| v.to_array());
                return Err(PlanError::UpAlongView { dir, up });
            }
            let up = up.unwrap_or(DVec3::Y);
            CameraDesc {
                name: "given".to_owned(),
                position: view.eye.map_or(default.position, |eye| {
                    (DVec3::from_array(eye) - scene.origin).as_vec3()
                }),
                rotation: if view.dir.is_some() || view.up.is_some() {
                    look(unit(dir), unit(up))
                } else {
                    default.rotation
                },
                projection: match view.fov {
                    Some(degrees) => Projection::Perspective {
                        yfov: degrees.to_radians(),
                    },
                    None => default.projection,
                },
                frame_aspect: default.frame_aspect.filter(|_| view.fov.is_none()),
                clip: default.clip,
            }
        }
    };
    let frame_height = match camera.projection {
        Projection::Perspective { yfov } => (yfov * 0.5).tan(),
        Projection::Orthographic { ymag } => ymag,
    };
    let (mut lens_radius, mut focus_distance) = (0.0, 0.0);
    let kind = match (options.optics, camera.projection) {
        (Optics::Projection, Projection::Perspective { .. }) => CameraNode::Perspective,
        (Optics::Projection, Projection::Orthographic { .. }) => CameraNode::Orthographic,
        (Optics::ThinLens { aperture, focus }, Projection::Perspective { .. }) => {
            lens_radius = aperture.radius(frame_height);
            focus_distance = match (focus, focused) {
                (Focus::Distance(distance), _) | (Focus::Middle, Some(distance)) => distance,
                (Focus::Middle, None) => {
                    distance_in_the_middle(&camera, data).ok_or(PlanError::NothingInFocus)?
                }
            };
            CameraNode::ThinLens
        }
        (Optics::ThinLens { .. }, Projection::Orthographic { .. }) => {
            return Err(PlanError::NoLens {
                camera: format!("{:?}", camera.name),
            });
        }
        (Optics::Panorama, _) => {
            // They are of the file's camera, which sees less.
            camera.clip = None;
            CameraNode::Panorama
        }
    };
    let frame_width = camera
        .frame_aspect
        .map_or(0.0, |frame_aspect| frame_height * frame_aspect);
    let half_height = fitted_height([frame_width, frame_height], aspect);
    let right = camera.rotation * Vec3::X * (half_height * aspect);
    let up = camera.rotation * Vec3::Y * half_height;
    let forward = camera.rotation * Vec3::NEG_Z;
    let [eye, right, up, forward] =
        [camera.position, right, up, forward].map(|v| v.to_array().into());
    data.push(CameraRecord {
        eye,
        lens_radius,
        right,
        frame_width,
        up,
        frame_height,
        forward,
        focus_distance,
    });
    let shot = Shot {
        camera,
        focus_distance,
    };
    Ok((kind, shot))
}

/// Writes what some renderers read behind the camera's record: what camera rays stand for, where textures are filtered, and a sphere
/// around everything, where paths begin at lights.
pub(super) fn set_other_records(
    camera: &CameraNode,
    options: &PlanOptions,
    filters: bool,
    bounds: &Bounds,
    data: &mut SceneData,
) {
    let has_light_paths = options.tracer.has_light_paths();
    if filters || has_light_paths {
        set_pixel_cone(camera, data);
    }
    if has_light_paths {
        let (centre, radius) = bounds.sphere();
        let centre = centre.to_array().into();
        let sphere = SceneSphereRecord { centre, radius };
        sphere.append_to(data.buffer_mut(Buffer::Camera));
    }
}

/// Writes what camera rays stand for.
fn set_pixel_cone(camera: &CameraNode, data: &mut SceneData) {
    let (parallel, spread, turn) = match camera {
        // The film is at a distance of 1.
        CameraNode::Perspective | CameraNode::ThinLens => (0.0, 1.0, 0.0),
        CameraNode::Orthographic => (1.0, 0.0, 0.0),
        CameraNode::Panorama => (0.0, 0.0, std::f32::consts::FRAC_PI_2),
    };
    let record = PixelConeRecord {
        parallel,
        spread,
        turn,
    };
    record.append_to(data.buffer_mut(Buffer::Camera));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where the corners of a box are in the image, from −1 to 1 across and up.
    fn corners(camera: &CameraDesc, bounds: &Bounds, aspect: f32) -> Vec<[f32; 2]> {
        let tan = (FRAMING_FOV * 0.5).tan();
        let corner = |k: usize| {
            let pick = |bit: usize, axis: usize| match k >> bit & 1 {
                0 => bounds.lo[axis],
                _ => bounds.hi[axis],
            };
            let place = Vec3::new(pick(0, 0), pick(1, 1), pick(2, 2));
            let seen = camera.rotation.inverse() * (place - camera.position);
            assert!(seen.z < 0.0, "before the camera");
            [seen.x / -seen.z / tan / aspect, seen.y / -seen.z / tan]
        };
        (0..8).map(corner).collect()
    }

    #[test]
    fn the_default_camera_sees_all_and_the_scene_fills_its_image() {
        let boxes = [
            [1.0; 3],
            [10.0, 0.1, 1.0],
            [0.1, 7.0, 0.1],
            [1.0, 1e-3, 1.0],
            [1e-4, 2e-4, 1e-4],
        ];
        for half in boxes.map(Vec3::from) {
            for aspect in [0.5, 1.0, 16.0 / 9.0] {
                let centre = Vec3::new(3.0, -2.0, 5.0);
                let bounds = Bounds {
                    lo: centre - half,
                    hi: centre + half,
                };
                let camera = framing(&bounds, aspect);
                let corners = corners(&camera, &bounds, aspect);
                let largest = corners
                    .as_flattened()
                    .iter()
                    .fold(0.0, |a: f32, b| a.max(b.abs()));
                assert!(
                    (largest / FRAMING_PART - 1.0).abs() < 0.02,
                    "{half} {aspect}: {largest}"
                );
            }
        }
        let nothing = framing(&Bounds::EMPTY, 1.0);
        assert!(nothing.position.is_finite());
    }
}
