//! EXT_lights_area (a draft: KhronosGroup/glTF, pull request 2525): rectangles and discs that shine along −Z of their nodes, with
//! the same radiance in all directions. They become meshes that emit from their front, reflect nothing, and are single-sided, so
//! that cameras and mirrors see them as they see other emitters.

use std::f64::consts::TAU;

use glam::{DAffine3, DMat3, DVec2, DVec3, Vec2, Vec3};
use gltf::json::{Index, Node, Value};
use serde_json::Map;

use super::document::Document;
use super::lookup::{find, place};
use super::materials::Materials;
use super::nodes::PlacedNode;
use super::placements::Placement;
use crate::desc::{ColorInput, MaterialDesc, MeshDesc, PhongSurface, ScalarInput, SurfaceDesc};
use crate::import::budget::Budget;
use crate::import::error::Fault;
use crate::import::warnings::Warnings;

/// The extension's name.
const EXTENSION: &str = "EXT_lights_area";

/// Corners of the polygon that stands for a disc, with the disc's area: its rim is a thousandth of the radius off.
const DISC_CORNERS: u32 = 64;

/// Most of what a placed light takes: its mesh, its material, its instance.
const BYTES_PLACED: u64 = 4096;

/// The area lights of a file, read as nodes ask for them.
pub(super) struct AreaLights<'a> {
    lights: &'a [Value],
    /// The index in the scene of each light's mesh, once asked for; `None` where it cannot shine.
    meshes: Vec<Option<Option<usize>>>,
}

/// Whether a node has an area light.
pub(super) fn is_at(node: &Node) -> bool {
    of_node(node).is_some()
}

fn of_node(node: &Node) -> Option<&Value> {
    node.extensions.as_ref()?.others.get(EXTENSION)
}

impl<'a> AreaLights<'a> {
    /// None of them read yet.
    pub(super) fn new(document: &'a Document) -> Self {
        let extensions = document.root.extensions.as_ref();
        let lights = extensions
            .and_then(|root| root.others.get(EXTENSION)?.get("lights")?.as_array())
            .map_or(&[][..], Vec::as_slice);
        Self {
            lights,
            meshes: vec![None; lights.len()],
        }
    }

    /// The light of a node, placed; `None` where it has none, or, after a warning, one that cannot shine.
    pub(super) fn place(
        &mut self,
        index: usize,
        placed: &PlacedNode<'_>,
        meshes: &mut Vec<MeshDesc>,
        materials: &mut Materials<'_>,
        budget: &mut Budget,
        warnings: &mut Warnings,
    ) -> Result<Option<Placement>, Fault> {
        let Some(used) = of_node(placed.node) else {
            return Ok(None);
        };
        let at = format!("{}/extensions/{EXTENSION}", placed.place);
        let light = used.get("light").and_then(Value::as_u64);
        let Some(light) = light.and_then(|light| u32::try_from(light).ok()) else {
            warnings.push(at, "light is no index; the light is left out");
            return Ok(None);
        };
        let light = Index::<Value>::new(light);
        let array = format!("extensions/{EXTENSION}/lights");
        let without = "it is left out";
        let Some(value) = find(self.lights, light, &array, &at, without, warnings) else {
            return Ok(None);
        };
        let known = &mut self.meshes[light.value()];
        let mesh = *known.get_or_insert_with(|| {
            let message = format!("{EXTENSION} is a draft, which may change");
            warnings.push("extensionsUsed", message);
            let name = value.get("name").and_then(Value::as_str);
            let at = place(&array, light.value(), name);
            let name = name.map_or_else(|| format!("area light {}", light.value()), str::to_owned);
            let (outline, radiance) = read(value, &at, warnings)?;
            let material = materials.add(emitter(name.clone(), radiance));
            meshes.push(outline.mesh(name, material));
            Some(meshes.len() - 1)
        });
        let Some(mesh) = mesh else { return Ok(None) };
        // Each light may hang on many nodes, and each node may have another light.
        budget.charge(1, BYTES_PLACED, &placed.place)?;
        Ok(Some(Placement {
            mesh,
            node: index,
            world: world(&placed.world),
        }))
    }
}

/// Where a light is that hangs on a node: scaled by the largest of the node's scales, never mirrored or sheared; a point where the
/// transform leaves it no direction. A node that mirrors z turns it around, as it does lights of KHR_lights_punctual.
fn world(node: &DAffine3) -> DAffine3 {
    /// Shorter than this part of an axis is what rounding leaves of it.
    const NOTHING: f64 = 1e-9;
    let columns = [node.x_axis, node.y_axis, node.z_axis];
    let scale = columns.map(DVec3::length).into_iter().fold(0.0, f64::max);
    let axes = || {
        let [x, y, z] = columns;
        let z = z.try_normalize().or_else(|| x.cross(y).try_normalize())?;
        let across = |axis: DVec3| {
            let rest = axis.reject_from_normalized(z);
            (rest.length() > NOTHING * axis.length()).then(|| rest.normalize())
        };
        // A scale of 0 leaves one axis that tells how a rectangle is turned.
        let x = across(x).or_else(|| Some(across(y)?.cross(z)))?;
        Some(DMat3::from_cols(x, z.cross(x), z))
    };
    DAffine3::from_mat3_translation(
        axes().unwrap_or(DMat3::ZERO) * DMat3::from_diagonal(DVec3::splat(scale)),
        node.translation,
    )
}

/// A light's outline and radiance; `None`, after a warning, where it cannot shine.
fn read(light: &Value, at: &str, warnings: &mut Warnings) -> Option<(Outline, [f32; 3])> {
    let Some(light) = light.as_object() else {
        warnings.push(at, "is no object; the light is left out");
        return None;
    };
    let outline = Outline::read(light, at, warnings)?;
    let radiance = radiance(light, at, warnings);
    if !radiance.iter().all(|channel| channel.is_finite()) || radiance == [0.0; 3] {
        let message = format!("the radiance {radiance:?} lights nothing; the light is left out");
        warnings.push(at, message);
        return None;
    }
    Some((outline, radiance))
}

/// The outline of a light, around the origin of its node's xy-plane.
#[derive(Clone, Copy)]
enum Outline {
    /// Half its extent.
    Rectangle(Vec2),
    Disc {
        radius: f32,
    },
}

impl Outline {
    fn read(light: &Map<String, Value>, at: &str, warnings: &mut Warnings) -> Option<Self> {
        let half = 0.5 * number(light, "size", 1.0, at, warnings);
        let outline = match light.get("type").map(Value::as_str) {
            Some(Some("disk")) => Self::Disc {
                radius: half as f32,
            },
            // What the draft says of files without the member.
            None | Some(Some("rect")) => {
                let aspect = match light.get("rect") {
                    None => 1.0,
                    Some(Value::Object(rect)) => number(rect, "aspect", 1.0, at, warnings),
                    Some(_) => {
                        warnings.push(at, "rect is no object; the light is a square");
                        1.0
                    }
                };
                Self::Rectangle(DVec2::new(half * aspect, half).as_vec2())
            }
            Some(_) => {
                warnings.push(
                    at,
                    "the type is neither rect nor disk; the light is left out",
                );
                return None;
            }
        };
        let extent = match outline {
            Self::Rectangle(half) => [half.min_element(), half.max_element()],
            Self::Disc { radius } => [radius; 2],
        };
        if extent[0] > 0.0 && extent[1].is_finite() {
            return Some(outline);
        }
        let message = "the size leaves no area, or an infinite one; the light is left out";
        warnings.push(at, message);
        None
    }

    /// What shines: counter-clockwise seen from −Z.
    fn mesh(self, name: String, material: usize) -> MeshDesc {
        let (corners, triangles) = match self {
            Self::Rectangle(Vec2 { x, y }) => (
                [[-x, -y], [-x, y], [x, y], [x, -y]]
                    .map(Vec2::from)
                    .to_vec(),
                vec![[0, 1, 2], [0, 2, 3]],
            ),
            Self::Disc { radius } => {
                let step = TAU / f64::from(DISC_CORNERS);
                let reach = (TAU / (f64::from(DISC_CORNERS) * step.sin())).sqrt();
                let rim = (0..DISC_CORNERS).map(|i| {
                    let on_circle = DVec2::from_angle(-step * f64::from(i)) * reach;
                    on_circle.as_vec2() * radius
                });
                // Around the middle, so that all triangles have the same area.
                let corners = std::iter::once(Vec2::ZERO).chain(rim).collect();
                let next = |i: u32| 1 + i % DISC_CORNERS;
                let triangles = (0..DISC_CORNERS).map(|i| [0, next(i), next(i + 1)]);
                (corners, triangles.collect())
            }
        };
        MeshDesc {
            name,
            material,
            normals: vec![Vec3::NEG_Z; corners.len()],
            positions: corners.iter().map(|corner| corner.extend(0.0)).collect(),
            triangles,
            ..MeshDesc::default()
        }
    }
}

/// Colour times luminance, which counts as radiance, one for one.
fn radiance(light: &Map<String, Value>, at: &str, warnings: &mut Warnings) -> [f32; 3] {
    let intensity = number(light, "intensity", 1000.0, at, warnings);
    let color = light.get("color").map_or(Some([1.0; 3]), |value| {
        let numbers: Option<Vec<f64>> = value.as_array()?.iter().map(Value::as_f64).collect();
        let color = <[f64; 3]>::try_from(numbers?).ok()?;
        color.iter().all(|&channel| channel >= 0.0).then_some(color)
    });
    let color = color.unwrap_or_else(|| {
        warnings.push(at, "color is no colour; white is used");
        [1.0; 3]
    });
    color.map(|channel| (channel * intensity) as f32)
}

/// A number of at least 0 that 32 bits hold.
fn number(
    object: &Map<String, Value>,
    member: &str,
    default: f64,
    at: &str,
    warnings: &mut Warnings,
) -> f64 {
    let Some(value) = object.get(member) else {
        return default;
    };
    let number = value.as_f64();
    number
        .filter(|number| (0.0..=f64::from(f32::MAX)).contains(number))
        .unwrap_or_else(|| {
            let message = format!(
                "{member} {value} is not from 0 to {:e}; {default} is used",
                f32::MAX
            );
            warnings.push(at, message);
            default
        })
}

/// Emits, and reflects nothing.
fn emitter(name: String, radiance: [f32; 3]) -> MaterialDesc {
    let black = SurfaceDesc::Phong(PhongSurface {
        diffuse: ColorInput::constant([0.0; 3]),
        specular: ColorInput::constant([0.0; 3]),
        exponent: ScalarInput::constant(0.0),
    });
    MaterialDesc {
        emission: ColorInput::constant(radiance),
        double_sided: false,
        ..MaterialDesc::new(name, black)
    }
}
