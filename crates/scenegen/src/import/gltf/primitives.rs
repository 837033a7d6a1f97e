//! glTF mesh primitives: attributes and topology.

use glam::{Vec2, Vec3, Vec4};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index};

use super::accessors::Accessors;
use super::{draco, extensions, variants};
use crate::import::error::Fault;
use crate::import::mesh::RawMesh;
use crate::import::warnings::Warnings;

/// How the corners of triangles follow one another.
#[derive(Clone, Copy)]
pub(super) enum Topology {
    /// Three for each.
    List,
    /// Each with the two before.
    Strip,
    /// Each with the one before and the first.
    Fan,
}

/// How a primitive's triangles are given; `None`, after a warning, where it has nothing to render.
pub(super) fn topology(
    primitive: &Primitive,
    at: &str,
    warnings: &mut Warnings,
) -> Result<Option<Topology>, Fault> {
    let topology = match primitive.mode {
        // Whatever the mode was, triangles are decoded.
        Checked::Valid(Mode::TriangleStrip) if draco::of_primitive(primitive).is_some() => {
            Topology::List
        }
        Checked::Valid(Mode::Triangles) => Topology::List,
        Checked::Valid(Mode::TriangleStrip) => Topology::Strip,
        Checked::Valid(Mode::TriangleFan) => Topology::Fan,
        Checked::Valid(Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip) => {
            warnings.push(at, "points and lines are not rendered");
            return Ok(None);
        }
        Checked::Invalid => return Err(Fault::new(format!("{at}/mode"), "is unknown")),
    };
    let has_positions = primitive
        .attributes
        .contains_key(&Checked::Valid(Semantic::Positions));
    if !has_positions {
        warnings.push(at, "has no POSITION and is skipped");
    }
    Ok(has_positions.then_some(topology))
}

/// Reads a primitive with these sets of texture coordinates.
pub(super) fn read(
    primitive: &Primitive,
    topology: Topology,
    uv_sets: [u32; 2],
    accessors: &mut Accessors<'_>,
    at: &str,
    warnings: &mut Warnings,
) -> Result<RawMesh, Fault> {
    if let Some(used) = &primitive.extensions {
        extensions::warn_about_others(
            &used.others,
            &[variants::EXTENSION, draco::EXTENSION],
            at,
            warnings,
        );
    }
    let attribute = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
    let positions = attribute(Semantic::Positions)
        .ok_or_else(|| Fault::new(format!("{at}/attributes"), "has no POSITION"))?;

    let mut reader = Attributes {
        accessors,
        at,
        count: None,
    };
    let positions: Vec<Vec3> = reader.vectors(positions, "POSITION", Vec3::from_array)?;
    let normals = attribute(Semantic::Normals).and_then(|index| {
        let normals = reader.vectors(index, "NORMAL", Vec3::from_array);
        unless_broken(normals, warnings)
    });
    let tangents = attribute(Semantic::Tangents).and_then(|index| {
        let tangents = reader.vectors(index, "TANGENT", Vec4::from_array);
        unless_broken(tangents, warnings)
    });
    let uvs = uv_sets.map(|set| {
        let index = attribute(Semantic::TexCoords(set))?;
        let uvs = reader.vectors(index, &format!("TEXCOORD_{set}"), Vec2::from_array);
        unless_broken(uvs, warnings)
    });
    let colors = attribute(Semantic::Colors(0)).and_then(|index| {
        let colors = reader.colors(index, warnings);
        unless_broken(colors, warnings)
    });

    let corners = match primitive.indices {
        Some(indices) => accessors.indices(indices, &format!("{at}/indices"))?,
        None => {
            accessors.budget.charge(positions.len() as u64, 4, at)?;
            (0..positions.len() as u32).collect()
        }
    };
    accessors.budget.charge(corners.len() as u64, 12, at)?;
    let mut triangles = assemble(topology, &corners, at, warnings);
    let all = triangles.len();
    let is_there = |&vertex: &u32| (vertex as usize) < positions.len();
    triangles.retain(|triangle| triangle.iter().all(is_there));
    if triangles.len() < all {
        let message = format!(
            "{} of {all} triangles have a vertex beyond the {} there are; they are left out",
            all - triangles.len(),
            positions.len()
        );
        warnings.push(format!("{at}/indices"), message);
    }
    Ok(RawMesh {
        positions,
        normals,
        tangents,
        uvs,
        uv_sets,
        colors,
        triangles,
    })
}

/// An attribute that the mesh can do without; `None`, after a warning, where it cannot be read.
fn unless_broken<T>(values: Result<Vec<T>, Fault>, warnings: &mut Warnings) -> Option<Vec<T>> {
    let warn = |fault: &Fault| {
        warnings.push(
            &*fault.place,
            format!("{}; the attribute is left out", fault.problem),
        );
    };
    values.inspect_err(warn).ok()
}

struct Attributes<'r, 'a> {
    accessors: &'r mut Accessors<'a>,
    at: &'r str,
    /// Number of vertices, known after the first attribute.
    count: Option<usize>,
}

impl Attributes<'_, '_> {
    fn vectors<const N: usize, V>(
        &mut self,
        index: Index<Accessor>,
        name: &str,
        vector: impl Fn([f32; N]) -> V,
    ) -> Result<Vec<V>, Fault> {
        let user = format!("{}/attributes/{name}", self.at);
        let values = self.accessors.floats::<N>(index, &user)?;
        self.of_vertices(values, user, vector)
    }

    /// Values, after a check that there is one for each vertex.
    fn of_vertices<const N: usize, V>(
        &mut self,
        values: Vec<[f32; N]>,
        user: String,
        vector: impl Fn([f32; N]) -> V,
    ) -> Result<Vec<V>, Fault> {
        let expected = *self.count.get_or_insert(values.len());
        if values.len() != expected {
            let problem = format!("has {} elements, but POSITION has {expected}", values.len());
            return Err(Fault::new(user, problem));
        }
        Ok(values.into_iter().map(vector).collect())
    }

    /// Colours, whose integers are fractions of the largest even where the accessor does not say so.
    fn colors(
        &mut self,
        index: Index<Accessor>,
        warnings: &mut Warnings,
    ) -> Result<Vec<Vec4>, Fault> {
        let user = format!("{}/attributes/COLOR_0", self.at);
        if self.accessors.has_plain_integers(index, &user)? {
            let message =
                "the vertex colours are integers that are not normalized; read as if they were";
            warnings.push(&*user, message);
        }
        if self.accessors.components(index, &user)? == 3 {
            let values = self.accessors.fractions::<3>(index, &user)?;
            let opaque = |rgb| Vec3::from_array(rgb).extend(1.0);
            self.of_vertices(values, user, opaque)
        } else {
            let values = self.accessors.fractions::<4>(index, &user)?;
            self.of_vertices(values, user, Vec4::from_array)
        }
    }
}

/// Triangles of a list, strip or fan, by the equations of glTF 2.0 section 3.7.2.1.
fn assemble(
    topology: Topology,
    corners: &[u32],
    at: &str,
    warnings: &mut Warnings,
) -> Vec<[u32; 3]> {
    match topology {
        Topology::List => {
            let (triangles, rest) = corners.as_chunks::<3>();
            if !rest.is_empty() {
                warnings.push(
                    at,
                    format!("the last {} indices make no triangle", rest.len()),
                );
            }
            triangles.to_vec()
        }
        Topology::Strip => corners
            .windows(3)
            .enumerate()
            .map(|(i, window)| [window[0], window[1 + i % 2], window[2 - i % 2]])
            .collect(),
        Topology::Fan => {
            let rim = corners.get(1..).unwrap_or_default();
            rim.windows(2)
                .map(|edge| [edge[0], edge[1], corners[0]])
                .collect()
        }
    }
}
