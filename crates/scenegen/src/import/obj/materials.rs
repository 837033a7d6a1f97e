//! The materials of the libraries, read as parts of the geometry ask for them.

use std::collections::BTreeMap;
use std::path::Path;

use super::mtl::MtlMaterial;
use super::statements::Statements;
use super::textures::Textures;
use super::{energy, material};
use crate::desc::{ImageDesc, MaterialDesc, TextureDesc};
use crate::import::warnings::Warnings;

/// Materials in use, in order of first use, with their textures.
pub(super) struct Materials<'a> {
    library: &'a [MtlMaterial],
    textures: Textures<'a>,
    list: Vec<MaterialDesc>,
    /// Where those of `list` stand.
    places: Vec<String>,
    /// From indices in `library`, of which `None` is a grey default, to those in `list`.
    indices: BTreeMap<Option<usize>, usize>,
}

impl<'a> Materials<'a> {
    /// None yet; textures are looked for from `folder` if a library's own has none.
    pub(super) fn new(library: &'a [MtlMaterial], folder: &'a Path) -> Self {
        Self {
            library,
            textures: Textures::new(folder),
            list: Vec::new(),
            places: Vec::new(),
            indices: BTreeMap::new(),
        }
    }

    /// A material of the library with its index in the scene; `None` is a grey default.
    pub(super) fn get(
        &mut self,
        index: Option<usize>,
        warnings: &mut Warnings,
    ) -> (usize, &MaterialDesc) {
        let in_scene = match self.indices.get(&index) {
            Some(&known) => known,
            None => {
                let unnamed = MtlMaterial::unnamed();
                let source = index.map_or(&unnamed, |index| &self.library[index]);
                let statements = Statements::new(source, warnings);
                let material = material::read(statements, &mut self.textures);
                self.list.push(material);
                self.places.push(source.place());
                self.indices.insert(index, self.list.len() - 1);
                self.list.len() - 1
            }
        };
        (in_scene, &self.list[in_scene])
    }

    /// Says which materials of the libraries are not in use.
    pub(super) fn dismiss_unused(&self, warnings: &mut Warnings) {
        for (index, material) in self.library.iter().enumerate() {
            if !self.indices.contains_key(&Some(index)) {
                warnings.dismiss(None, material.place(), "no face uses it");
            }
        }
    }

    /// The materials, their textures, and the images decoded.
    pub(super) fn finish(
        mut self,
        warnings: &mut Warnings,
    ) -> (Vec<MaterialDesc>, Vec<TextureDesc>, Vec<ImageDesc>) {
        let (textures, images) = self.textures.finish(warnings);
        energy::conserve(&mut self.list, &self.places, &textures, &images, warnings);
        (self.list, textures, images)
    }
}
