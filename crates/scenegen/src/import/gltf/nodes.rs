//! The node hierarchy: from a scene's roots to world transforms, without recursion.

use glam::{DAffine3, DMat4, DQuat, DVec3};
use gltf::json::{Index, Node, Scene};

use super::document::Document;
use super::extensions;
use super::lookup::{get, place};
use crate::import::error::Fault;
use crate::import::warnings::Warnings;

/// A node of the scene with its world transform.
pub(super) struct PlacedNode<'a> {
    /// The node.
    pub(super) node: &'a Node,
    /// Name for the scene.
    pub(super) name: String,
    /// JSON path.
    pub(super) place: String,
    /// Object to world.
    pub(super) world: DAffine3,
}

/// Nodes of the default scene, parents first; of all root nodes where the file names no scene.
pub(super) fn flatten<'a>(
    document: &'a Document,
    warnings: &mut Warnings,
) -> Result<Vec<PlacedNode<'a>>, Fault> {
    let root = &document.root;
    let mut roots = roots(document)?;
    roots.reverse();
    let mut stack: Vec<(Index<Node>, DAffine3)> = roots
        .into_iter()
        .map(|node| (node, DAffine3::IDENTITY))
        .collect();
    let mut visited = vec![false; root.nodes.len()];
    let mut placed = Vec::new();
    while let Some((index, parent)) = stack.pop() {
        let node = get(&root.nodes, index, "nodes", "scene")?;
        let index = index.value();
        let place = place("nodes", index, node.name.as_deref());
        // A second visit could only end in a cycle or, with nodes shared level by level, in 2ⁿ instances.
        if std::mem::replace(&mut visited[index], true) {
            return Err(Fault::new(
                place,
                "is reached twice: nodes must form a tree, without shared children",
            ));
        }
        let mut local = local(node, &place, warnings);
        if let Some(&translation) = document.long_translations.get(&index) {
            local.translation = translation;
        }
        let world = parent * local;
        for &child in node.children.iter().flatten().rev() {
            get(&root.nodes, child, "nodes", &place)?;
            stack.push((child, world));
        }
        if let Some(used) = &node.extensions {
            extensions::warn_about_others(
                &used.others,
                &["EXT_mesh_gpu_instancing"],
                &place,
                warnings,
            );
        }
        let name = node.name.clone().unwrap_or_else(|| format!("node {index}"));
        placed.push(PlacedNode {
            node,
            name,
            place,
            world,
        });
    }
    Ok(placed)
}

fn roots(document: &Document) -> Result<Vec<Index<Node>>, Fault> {
    let root = &document.root;
    let scene: Option<&Scene> = match root.scene {
        Some(index) => Some(get(&root.scenes, index, "scenes", "scene")?),
        None => root.scenes.first(),
    };
    if let Some(scene) = scene {
        return Ok(scene.nodes.clone());
    }
    let mut is_child = vec![false; root.nodes.len()];
    for child in root
        .nodes
        .iter()
        .flat_map(|node| node.children.iter().flatten())
    {
        if let Some(is_child) = is_child.get_mut(child.value()) {
            *is_child = true;
        }
    }
    Ok((0..root.nodes.len())
        .filter(|&index| !is_child[index])
        .map(|index| Index::new(index as u32))
        .collect())
}

fn local(node: &Node, at: &str, warnings: &mut Warnings) -> DAffine3 {
    if let Some(matrix) = node.matrix {
        let matrix = DMat4::from_cols_array(&matrix.map(f64::from));
        if matrix.row(3) != glam::DVec4::W {
            warnings.push(at, "the matrix is not affine; its last row is ignored");
        }
        return DAffine3::from_mat4(matrix);
    }
    let vector = |values: Option<[f32; 3]>, default| {
        values.map_or(default, |values| DVec3::from(values.map(f64::from)))
    };
    let rotation = match &node.rotation {
        Some(rotation) => {
            let quaternion = DQuat::from_array(rotation.0.map(f64::from));
            let length = quaternion.length();
            if length.is_finite() && length > 0.0 {
                quaternion * length.recip()
            } else {
                warnings.push(at, "the rotation has no direction; none is used");
                DQuat::IDENTITY
            }
        }
        None => DQuat::IDENTITY,
    };
    DAffine3::from_scale_rotation_translation(
        vector(node.scale, DVec3::ONE),
        rotation,
        vector(node.translation, DVec3::ZERO),
    )
}
