//! The node hierarchy: from a scene's roots to world transforms, without recursion.

use std::collections::HashSet;

use glam::{DAffine3, DMat4, DQuat, DVec3};
use gltf::json::{Index, Node, Scene, Value};

use super::animation::{Animated, Pose};
use super::document::Document;
use super::extensions;
use super::lookup::{find, get, place};
use crate::import::error::{Fault, MAKE_SMALLER};
use crate::import::warnings::Warnings;

/// More nodes than this are not placed: children shared level by level multiply.
const MAX_PLACED: usize = 1 << 20;

/// Nodes that are not to be seen, with all below them.
const VISIBILITY: &str = "KHR_node_visibility";

/// A node of the scene with its world transform.
pub(super) struct PlacedNode<'a> {
    /// The node.
    pub(super) node: &'a Node,
    /// Its index in the file.
    pub(super) index: usize,
    /// Name for the scene.
    pub(super) name: String,
    /// JSON path.
    pub(super) place: String,
    /// Object to world.
    pub(super) world: DAffine3,
    /// Whether its mesh and its light are shown.
    pub(super) is_visible: bool,
}

/// What the walk does next.
enum Turn {
    /// Places a node below a parent.
    Enter {
        node: Index<Node>,
        parent: DAffine3,
        is_visible: bool,
    },
    /// Leaves a node, all below which are placed.
    Leave(usize),
}

/// Nodes of the default scene, parents first; of all root nodes where the file names no scene. Nodes with several parents,
/// which the specification forbids and exporters write, are placed below each.
pub(super) fn flatten<'a>(
    document: &'a Document,
    pose: &Pose,
    warnings: &mut Warnings,
) -> Result<Vec<PlacedNode<'a>>, Fault> {
    let root = &document.root;
    let enter = |node, parent, is_visible| Turn::Enter {
        node,
        parent,
        is_visible,
    };
    let roots = roots(document, warnings)?.into_iter().rev();
    let mut stack: Vec<Turn> = roots
        .map(|node| enter(node, DAffine3::IDENTITY, true))
        .collect();
    let mut is_above = vec![false; root.nodes.len()];
    let mut is_placed = vec![false; root.nodes.len()];
    let mut placed = Vec::new();
    while let Some(turn) = stack.pop() {
        let (index, parent, is_visible) = match turn {
            Turn::Enter {
                node,
                parent,
                is_visible,
            } => (node, parent, is_visible),
            Turn::Leave(index) => {
                is_above[index] = false;
                continue;
            }
        };
        let node = get(&root.nodes, index, "nodes", "scene")?;
        let index = index.value();
        let place = place("nodes", index, node.name.as_deref());
        if std::mem::replace(&mut is_above[index], true) {
            return Err(Fault::new(place, "is a child of its own children"));
        }
        stack.push(Turn::Leave(index));
        if placed.len() == MAX_PLACED {
            let problem =
                format!("more than {MAX_PLACED} nodes, those with several parents below each");
            return Err(Fault::new("nodes", problem).advise(MAKE_SMALLER));
        }
        let is_first = !std::mem::replace(&mut is_placed[index], true);
        if !is_first {
            warnings.push(&*place, "is reached from several parents; shown below each");
        }
        let mut local = local(node, pose.get(&index), &place, warnings);
        let is_moved = pose
            .get(&index)
            .is_some_and(|moved| moved.translation.is_some());
        if let Some(&translation) = document.long_translations.get(&index)
            && !is_moved
        {
            local.translation = translation;
        }
        let world = parent * local;
        let is_visible = is_visible && !is_hidden(node);
        let mut seen = HashSet::new();
        let children = node.children.iter().flatten().filter(|child| {
            let is_new = seen.insert(child.value());
            if !is_new {
                let message = format!("lists its child nodes/{} twice; shown once", child.value());
                warnings.push(&*place, message);
            }
            is_new
        });
        let first_child = stack.len();
        for &child in children {
            get(&root.nodes, child, "nodes", &place)?;
            stack.push(enter(child, world, is_visible));
        }
        // The last on the stack is placed first.
        stack[first_child..].reverse();
        if is_first && let Some(used) = &node.extensions {
            extensions::warn_about_others(
                &used.others,
                &["EXT_mesh_gpu_instancing", "EXT_lights_area", VISIBILITY],
                &place,
                warnings,
            );
        }
        let name = node.name.clone().unwrap_or_else(|| format!("node {index}"));
        placed.push(PlacedNode {
            node,
            index,
            name,
            place,
            world,
            is_visible,
        });
    }
    Ok(placed)
}

fn is_hidden(node: &Node) -> bool {
    let extensions = node.extensions.as_ref();
    let visibility = extensions.and_then(|used| used.others.get(VISIBILITY));
    visibility.and_then(|used| used.get("visible")) == Some(&Value::Bool(false))
}

fn roots(document: &Document, warnings: &mut Warnings) -> Result<Vec<Index<Node>>, Fault> {
    let root = &document.root;
    let scene: Option<&Scene> = match root.scene {
        Some(index) => {
            let instead = match root.scenes.is_empty() {
                true => "all nodes are shown",
                false => "the first is shown",
            };
            find(&root.scenes, index, "scenes", "scene", instead, warnings)
        }
        None => None,
    };
    let scene = scene.or(root.scenes.first());
    if root.scene.is_none() && root.scenes.len() > 1 {
        let message = format!(
            "the file does not say which of its {} scenes is the default; the first is shown",
            root.scenes.len()
        );
        warnings.push("scene", message);
    }
    if let Some(scene) = scene {
        let mut nodes = scene.nodes.clone();
        let mut seen = HashSet::new();
        nodes.retain(|node| seen.insert(node.value()));
        return Ok(nodes);
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

fn local(node: &Node, animated: Option<&Animated>, at: &str, warnings: &mut Warnings) -> DAffine3 {
    let rest = Animated::default();
    let animated = animated.unwrap_or(&rest);
    let is_moved =
        animated.translation.is_some() || animated.rotation.is_some() || animated.scale.is_some();
    if is_moved && node.matrix.is_some() {
        warnings.push(at, "is animated and has a matrix, which is ignored");
    } else if let Some(matrix) = node.matrix {
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
        animated.scale.unwrap_or(vector(node.scale, DVec3::ONE)),
        animated.rotation.unwrap_or(rotation),
        animated
            .translation
            .unwrap_or(vector(node.translation, DVec3::ZERO)),
    )
}
