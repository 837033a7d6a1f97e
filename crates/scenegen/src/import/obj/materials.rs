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
    /// To indices in `list`.
    indices: BTreeMap<Source, usize>,
}

/// Where a material comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Source {
    /// An index in the library.
    Library(usize),
    /// A grey default.
    Grey,
    /// A white one, for vertices that have colours.
    White,
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

    /// A material with its index in the scene.
    pub(super) fn get(
        &mut self,
        source: Source,
        warnings: &mut Warnings,
    ) -> (usize, &MaterialDesc) {
        let index = match self.indices.get(&source) {
            Some(&known) => known,
            None => {
                let default = match source {
                    Source::White => MtlMaterial::white(),
                    Source::Grey | Source::Library(_) => MtlMaterial::grey(),
                };
                let material = match source {
                    Source::Library(index) => &self.library[index],
                    Source::Grey | Source::White => &default,
                };
                self.places.push(material.place());
                let statements = Statements::new(material, warnings);
                self.list
                    .push(material::read(statements, &mut self.textures));
                self.indices.insert(source, self.list.len() - 1);
                self.list.len() - 1
            }
        };
        (index, &self.list[index])
    }

    /// Says which materials of the libraries are not in use.
    pub(super) fn dismiss_unused(&self, warnings: &mut Warnings) {
        for (index, material) in self.library.iter().enumerate() {
            if !self.indices.contains_key(&Source::Library(index)) {
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
