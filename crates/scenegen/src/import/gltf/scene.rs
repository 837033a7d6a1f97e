//! A glTF file as a scene description: the pieces of the `gltf_*` modules put together.

use std::path::Path;

use glam::{DAffine3, DQuat, DVec3};
use gltf::json::{Index, Mesh};

use super::accessors::Accessors;
use super::document::{Document, get};
use super::materials::Materials;
use super::nodes::{self, Placed};
use super::{lights, primitives};
use crate::desc::{InstanceDesc, MeshDesc, SceneDesc};
use crate::import::error::{Fault, ImportError, Warnings, place};
use crate::import::instances::place_mesh;
use crate::import::{mesh, texture_uses};

/// Reads a `.gltf` or `.glb` file.
pub(in crate::import) fn import(
    file: &Path,
    warnings: &mut Warnings,
) -> Result<SceneDesc, ImportError> {
    let document = Document::open(file, warnings)?;
    read(&document, warnings).map_err(|fault| fault.in_file(file))
}

fn read(document: &Document, warnings: &mut Warnings) -> Result<SceneDesc, Fault> {
    let mut reader = Reader {
        document,
        accessors: Accessors::new(document),
        materials: Materials::new(document),
        meshes: Vec::new(),
        mesh_ids: vec![None; document.root.meshes.len()],
    };
    let mut scene = SceneDesc::default();
    for placed in nodes::flatten(document, warnings)? {
        if let Some(mesh) = placed.node.mesh {
            reader.instances(mesh, &placed, &mut scene.instances, warnings)?;
        }
        let extensions = placed.node.extensions.as_ref();
        if let Some(light) =
            extensions.and_then(|extensions| extensions.khr_lights_punctual.as_ref())
        {
            scene
                .lights
                .extend(lights::light(document, light.light, &placed, warnings)?);
        }
        if let Some(camera) = placed.node.camera {
            scene
                .cameras
                .extend(lights::camera(document, camera, &placed, warnings)?);
        }
    }
    reader.dismiss_unused(warnings);
    scene.meshes = reader.meshes;
    (scene.textures, scene.images) = reader.materials.textures.finish(warnings);
    scene.materials = reader.materials.list;
    Ok(scene)
}

struct Reader<'a> {
    document: &'a Document,
    accessors: Accessors<'a>,
    materials: Materials<'a>,
    meshes: Vec<MeshDesc>,
    /// The meshes made of each glTF mesh's primitives, once read.
    mesh_ids: Vec<Option<Vec<usize>>>,
}

impl Reader<'_> {
    /// Says what of the file is not in the scene.
    fn dismiss_unused(&self, warnings: &mut Warnings) {
        for (index, ids) in self.mesh_ids.iter().enumerate() {
            if ids.is_none() {
                let mesh = &self.document.root.meshes[index];
                let at = place("meshes", index, mesh.name.as_deref());
                warnings.dismiss(None, at, "no node of the scene shows it");
            }
        }
        self.materials.dismiss_unused(warnings);
    }

    fn instances(
        &mut self,
        mesh: Index<Mesh>,
        placed: &Placed<'_>,
        instances: &mut Vec<InstanceDesc>,
        warnings: &mut Warnings,
    ) -> Result<(), Fault> {
        if placed.node.skin.is_some() {
            warnings.push(
                &*placed.place,
                "skins are not supported; shown in its rest pose at the node's place",
            );
        }
        let ids = self.mesh(mesh, &placed.place, warnings)?;
        let copies = self.copies(placed)?;
        // A mesh of many primitives in many nodes is a product that no file size bounds.
        let size = (size_of::<InstanceDesc>() + placed.name.len()) as u64;
        let budget = &mut self.accessors.budget;
        budget.charge(ids.len() as u64 * copies.len() as u64, size, &placed.place)?;
        for copy in copies {
            let world = placed.world * copy;
            for &id in &ids {
                instances.extend(place_mesh(
                    &self.meshes,
                    id,
                    &placed.name,
                    &world,
                    &placed.place,
                    warnings,
                ));
            }
        }
        Ok(())
    }

    /// Transforms of EXT_mesh_gpu_instancing, or one identity.
    fn copies(&mut self, placed: &Placed<'_>) -> Result<Vec<DAffine3>, Fault> {
        let extensions = placed.node.extensions.as_ref();
        let Some(instancing) =
            extensions.and_then(|extensions| extensions.others.get("EXT_mesh_gpu_instancing"))
        else {
            return Ok(vec![DAffine3::IDENTITY]);
        };
        let at = format!("{}/extensions/EXT_mesh_gpu_instancing", placed.place);
        let accessor = |name: &str| -> Result<Option<Index<_>>, Fault> {
            let Some(value) = instancing
                .get("attributes")
                .and_then(|attributes| attributes.get(name))
            else {
                return Ok(None);
            };
            let index = value.as_u64().and_then(|index| u32::try_from(index).ok());
            index
                .map(Index::new)
                .map(Some)
                .ok_or_else(|| Fault::new(&*at, format!("{name} is not an accessor index")))
        };
        let (translation, rotation, scale) = (
            accessor("TRANSLATION")?,
            accessor("ROTATION")?,
            accessor("SCALE")?,
        );
        let mut count = None;
        for index in [translation, rotation, scale].into_iter().flatten() {
            let elements = self.accessors.count(index, &at)?;
            if *count.get_or_insert(elements) != elements {
                return Err(Fault::new(at, "the attributes have different counts"));
            }
        }
        let count = count.unwrap_or(0);
        // The transform here and an instance with its name for each.
        self.accessors.budget.charge(count, 256, &at)?;
        let count = count as usize;
        let translations = translation
            .map(|index| self.accessors.floats::<3>(index, &at))
            .transpose()?;
        let rotations = rotation
            .map(|index| self.accessors.floats::<4>(index, &at))
            .transpose()?;
        let scales = scale
            .map(|index| self.accessors.floats::<3>(index, &at))
            .transpose()?;
        let vector = |values: &Option<Vec<[f32; 3]>>, i: usize, default| {
            values
                .as_ref()
                .map_or(default, |values| DVec3::from(values[i].map(f64::from)))
        };
        let rotation = |i: usize| {
            let quaternion = rotations
                .as_ref()
                .map(|values| DQuat::from_array(values[i].map(f64::from)));
            quaternion
                .filter(|quaternion| quaternion.length() > 0.0)
                .map_or(DQuat::IDENTITY, DQuat::normalize)
        };
        Ok((0..count)
            .map(|i| {
                DAffine3::from_scale_rotation_translation(
                    vector(&scales, i, DVec3::ONE),
                    rotation(i),
                    vector(&translations, i, DVec3::ZERO),
                )
            })
            .collect())
    }

    /// The meshes of a glTF mesh, one for each primitive that can be rendered.
    fn mesh(
        &mut self,
        index: Index<Mesh>,
        user: &str,
        warnings: &mut Warnings,
    ) -> Result<Vec<usize>, Fault> {
        let mesh = get(&self.document.root.meshes, index, "meshes", user)?;
        if let Some(ids) = &self.mesh_ids[index.value()] {
            return Ok(ids.clone());
        }
        let mesh_place = place("meshes", index.value(), mesh.name.as_deref());
        let mesh_name = mesh
            .name
            .clone()
            .unwrap_or_else(|| format!("mesh {}", index.value()));
        let mut ids = Vec::new();
        for (i, primitive) in mesh.primitives.iter().enumerate() {
            let at = format!("{mesh_place}/primitives/{i}");
            let Some(raw) = primitives::read(primitive, &mut self.accessors, &at, warnings)? else {
                continue;
            };
            let name = if mesh.primitives.len() > 1 {
                format!("{mesh_name}/{i}")
            } else {
                mesh_name.clone()
            };
            let material = self.materials.id(primitive.material, &at, warnings)?;
            let desc = &self.materials.list[material];
            texture_uses::warn_about_missing_uvs(desc, &raw.uvs, &at, warnings);
            let tangent_uv_set = desc.normal_map.as_ref().map(|map| map.texture.uv_set);
            let finished = mesh::finish(
                raw,
                name,
                tangent_uv_set,
                &at,
                &mut self.accessors.budget,
                warnings,
            )?;
            if let Some(finished) = finished {
                self.meshes.push(MeshDesc {
                    material,
                    ..finished
                });
                ids.push(self.meshes.len() - 1);
            }
        }
        self.mesh_ids[index.value()] = Some(ids.clone());
        Ok(ids)
    }
}
