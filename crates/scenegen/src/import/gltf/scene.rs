//! A glTF file as a scene description: the pieces of this folder put together.

use std::path::Path;

use gltf::json::{Index, Mesh, Node};

use super::accessors::Accessors;
use super::document::Document;
use super::materials::Materials;
use super::meshes::Meshes;
use super::nodes::PlacedNode;
use super::placements::Placement;
use super::{cameras, instancing, lights, nodes, placements, variants};
use crate::desc::{InstanceDesc, SceneDesc};
use crate::import::error::{Fault, ImportError};
use crate::import::options::ImportOptions;
use crate::import::warnings::Warnings;

/// Reads a `.gltf` or `.glb` file.
pub(in crate::import) fn import(
    file: &Path,
    options: &ImportOptions,
    warnings: &mut Warnings,
) -> Result<SceneDesc, ImportError> {
    let document = Document::open(file, warnings)?;
    read(&document, options, warnings).map_err(|fault| fault.in_file(file))
}

fn read(
    document: &Document,
    options: &ImportOptions,
    warnings: &mut Warnings,
) -> Result<SceneDesc, Fault> {
    let variant = variants::chosen(&document.root, options.variant.as_deref(), warnings)?;
    let mut reader = Reader {
        accessors: Accessors::new(document),
        materials: Materials::new(document),
        meshes: Meshes::new(document, variant),
    };
    let mut scene = SceneDesc::default();
    let nodes = nodes::flatten(document, warnings)?;
    let mut placements = Vec::new();
    for (index, placed) in nodes.iter().enumerate() {
        if !placed.is_visible && shows_something(placed.node) {
            warnings.dismiss(None, &*placed.place, "KHR_node_visibility hides it");
        }
        if placed.is_visible
            && let Some(mesh) = placed.node.mesh
        {
            reader.place(mesh, index, placed, &mut placements, warnings)?;
        }
    }
    let meshes = &reader.meshes.list;
    scene.origin = placements::origin(&placements, meshes);
    let named = |node: usize| [&*nodes[node].name, &*nodes[node].place];
    scene.instances = placements::instances(&placements, meshes, scene.origin, named, warnings);
    for placed in &nodes {
        let extensions = placed.node.extensions.as_ref();
        let light = extensions.and_then(|extensions| extensions.khr_lights_punctual.as_ref());
        if placed.is_visible
            && let Some(light) = light
        {
            let light = lights::read(document, light.light, placed, scene.origin, warnings)?;
            scene.lights.extend(light);
        }
        if let Some(camera) = placed.node.camera {
            let camera = cameras::read(document, camera, placed, scene.origin, warnings)?;
            scene.cameras.extend(camera);
        }
    }
    reader.meshes.dismiss_unused(warnings);
    reader.materials.dismiss_unused(warnings);
    scene.meshes = reader.meshes.list;
    (scene.materials, scene.textures, scene.images) = reader.materials.finish(warnings);
    Ok(scene)
}

/// Whether a node has a mesh or a light.
fn shows_something(node: &Node) -> bool {
    let extensions = node.extensions.as_ref();
    node.mesh.is_some() || extensions.is_some_and(|used| used.khr_lights_punctual.is_some())
}

/// What nodes with meshes fill.
struct Reader<'a> {
    accessors: Accessors<'a>,
    materials: Materials<'a>,
    meshes: Meshes<'a>,
}

impl Reader<'_> {
    /// Places a node's mesh, each of its primitives and copies.
    fn place(
        &mut self,
        mesh: Index<Mesh>,
        node: usize,
        placed: &PlacedNode<'_>,
        placements: &mut Vec<Placement>,
        warnings: &mut Warnings,
    ) -> Result<(), Fault> {
        if placed.node.skin.is_some() {
            warnings.push(
                &*placed.place,
                "skins are not supported; shown in its rest pose at the node's place",
            );
        }
        let meshes = self.meshes.indices_of(
            mesh,
            &placed.place,
            &mut self.accessors,
            &mut self.materials,
            warnings,
        )?;
        let copies = instancing::copies(placed, &mut self.accessors)?;
        // A mesh of many primitives in many nodes is a product that no file size bounds.
        let count = meshes.len() as u64 * copies.len() as u64;
        let size = (size_of::<InstanceDesc>() + placed.name.len() + size_of::<Placement>()) as u64;
        self.accessors.budget.charge(count, size, &placed.place)?;
        for copy in copies {
            let world = placed.world * copy;
            placements.extend(meshes.iter().map(|&mesh| Placement { mesh, node, world }));
        }
        Ok(())
    }
}
