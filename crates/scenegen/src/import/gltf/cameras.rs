//! Cameras, placed in the world.

use std::f32::consts::{FRAC_PI_4, PI};

use glam::{DAffine3, DMat3, DQuat, DVec3};
use gltf::json::camera::Type;
use gltf::json::validation::Checked;
use gltf::json::{Camera, Index};

use super::document::Document;
use super::lookup::{find, place};
use super::nodes::PlacedNode;
use crate::desc::{CameraDesc, ClipDistances, Projection};
use crate::import::error::Fault;
use crate::import::warnings::Warnings;

/// The vertical field of view where a file gives an impossible one, in radians.
const DEFAULT_YFOV: f32 = FRAC_PI_4;

/// Frames wider or higher than that are mistakes.
const LARGEST_ASPECT: f32 = 1e4;

/// What the file says of a lens.
struct Lens {
    projection: Projection,
    frame_aspect: Option<f32>,
    clip: ClipDistances,
}

/// The camera of a node, relative to an origin; `None`, after a warning, where it sees nothing.
pub(super) fn read(
    document: &Document,
    index: Index<Camera>,
    placed: &PlacedNode<'_>,
    origin: DVec3,
    warnings: &mut Warnings,
) -> Result<Option<CameraDesc>, Fault> {
    let cameras = &document.root.cameras;
    let without = "it is left out";
    let Some(camera) = find(cameras, index, "cameras", &placed.place, without, warnings) else {
        return Ok(None);
    };
    let at = place("cameras", index.value(), camera.name.as_deref());
    let lens = lens(camera, &at, warnings)?;
    let position = (placed.world.translation - origin).as_vec3();
    let Some(rotation) = rotation_of(&placed.world).filter(|_| position.is_finite()) else {
        warnings.push(
            &*placed.place,
            "the transform leaves the camera no orientation; it is left out",
        );
        return Ok(None);
    };
    let name = placed
        .node
        .name
        .clone()
        .or_else(|| camera.name.clone())
        .unwrap_or_else(|| placed.name.clone());
    Ok(Some(CameraDesc {
        name,
        position,
        rotation: rotation.as_quat().normalize(),
        projection: lens.projection,
        frame_aspect: lens.frame_aspect,
        clip: Some(lens.clip),
    }))
}

fn lens(camera: &Camera, at: &str, warnings: &mut Warnings) -> Result<Lens, Fault> {
    match (&camera.type_, &camera.perspective, &camera.orthographic) {
        (Checked::Valid(Type::Perspective), Some(perspective), _) => {
            let mut yfov = perspective.yfov;
            if !(yfov > 0.0 && yfov < PI) {
                warnings.push(at, format!("yfov {yfov} is not in (0, π); π/4 is used"));
                yfov = DEFAULT_YFOV;
            }
            let aspect = perspective.aspect_ratio;
            Ok(Lens {
                projection: Projection::Perspective { yfov },
                frame_aspect: aspect.and_then(|aspect| frame("aspectRatio", aspect, at, warnings)),
                clip: ClipDistances {
                    near: perspective.znear,
                    far: perspective.zfar,
                },
            })
        }
        (Checked::Valid(Type::Orthographic), _, Some(orthographic)) => {
            let mut ymag = orthographic.ymag.abs();
            if !(ymag > 0.0 && ymag.is_finite()) {
                warnings.push(
                    at,
                    format!("ymag {ymag} is not a positive number; 1 is used"),
                );
                ymag = 1.0;
            }
            let xmag = orthographic.xmag.abs();
            Ok(Lens {
                projection: Projection::Orthographic { ymag },
                frame_aspect: frame("xmag / ymag", xmag / ymag, at, warnings),
                clip: ClipDistances {
                    near: orthographic.znear,
                    far: Some(orthographic.zfar),
                },
            })
        }
        (Checked::Valid(_), _, _) => Err(Fault::new(at, "lacks the object that its type names")),
        (Checked::Invalid, _, _) => Err(Fault::new(at, "has an unknown type")),
    }
}

/// Width over height of the frame, if it is one.
fn frame(member: &str, aspect: f32, at: &str, warnings: &mut Warnings) -> Option<f32> {
    let is_valid = (1.0 / LARGEST_ASPECT..=LARGEST_ASPECT).contains(&aspect);
    if !is_valid {
        let message = format!("{member} {aspect} is no shape of a frame; only its height counts");
        warnings.push(at, message);
    }
    is_valid.then_some(aspect)
}

/// The rotation of a transform that may also scale and shear; `None` where the view axis or the up axis
/// collapses.
fn rotation_of(world: &DAffine3) -> Option<DQuat> {
    let back = world.matrix3.z_axis.try_normalize()?;
    let up = world.matrix3.y_axis;
    let up = (up - back * up.dot(back)).try_normalize()?;
    let rotation = DQuat::from_mat3(&DMat3::from_cols(up.cross(back), up, back));
    rotation.is_finite().then(|| rotation.normalize())
}
