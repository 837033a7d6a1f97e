//! EXT_lights_area (a draft: KhronosGroup/glTF, pull request 2525): rectangles and discs that shine along −Z of their nodes, with
//! the same radiance in all directions. They become meshes that emit from their front, reflect nothing, and are not there from
//! behind, so that cameras and mirrors see them as they see other emitters.

use std::f64::consts::{PI, TAU};

use glam::{DAffine3, DMat3, DVec2, DVec3, Vec3};
use gltf::json::{Index, Node, Value};
use serde_json::Map;

use super::document::Document;
use super::lookup::{find, place};
use super::materials::Materials;
use super::nodes::PlacedNode;
use crate::desc::{
    AlphaMode, ColorInput, MaterialDesc, MeshDesc, PhongSurface, ScalarInput, SurfaceDesc,
};
use crate::import::warnings::Warnings;

/// The extension's name.
const EXTENSION: &str = "EXT_lights_area";

/// Corners of the polygon that stands for a disc, with the disc's area: its rim is a thousandth of the radius off.
const DISC_CORNERS: u32 = 64;

/// The area lights of a file, read as nodes ask for them.
pub(super) struct AreaLights<'a> {
    lights: &'a [Value],
    /// The index in the scene of each light's mesh, once asked for; `None` where it cannot shine.
    meshes: Vec<Option<Option<usize>>>,
    has_warned: bool,
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
            has_warned: false,
        }
    }

    /// The mesh of a node's light; `None` where it has none, or, after a warning, one that cannot shine.
    pub(super) fn mesh_of(
        &mut self,
        placed: &PlacedNode<'_>,
        meshes: &mut Vec<MeshDesc>,
        materials: &mut Materials<'_>,
        warnings: &mut Warnings,
    ) -> Option<usize> {
        let used = of_node(placed.node)?;
        if !self.has_warned {
            let message = format!("{EXTENSION} is a draft, which may change");
            warnings.push("extensionsUsed", message);
            self.has_warned = true;
        }
        let at = format!("{}/extensions/{EXTENSION}", placed.place);
        let index = used.get("light").and_then(Value::as_u64);
        let Some(index) = index.and_then(|index| u32::try_from(index).ok()) else {
            warnings.push(at, "light is no index; the light is left out");
            return None;
        };
        let array = format!("extensions/{EXTENSION}/lights");
        let index = Index::<Value>::new(index);
        let light = find(self.lights, index, &array, &at, "it is left out", warnings)?;
        let known = &mut self.meshes[index.value()];
        *known.get_or_insert_with(|| {
            let name = light.get("name").and_then(Value::as_str);
            let at = place(&array, index.value(), name);
            let name = name.map_or_else(|| format!("area light {}", index.value()), str::to_owned);
            let light = light.as_object()?;
            let outline = Outline::read(light, &at, warnings)?;
            let radiance = radiance(light, &at, warnings);
            let material = materials.add(emitter(name.clone(), radiance));
            meshes.push(outline.mesh(name, material));
            Some(meshes.len() - 1)
        })
    }
}

/// Where a light is that hangs on a node: scaled by the largest of the node's scales, never mirrored or sheared; a point where the
/// transform leaves it no direction.
pub(super) fn world(node: &DAffine3) -> DAffine3 {
    let columns = [node.x_axis, node.y_axis, node.z_axis];
    let scale = columns.map(DVec3::length).into_iter().fold(0.0, f64::max);
    let axes = node.z_axis.try_normalize().and_then(|z| {
        let x = node.x_axis.reject_from_normalized(z).try_normalize()?;
        Some(DMat3::from_cols(x, z.cross(x), z))
    });
    DAffine3::from_mat3_translation(
        axes.unwrap_or(DMat3::ZERO) * DMat3::from_diagonal(DVec3::splat(scale)),
        node.translation,
    )
}

/// The outline of a light, around the origin of its node's xy-plane.
#[derive(Clone, Copy)]
enum Outline {
    /// Half its extent.
    Rectangle(DVec2),
    Disc {
        radius: f64,
    },
}

impl Outline {
    fn read(light: &Map<String, Value>, at: &str, warnings: &mut Warnings) -> Option<Self> {
        let half = 0.5 * number(light, "size", 1.0, at, warnings);
        let outline = match light.get("type").and_then(Value::as_str) {
            Some("disk") => Self::Disc { radius: half },
            Some("rect") => {
                let rect = light.get("rect").and_then(Value::as_object);
                let aspect = rect.map(|rect| number(rect, "aspect", 1.0, at, warnings));
                Self::Rectangle(DVec2::new(half * aspect.unwrap_or(1.0), half))
            }
            _ => {
                warnings.push(
                    at,
                    "the type is neither rect nor disk; the light is left out",
                );
                return None;
            }
        };
        let extent = match outline {
            Self::Rectangle(half) => half.min_element(),
            Self::Disc { radius } => radius,
        };
        if extent == 0.0 {
            warnings.push(at, "the light has no area; it is left out");
            return None;
        }
        Some(outline)
    }

    /// What shines: counter-clockwise seen from −Z.
    fn mesh(self, name: String, material: usize) -> MeshDesc {
        let (corners, triangles) = match self {
            Self::Rectangle(DVec2 { x, y }) => (
                [[-x, -y], [-x, y], [x, y], [x, -y]]
                    .map(DVec2::from)
                    .to_vec(),
                vec![[0, 1, 2], [0, 2, 3]],
            ),
            Self::Disc { radius } => {
                let step = TAU / f64::from(DISC_CORNERS);
                let reach = radius * (2.0 * PI / (f64::from(DISC_CORNERS) * step.sin())).sqrt();
                let rim =
                    (0..DISC_CORNERS).map(|i| reach * DVec2::from_angle(-step * f64::from(i)));
                let corners = std::iter::once(DVec2::ZERO).chain(rim).collect();
                // Around the middle, so that all have the same area.
                let next = |i: u32| 1 + i % DISC_CORNERS;
                (
                    corners,
                    (0..DISC_CORNERS)
                        .map(|i| [0, next(i), next(i + 1)])
                        .collect(),
                )
            }
        };
        MeshDesc {
            name,
            material,
            normals: vec![Vec3::NEG_Z; corners.len()],
            positions: corners
                .iter()
                .map(|corner| corner.as_vec2().extend(0.0))
                .collect(),
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
    let radiance = color.map(|channel| (channel * intensity) as f32);
    if radiance.iter().all(|channel| channel.is_finite()) {
        return radiance;
    }
    warnings.push(at, "the intensity is not finite; the light is dark");
    [0.0; 3]
}

/// A number of at least 0, of which 32 bits hold the half.
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
            let message = format!("{member} {value} is no number from 0 on; {default} is used");
            warnings.push(at, message);
            default
        })
}

/// Emits, and reflects nothing.
fn emitter(name: String, radiance: [f32; 3]) -> MaterialDesc {
    MaterialDesc {
        name,
        surface: SurfaceDesc::Phong(PhongSurface {
            diffuse: ColorInput::constant([0.0; 3]),
            specular: ColorInput::constant([0.0; 3]),
            exponent: ScalarInput::constant(0.0),
        }),
        emission: ColorInput::constant(radiance),
        alpha_mode: AlphaMode::Opaque,
        alpha: ScalarInput::constant(1.0),
        normal_map: None,
        double_sided: false,
    }
}
