//! The meshes of a glTF file, read as nodes ask for them: each primitive becomes a mesh of the scene.

use gltf::json::{Index, Mesh};

use super::accessors::Accessors;
use super::deform::Deformation;
use super::document::Document;
use super::lookup::{find, place};
use super::materials::Materials;
use super::{primitives, variants};
use crate::desc::MeshDesc;
use crate::import::error::Fault;
use crate::import::mesh;
use crate::import::warnings::Warnings;

/// Meshes in use, in order of first use.
pub(super) struct Meshes<'a> {
    document: &'a Document,
    /// Index of the set of materials to show.
    variant: Option<usize>,
    /// Those of the scene so far.
    pub(super) list: Vec<MeshDesc>,
    /// For each mesh of the file the indices in `list` of what it became, once read, where nothing deforms it.
    indices: Vec<Option<Vec<usize>>>,
    /// Whether each mesh of the file is in the scene.
    is_used: Vec<bool>,
}

impl<'a> Meshes<'a> {
    /// None yet.
    pub(super) fn new(document: &'a Document, variant: Option<usize>) -> Self {
        Self {
            document,
            variant,
            list: Vec::new(),
            indices: vec![None; document.root.meshes.len()],
            is_used: vec![false; document.root.meshes.len()],
        }
    }

    /// Says which meshes of the file are not in the scene.
    pub(super) fn dismiss_unused(&self, warnings: &mut Warnings) {
        for (index, &is_used) in self.is_used.iter().enumerate() {
            if !is_used {
                let mesh = &self.document.root.meshes[index];
                let at = place("meshes", index, mesh.name.as_deref());
                warnings.dismiss(None, at, "no node of the scene shows it");
            }
        }
    }

    /// The indices in `list` of a mesh's primitives, without those that have nothing to render.
    pub(super) fn indices_of(
        &mut self,
        index: Index<Mesh>,
        deformation: &Deformation,
        user: &str,
        accessors: &mut Accessors<'_>,
        materials: &mut Materials<'_>,
        warnings: &mut Warnings,
    ) -> Result<Vec<usize>, Fault> {
        let meshes = &self.document.root.meshes;
        let without = "nothing is shown for it";
        let Some(mesh) = find(meshes, index, "meshes", user, without, warnings) else {
            return Ok(Vec::new());
        };
        let index = index.value();
        self.is_used[index] = true;
        if let Some(indices) = &self.indices[index]
            && deformation.is_none()
        {
            return Ok(indices.clone());
        }
        let mesh_place = place("meshes", index, mesh.name.as_deref());
        let mesh_name = mesh.name.clone();
        let mesh_name = mesh_name.unwrap_or_else(|| format!("mesh {index}"));
        let mut indices = Vec::new();
        for (i, primitive) in mesh.primitives.iter().enumerate() {
            let at = format!("{mesh_place}/primitives/{i}");
            let Some(topology) = primitives::topology(primitive, &at, warnings)? else {
                continue;
            };
            let material = variants::material(primitive, self.variant);
            let (material_index, material, uv_sets) = materials.get(material, &at, warnings)?;
            let mut raw = primitives::read(primitive, topology, uv_sets, accessors, &at, warnings)?;
            deformation.apply(&mut raw, primitive, accessors, &at, warnings)?;
            let name = if mesh.primitives.len() > 1 {
                format!("{mesh_name}/{i}")
            } else {
                mesh_name.clone()
            };
            let budget = &mut accessors.budget;
            if let Some(mesh) = mesh::finish(raw, name, material, &at, budget, warnings)? {
                self.list.push(MeshDesc {
                    material: material_index,
                    ..mesh
                });
                indices.push(self.list.len() - 1);
            }
        }
        if deformation.is_none() {
            self.indices[index] = Some(indices.clone());
        }
        Ok(indices)
    }
}
