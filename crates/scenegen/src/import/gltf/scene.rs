//! A glTF file as a scene description: the pieces of this folder put together.

use std::collections::HashMap;
use std::path::Path;

use glam::{DAffine3, DVec3};

use gltf::json::{Index, Mesh, Node};

use super::accessors::Accessors;
use super::animation::Pose;
use super::area_lights::{self, AreaLights};
use super::deform::Deformation;
use super::document::Document;
use super::materials::Materials;
use super::meshes::Meshes;
use super::nodes::PlacedNode;
use super::placements::Placement;
use super::poses::PoseDraft;
use super::{animation, cameras, instancing, lights, nodes, placements, poses, skins, variants};
use crate::desc::{InstanceDesc, NOTHING_MOVES, SceneDesc};
use crate::effect::Effect;
use crate::import::budget::Budget;
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
        document,
        accessors: Accessors::new(document),
        materials: Materials::new(document),
        meshes: Meshes::new(document, variant),
        area_lights: AreaLights::new(document),
        deformed: HashMap::new(),
    };
    let times: Vec<Option<f64>> = match options.moments.is_empty() {
        true => vec![options.time_code],
        false => options.moments.iter().copied().map(Some).collect(),
    };
    let mut scene = SceneDesc::default();
    let mut drafts: Vec<PoseDraft> = Vec::with_capacity(times.len());
    for time in &times {
        // What is deformed is kept for each moment, as often as the user asks for.
        reader.accessors.budget = Budget::geometry();
        let animation = options.animation.as_deref();
        let pose = animation::pose_at(
            &document.root,
            animation,
            *time,
            &mut reader.accessors,
            warnings,
        )?;
        let nodes = nodes::flatten(document, &pose, warnings)?;
        let placements = reader.place_all(&nodes, &pose, warnings)?;
        if drafts.is_empty() {
            scene.origin = placements::origin(&placements, &reader.meshes.list);
        }
        drafts.push(reader.draft(&nodes, &placements, scene.origin, warnings)?);
    }
    reader.meshes.dismiss_unused(warnings);
    reader.materials.dismiss_unused(warnings);
    scene.meshes = reader.meshes.list;
    poses::write(drafts, &mut scene)?;
    if times.len() > 1 && scene.later.is_empty() {
        warnings.dismiss(Some(Effect::MotionBlur), "animations", NOTHING_MOVES);
    }
    (scene.materials, scene.textures, scene.images) = reader.materials.finish(warnings);
    Ok(scene)
}

/// Whether a node has a mesh or a light.
fn shows_something(node: &Node) -> bool {
    let extensions = node.extensions.as_ref();
    let has_punctual = extensions.is_some_and(|used| used.khr_lights_punctual.is_some());
    node.mesh.is_some() || has_punctual || area_lights::is_at(node)
}

/// What nodes fill that have meshes or area lights.
struct Reader<'a> {
    document: &'a Document,
    accessors: Accessors<'a>,
    materials: Materials<'a>,
    meshes: Meshes<'a>,
    area_lights: AreaLights<'a>,
    /// What nodes, by their place among those of the scene, showed of deformed meshes at the last moment, and how.
    deformed: HashMap<usize, (Deformation, Vec<usize>)>,
}

impl Reader<'_> {
    /// Places the meshes and area lights of all nodes.
    fn place_all(
        &mut self,
        nodes: &[PlacedNode<'_>],
        pose: &Pose,
        warnings: &mut Warnings,
    ) -> Result<Vec<Placement>, Fault> {
        let worlds = skins::worlds(nodes);
        let mut placements = Vec::new();
        for (index, placed) in nodes.iter().enumerate() {
            if !placed.is_visible && shows_something(placed.node) {
                warnings.dismiss(None, &*placed.place, "KHR_node_visibility hides it");
            }
            if !placed.is_visible {
                continue;
            }
            if let Some(mesh) = placed.node.mesh {
                let deformation = self.deformation(mesh, placed, pose, &worlds, warnings)?;
                self.place(mesh, index, placed, &deformation, &mut placements, warnings)?;
            }
            let light = self.area_lights.place(
                index,
                placed,
                &mut self.meshes.list,
                &mut self.materials,
                &mut self.accessors.budget,
                warnings,
            )?;
            placements.extend(light);
        }
        Ok(placements)
    }

    /// What is where, relative to an origin.
    fn draft(
        &self,
        nodes: &[PlacedNode<'_>],
        placements: &[Placement],
        origin: DVec3,
        warnings: &mut Warnings,
    ) -> Result<PoseDraft, Fault> {
        let named = |node: usize| [&*nodes[node].name, &*nodes[node].place];
        let meshes = &self.meshes.list;
        let mut draft = PoseDraft {
            instances: placements::instances(placements, meshes, origin, named, warnings),
            ..PoseDraft::default()
        };
        for placed in nodes {
            let extensions = placed.node.extensions.as_ref();
            let light = extensions.and_then(|extensions| extensions.khr_lights_punctual.as_ref());
            if placed.is_visible
                && let Some(light) = light
            {
                let light = lights::read(self.document, light.light, placed, origin, warnings)?;
                draft.lights.push(light);
            }
            if let Some(camera) = placed.node.camera {
                let camera = cameras::read(self.document, camera, placed, origin, warnings)?;
                draft.cameras.push(camera);
            }
        }
        Ok(draft)
    }

    /// How a node shows its mesh.
    fn deformation(
        &mut self,
        mesh: Index<Mesh>,
        placed: &PlacedNode<'_>,
        pose: &Pose,
        worlds: &HashMap<usize, DAffine3>,
        warnings: &mut Warnings,
    ) -> Result<Deformation, Fault> {
        let document = self.document;
        let animated = pose.get(&placed.index);
        let animated = animated.and_then(|animated| animated.weights.clone());
        let of_mesh = || {
            let mesh = document.root.meshes.get(mesh.value())?;
            mesh.weights.clone()
        };
        let weights = animated
            .or_else(|| placed.node.weights.clone())
            .or_else(of_mesh);
        let skin = match placed.node.skin {
            Some(skin) => skins::pose(
                document,
                skin,
                worlds,
                &placed.place,
                &mut self.accessors,
                warnings,
            )?,
            None => None,
        };
        Ok(Deformation {
            weights: weights.unwrap_or_default(),
            skin,
        })
    }

    /// Places a node's mesh, each of its primitives and copies.
    fn place(
        &mut self,
        mesh: Index<Mesh>,
        node: usize,
        placed: &PlacedNode<'_>,
        deformation: &Deformation,
        placements: &mut Vec<Placement>,
        warnings: &mut Warnings,
    ) -> Result<(), Fault> {
        let meshes = match self.deformed.get(&node) {
            Some((known, meshes)) if known == deformation => meshes.clone(),
            _ => self.meshes.indices_of(
                mesh,
                deformation,
                &placed.place,
                &mut self.accessors,
                &mut self.materials,
                warnings,
            )?,
        };
        if !deformation.is_none() {
            let known = (deformation.clone(), meshes.clone());
            self.deformed.insert(node, known);
        }
        let copies = instancing::copies(placed, &mut self.accessors)?;
        // A mesh of many primitives in many nodes is a product that no file size bounds.
        let count = meshes.len() as u64 * copies.len() as u64;
        let size = (size_of::<InstanceDesc>() + placed.name.len() + size_of::<Placement>()) as u64;
        self.accessors.budget.charge(count, size, &placed.place)?;
        // Where its joints are, a skin carries its mesh: not where its node is.
        let node_world = deformation
            .skin
            .as_ref()
            .map_or(placed.world, |skin| skin.world);
        for copy in copies {
            let world = node_world * copy;
            placements.extend(meshes.iter().map(|&mesh| Placement { mesh, node, world }));
        }
        Ok(())
    }
}
