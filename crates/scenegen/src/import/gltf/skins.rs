//! Skins: for each joint the transform that carries a vertex from where it was bound to where the joint is.

use std::collections::HashMap;

use glam::{DAffine3, DMat4};
use gltf::json::{Index, Skin};

use super::accessors::Accessors;
use super::document::Document;
use super::lookup::{find, get, place};
use super::nodes::PlacedNode;
use crate::import::error::Fault;
use crate::import::warnings::Warnings;

/// Where the joints of a skin carry vertices.
#[derive(Clone, PartialEq)]
pub(super) struct PosedSkin {
    /// From the space in which the vertices are given, for each joint, to that of the instance.
    pub(super) joints: Vec<DAffine3>,
    /// From the space of the instance to the world.
    pub(super) world: DAffine3,
}

/// World transforms of the scene's nodes, by their index in the file.
pub(super) fn worlds(nodes: &[PlacedNode<'_>]) -> HashMap<usize, DAffine3> {
    let mut worlds = HashMap::with_capacity(nodes.len());
    for placed in nodes {
        worlds.entry(placed.index).or_insert(placed.world);
    }
    worlds
}

/// Poses a skin; `None`, after a warning, where there is none or it has no joints.
pub(super) fn pose(
    document: &Document,
    index: Index<Skin>,
    worlds: &HashMap<usize, DAffine3>,
    user: &str,
    accessors: &mut Accessors<'_>,
    warnings: &mut Warnings,
) -> Result<Option<PosedSkin>, Fault> {
    let without = "the mesh is shown as it is";
    let skins = &document.root.skins;
    let Some(skin) = find(skins, index, "skins", user, without, warnings) else {
        return Ok(None);
    };
    let at = place("skins", index.value(), skin.name.as_deref());
    let inverse_bind = match skin.inverse_bind_matrices {
        Some(matrices) => Some(accessors.floats::<16>(matrices, &at)?),
        None => None,
    };
    if inverse_bind
        .as_ref()
        .is_some_and(|matrices| matrices.len() < skin.joints.len())
    {
        return Err(Fault::new(
            at,
            "has fewer inverse bind matrices than joints",
        ));
    }
    let mut joints = Vec::with_capacity(skin.joints.len());
    let mut absent = 0;
    for (k, &joint) in skin.joints.iter().enumerate() {
        get(&document.root.nodes, joint, "nodes", &at)?;
        let world = worlds.get(&joint.value()).copied().unwrap_or_else(|| {
            absent += 1;
            DAffine3::IDENTITY
        });
        let inverse = match &inverse_bind {
            Some(matrices) => {
                let matrix = DMat4::from_cols_array(&matrices[k].map(f64::from));
                DAffine3::from_mat4(matrix)
            }
            None => DAffine3::IDENTITY,
        };
        joints.push(world * inverse);
    }
    if absent > 0 {
        let message = format!("{absent} joints are not in the scene; they stand at the origin");
        warnings.push(&*at, message);
    }
    let Some(&first) = skin.joints.first() else {
        warnings.push(at, "has no joints; the mesh is shown as it is");
        return Ok(None);
    };
    // Relative to a joint, as the whole may be far away.
    let origin = worlds
        .get(&first.value())
        .map_or(glam::DVec3::ZERO, |world| world.translation);
    if origin.is_finite() {
        for joint in &mut joints {
            joint.translation -= origin;
        }
    }
    Ok(Some(PosedSkin {
        joints,
        world: DAffine3::from_translation(origin),
    }))
}
