//! The materials of a glTF file, read as meshes ask for them.

use std::collections::BTreeMap;

use gltf::json::{Index, Material};

use super::document::Document;
use super::lookup::{find, place};
use super::material;
use super::members::Members;
use super::textures::Textures;
use super::uv_sets::UvSets;
use crate::desc::{ImageDesc, MaterialDesc, TextureDesc};
use crate::import::error::Fault;
use crate::import::warnings::Warnings;

/// Materials in use, in order of first use.
pub(super) struct Materials<'a> {
    document: &'a Document,
    textures: Textures<'a>,
    list: Vec<MaterialDesc>,
    /// For each of them, the sets of texture coordinates that it reads.
    uv_sets: Vec<UvSets>,
    /// From indices in the file, of which `None` is glTF's default material, to those in `list`.
    indices: BTreeMap<Option<usize>, usize>,
}

impl<'a> Materials<'a> {
    /// None yet.
    pub(super) fn new(document: &'a Document) -> Self {
        Self {
            document,
            textures: Textures::new(document),
            list: Vec::new(),
            uv_sets: Vec::new(),
            indices: BTreeMap::new(),
        }
    }

    /// Says which materials and images of the file are not in use.
    pub(super) fn dismiss_unused(&self, warnings: &mut Warnings) {
        for (index, material) in self.document.root.materials.iter().enumerate() {
            if !self.indices.contains_key(&Some(index)) {
                let at = place("materials", index, material.name.as_deref());
                warnings.dismiss(None, at, "no mesh of the scene uses it");
            }
        }
        self.textures.dismiss_unused(warnings);
    }

    /// A material with its index in the scene, and the numbers of the texture coordinates that it reads; `None` is glTF's
    /// default material.
    pub(super) fn get(
        &mut self,
        index: Option<Index<Material>>,
        user: &str,
        warnings: &mut Warnings,
    ) -> Result<(usize, &MaterialDesc, [u32; 2]), Fault> {
        let materials = &self.document.root.materials;
        let material = index.and_then(|index| {
            let instead = "the default material is used";
            let material = find(materials, index, "materials", user, instead, warnings)?;
            Some((index.value(), material))
        });
        let key = material.map(|(index, _)| index);
        let in_scene = match self.indices.get(&key) {
            Some(&known) => known,
            None => {
                let (material, uv_sets) = self.read(material, warnings)?;
                self.list.push(material);
                self.uv_sets.push(uv_sets);
                self.indices.insert(key, self.list.len() - 1);
                self.list.len() - 1
            }
        };
        let uv_sets = self.uv_sets[in_scene].numbers();
        Ok((in_scene, &self.list[in_scene], uv_sets))
    }

    fn read(
        &mut self,
        material: Option<(usize, &Material)>,
        warnings: &mut Warnings,
    ) -> Result<(MaterialDesc, UvSets), Fault> {
        let default = Material::default();
        let (material, place, name) = match material {
            Some((index, material)) => {
                let name = material.name.clone();
                (
                    material,
                    place("materials", index, material.name.as_deref()),
                    name.unwrap_or_else(|| format!("material {index}")),
                )
            }
            None => (&default, "materials/default".into(), "default".into()),
        };
        let mut members = Members {
            textures: &mut self.textures,
            uv_sets: UvSets::default(),
            warnings,
            place,
        };
        let material = material::read(material, name, &mut members)?;
        Ok((material, members.uv_sets))
    }

    /// Takes one that is no material of the file, and has no textures; its index in the scene.
    pub(super) fn add(&mut self, material: MaterialDesc) -> usize {
        self.list.push(material);
        self.uv_sets.push(UvSets::default());
        self.list.len() - 1
    }

    /// The materials, their textures, and the images decoded.
    pub(super) fn finish(
        self,
        warnings: &mut Warnings,
    ) -> (Vec<MaterialDesc>, Vec<TextureDesc>, Vec<ImageDesc>) {
        let (textures, images) = self.textures.finish(warnings);
        (self.list, textures, images)
    }
}
