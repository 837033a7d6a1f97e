//! KHR_lights_punctual, placed in the world.

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};

use glam::DVec3;
use gltf::json::Index;
use gltf::json::extensions::scene::khr_lights_punctual::{Light, Type};
use gltf::json::validation::Checked;

use super::document::Document;
use super::lookup::{find, place};
use super::nodes::PlacedNode;
use crate::desc::{LightDesc, PunctualKind};
use crate::import::error::Fault;
use crate::import::warnings::Warnings;

/// The light of a node, relative to an origin; `None`, after a warning, where it cannot shine.
pub(super) fn read(
    document: &Document,
    index: Index<Light>,
    placed: &PlacedNode<'_>,
    origin: DVec3,
    warnings: &mut Warnings,
) -> Result<Option<LightDesc>, Fault> {
    let extension = document
        .root
        .extensions
        .as_ref()
        .and_then(|root| root.khr_lights_punctual.as_ref());
    let lights = extension.map_or(&[][..], |extension| &extension.lights);
    let array = "extensions/KHR_lights_punctual/lights";
    let without = "it is left out";
    let Some(light) = find(lights, index, array, &placed.place, without, warnings) else {
        return Ok(None);
    };
    let at = place(array, index.value(), light.name.as_deref());

    let position = (placed.world.translation - origin).as_vec3();
    let direction = placed
        .world
        .transform_vector3(DVec3::NEG_Z)
        .try_normalize()
        .map(|axis| axis.as_vec3().normalize());
    let kind = match (&light.type_, direction) {
        (Checked::Invalid, _) => return Err(Fault::new(at, "has an unknown type")),
        (Checked::Valid(Type::Point), _) => PunctualKind::Point { position },
        (Checked::Valid(Type::Spot), Some(direction)) => {
            let (inner, outer) = cone(light, &at, warnings);
            PunctualKind::Spot {
                position,
                direction,
                inner,
                outer,
            }
        }
        (Checked::Valid(Type::Directional), Some(direction)) => {
            PunctualKind::Directional { direction }
        }
        (Checked::Valid(Type::Spot | Type::Directional), None) => {
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
        size: 0.0,
    }))
}

/// The cone's half-angles, with 0 ≤ inner ≤ outer ≤ π/2 and outer > 0.
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
    // The specification wants the two to differ; exporters write the same for a hard edge.
    if inner >= 0.0 && inner <= valid_outer {
        return (inner, valid_outer);
    }
    let valid_inner = if inner >= valid_outer {
        valid_outer
    } else {
        0.0
    };
    warnings.push(
        at,
        format!("innerConeAngle {inner} is not in [0, outerConeAngle]; {valid_inner} is used"),
    );
    (valid_inner, valid_outer)
}
