//! Meshes in a pose: morph targets, then skins (glTF 2.0, sections 3.7.2.2 and 3.7.3).

use glam::{DAffine3, DMat3, DVec3, Vec3};
use gltf::json::mesh::{Primitive, Semantic};
use gltf::json::validation::Checked;

use super::accessors::Accessors;
use super::skins::PosedSkin;
use crate::import::error::Fault;
use crate::import::mesh::RawMesh;
use crate::import::warnings::Warnings;

/// How a node shows its mesh.
#[derive(Clone, Default, PartialEq)]
pub(super) struct Deformation {
    /// Of its morph targets; those that are missing are 0.
    pub(super) weights: Vec<f32>,
    /// Its skin.
    pub(super) skin: Option<PosedSkin>,
}

impl Deformation {
    /// Whether it leaves meshes as they are.
    pub(super) fn is_none(&self) -> bool {
        self.skin.is_none() && self.weights.iter().all(|&weight| weight == 0.0)
    }

    /// Deforms a mesh.
    pub(super) fn apply(
        &self,
        raw: &mut RawMesh,
        primitive: &Primitive,
        accessors: &mut Accessors<'_>,
        at: &str,
        warnings: &mut Warnings,
    ) -> Result<(), Fault> {
        self.morph(raw, primitive, accessors, at, warnings)?;
        match &self.skin {
            Some(skin) => bend(skin, raw, primitive, accessors, at, warnings),
            None => Ok(()),
        }
    }

    fn morph(
        &self,
        raw: &mut RawMesh,
        primitive: &Primitive,
        accessors: &mut Accessors<'_>,
        at: &str,
        warnings: &mut Warnings,
    ) -> Result<(), Fault> {
        let targets = primitive.targets.iter().flatten().enumerate();
        for ((k, target), &weight) in targets.zip(&self.weights) {
            if weight == 0.0 {
                continue;
            }
            let at = format!("{at}/targets/{k}");
            if !weight.is_finite() {
                warnings.push(
                    at,
                    format!("the weight {weight} is not a number; 0 is used"),
                );
                continue;
            }
            let mut deltas = |index: Option<_>| match index {
                Some(index) => accessors.floats::<3>(index, &at),
                None => Ok(Vec::new()),
            };
            let (positions, normals, tangents) = (
                deltas(target.positions)?,
                deltas(target.normals)?,
                deltas(target.tangents)?,
            );
            let count = raw.positions.len();
            if [&positions, &normals, &tangents]
                .iter()
                .any(|deltas| !deltas.is_empty() && deltas.len() != count)
            {
                let problem = format!("has another number of elements than the {count} vertices");
                return Err(Fault::new(at, problem));
            }
            let moved = |delta: [f32; 3]| Vec3::from(delta) * weight;
            for (position, delta) in raw.positions.iter_mut().zip(positions) {
                *position += moved(delta);
            }
            for (normal, delta) in raw.normals.iter_mut().flatten().zip(normals) {
                *normal += moved(delta);
            }
            for (tangent, delta) in raw.tangents.iter_mut().flatten().zip(tangents) {
                *tangent += moved(delta).extend(0.0);
            }
        }
        Ok(())
    }
}

/// A joint and its weight, for each of those that a vertex follows.
type Influences = Vec<[(f32, f32); 4]>;

/// Moves vertices with the joints that they follow.
fn bend(
    skin: &PosedSkin,
    raw: &mut RawMesh,
    primitive: &Primitive,
    accessors: &mut Accessors<'_>,
    at: &str,
    warnings: &mut Warnings,
) -> Result<(), Fault> {
    let mut sets: Vec<Influences> = Vec::new();
    for set in 0.. {
        let attribute = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
        let (Some(joints), Some(weights)) = (
            attribute(Semantic::Joints(set)),
            attribute(Semantic::Weights(set)),
        ) else {
            break;
        };
        let joints = accessors.floats::<4>(joints, &format!("{at}/attributes/JOINTS_{set}"))?;
        let weights =
            accessors.fractions::<4>(weights, &format!("{at}/attributes/WEIGHTS_{set}"))?;
        if joints.len() != raw.positions.len() || weights.len() != raw.positions.len() {
            let problem = "joints and weights have other numbers of elements than POSITION";
            return Err(Fault::new(format!("{at}/attributes"), problem));
        }
        let both = joints.into_iter().zip(weights);
        let both = both.map(|(joints, weights)| [0, 1, 2, 3].map(|k| (joints[k], weights[k])));
        sets.push(both.collect());
    }
    if sets.is_empty() {
        warnings.push(
            at,
            "has a skin and no joints for its vertices, which follow the first joint",
        );
    }
    // Mirrored bodies keep their outsides.
    if skin.joints[0].matrix3.determinant() < 0.0 {
        raw.triangles
            .iter_mut()
            .for_each(|corners| corners.swap(1, 2));
    }
    let (mut out_of_range, mut weightless) = (0, 0);
    for vertex in 0..raw.positions.len() {
        let mut sum = 0.0;
        let (mut linear, mut moved) = (DMat3::ZERO, DVec3::ZERO);
        for &(joint, weight) in sets.iter().flat_map(|set| &set[vertex]) {
            if !(weight > 0.0 && weight.is_finite()) {
                continue;
            }
            let Some(carried) = skin.joints.get(joint as usize) else {
                out_of_range += 1;
                continue;
            };
            let weight = f64::from(weight);
            sum += weight;
            linear += carried.matrix3 * weight;
            moved += carried.translation * weight;
        }
        let carried = if sum > 0.0 {
            DAffine3 {
                matrix3: linear * sum.recip(),
                translation: moved / sum,
            }
        } else {
            weightless += 1;
            skin.joints[0]
        };
        carry(raw, vertex, &carried);
    }
    for (count, problem) in [
        (
            out_of_range,
            "weights are of joints that the skin does not have; ignored",
        ),
        (
            weightless,
            "vertices follow no joint; they follow the first",
        ),
    ] {
        if count > 0 && !sets.is_empty() {
            warnings.push(at, format!("{count} {problem}"));
        }
    }
    Ok(())
}

fn carry(raw: &mut RawMesh, vertex: usize, carried: &DAffine3) {
    let matrix = carried.matrix3;
    let position = raw.positions[vertex].as_dvec3();
    raw.positions[vertex] = carried.transform_point3(position).as_vec3();
    if let Some(normals) = &mut raw.normals {
        // Normals go by the cofactor matrix.
        let cofactors = DMat3::from_cols(
            matrix.y_axis.cross(matrix.z_axis),
            matrix.z_axis.cross(matrix.x_axis),
            matrix.x_axis.cross(matrix.y_axis),
        );
        let normal = cofactors * normals[vertex].as_dvec3();
        let side = if matrix.determinant() < 0.0 {
            -1.0
        } else {
            1.0
        };
        normals[vertex] = (normal.normalize_or_zero() * side).as_vec3();
    }
    if let Some(tangents) = &mut raw.tangents {
        let tangent = matrix * tangents[vertex].truncate().as_dvec3();
        let sign = tangents[vertex].w;
        tangents[vertex] = tangent.normalize_or_zero().as_vec3().extend(sign);
    }
}
