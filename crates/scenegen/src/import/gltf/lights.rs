//! KHR_lights_punctual and cameras, placed in the world.

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use glam::DVec3;
use gltf::json::camera::Type as CameraType;
use gltf::json::extensions::scene::khr_lights_punctual::{Light, Type as LightType};
use gltf::json::validation::Checked;
use gltf::json::{Camera, Index};

use super::document::{Document, get};
use super::nodes::{Placed, rotation_of};
use crate::desc::{CameraDesc, LightDesc, LightKind, Projection};
use crate::import::error::{Fault, Warnings, place};

/// The vertical field of view where a file gives an impossible one, in radians.
const DEFAULT_YFOV: f32 = FRAC_PI_4;

/// The light of a node; `None`, after a warning, where it cannot shine.
pub(super) fn light(
    document: &Document,
    index: Index<Light>,
    placed: &Placed<'_>,
    warnings: &mut Warnings,
) -> Result<Option<LightDesc>, Fault> {
    let extension = document
        .root
        .extensions
        .as_ref()
        .and_then(|root| root.khr_lights_punctual.as_ref());
    let lights = extension.map_or(&[][..], |extension| &extension.lights);
    let light = get(
        lights,
        index,
        "extensions/KHR_lights_punctual/lights",
        &placed.place,
    )?;
    let at = place(
        "extensions/KHR_lights_punctual/lights",
        index.value(),
        light.name.as_deref(),
    );

    let position = placed.world.translation.as_vec3();
    let direction = placed
        .world
        .transform_vector3(DVec3::NEG_Z)
        .try_normalize()
        .map(|axis| axis.as_vec3().normalize());
    let kind = match (&light.type_, direction) {
        (Checked::Invalid, _) => return Err(Fault::new(at, "has an unknown type")),
        (Checked::Valid(LightType::Point), _) => LightKind::Point { position },
        (Checked::Valid(LightType::Spot), Some(direction)) => {
            let (inner, outer) = cone(light, &at, warnings);
            LightKind::Spot {
                position,
                direction,
                inner,
                outer,
            }
        }
        (Checked::Valid(LightType::Directional), Some(direction)) => {
            LightKind::Directional { direction }
        }
        (Checked::Valid(LightType::Spot | LightType::Directional), None) => {
            warnings.push(
                &*placed.place,
                "the transform leaves the light no direction; it is left out",
            );
            return Ok(None);
        }
    };
    if !position.is_finite() {
        warnings.push(
            &*placed.place,
            "the transform is not finite; the light is left out",
        );
        return Ok(None);
    }
    // `range` is a hint for rasterisers that cut lights off; light falls off with the square here.
    let is_valid = |value: f32| value.is_finite() && value >= 0.0;
    let mut intensity = light.color.map(|channel| channel * light.intensity);
    if !(is_valid(light.intensity) && intensity.into_iter().chain(light.color).all(is_valid)) {
        warnings.push(
            at,
            "the intensity is negative or not finite; the light is dark",
        );
        intensity = [0.0; 3];
    }
    let name = light.name.clone().unwrap_or_else(|| placed.name.clone());
    Ok(Some(LightDesc {
        name,
        kind,
        intensity,
    }))
}

/// The cone's half-angles, with 0 ≤ inner < outer ≤ π/2.
fn cone(light: &Light, at: &str, warnings: &mut Warnings) -> (f32, f32) {
    let (inner, outer) = light.spot.as_ref().map_or((0.0, FRAC_PI_4), |spot| {
        (spot.inner_cone_angle, spot.outer_cone_angle)
    });
    // π/2 written with a few decimals may be a little more.
    let is_valid = |outer: f32| outer > 0.0 && outer <= FRAC_PI_2 * 1.0001;
    let valid_outer = if is_valid(outer) {
        outer.min(FRAC_PI_2)
    } else {
        FRAC_PI_4
    };
    if !is_valid(outer) {
        warnings.push(
            at,
            format!("outerConeAngle {outer} is not in (0, π/2]; π/4 is used"),
        );
    }
    if inner >= 0.0 && inner < valid_outer {
        return (inner, valid_outer);
    }
    let valid_inner = if inner >= valid_outer {
        valid_outer * 0.999
    } else {
        0.0
    };
    warnings.push(
        at,
        format!("innerConeAngle {inner} is not in [0, outerConeAngle); {valid_inner} is used"),
    );
    (valid_inner, valid_outer)
}

/// The camera of a node; `None`, after a warning, where it sees nothing.
pub(super) fn camera(
    document: &Document,
    index: Index<Camera>,
    placed: &Placed<'_>,
    warnings: &mut Warnings,
) -> Result<Option<CameraDesc>, Fault> {
    let camera = get(&document.root.cameras, index, "cameras", &placed.place)?;
    let at = place("cameras", index.value(), camera.name.as_deref());
    let projection = match (&camera.type_, &camera.perspective, &camera.orthographic) {
        (Checked::Valid(CameraType::Perspective), Some(perspective), _) => {
            let mut yfov = perspective.yfov;
            if !(yfov > 0.0 && yfov < PI) {
                warnings.push(at, format!("yfov {yfov} is not in (0, π); π/4 is used"));
                yfov = DEFAULT_YFOV;
            }
            Projection::Perspective { yfov }
        }
        (Checked::Valid(CameraType::Orthographic), _, Some(orthographic)) => {
            let mut ymag = orthographic.ymag.abs();
            if !(ymag > 0.0 && ymag.is_finite()) {
                warnings.push(
                    at,
                    format!("ymag {ymag} is not a positive number; 1 is used"),
                );
                ymag = 1.0;
            }
            Projection::Orthographic { ymag }
        }
        (Checked::Valid(_), _, _) => {
            return Err(Fault::new(at, "lacks the object that its type names"));
        }
        (Checked::Invalid, _, _) => return Err(Fault::new(at, "has an unknown type")),
    };
    let position = placed.world.translation.as_vec3();
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
        projection,
    }))
}
