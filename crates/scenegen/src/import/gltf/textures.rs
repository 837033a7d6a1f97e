//! glTF textures with their samplers, collected as materials ask for them.

use std::collections::BTreeMap;

use gltf::json::texture::{MagFilter, MinFilter, Sampler, WrappingMode};
use gltf::json::validation::Checked;
use gltf::json::{Image, Index, Texture};

use super::document::Document;
use super::images::Images;
use super::lookup::{find, place};
use super::texture_reference::TextureReference;
use super::uv_sets::UvSets;
use crate::desc::{Filter, ImageDesc, TextureDesc, TextureUse, UvTransform, Wrap};
use crate::import::error::Fault;
use crate::import::images::{Derived, ImageRole};
use crate::import::warnings::Warnings;

/// Textures in use, with their images.
pub(super) struct Textures<'a> {
    document: &'a Document,
    images: Images<'a>,
    list: Vec<TextureDesc>,
    /// From indices in the file, for each way to read them, to those in `list`.
    indices: BTreeMap<(usize, Derived), usize>,
}

impl<'a> Textures<'a> {
    /// None yet.
    pub(super) fn new(document: &'a Document) -> Self {
        Self {
            document,
            images: Images::new(document),
            list: Vec::new(),
            indices: BTreeMap::new(),
        }
    }

    /// Says which images of the file are not in use.
    pub(super) fn dismiss_unused(&self, warnings: &mut Warnings) {
        self.images.dismiss_unused(warnings);
    }

    /// Registers a use of a texture; `None` where it cannot be read, after a warning.
    pub(super) fn add(
        &mut self,
        reference: TextureReference,
        role: ImageRole,
        at: &str,
        uv_sets: &mut UvSets,
        warnings: &mut Warnings,
    ) -> Result<Option<TextureUse>, Fault> {
        let TextureReference {
            index,
            uv_set,
            mut transform,
        } = reference;
        if transform.is_some_and(|rows| rows.iter().flatten().any(|value| !value.is_finite())) {
            warnings.push(at, "KHR_texture_transform is not finite and ignored");
            transform = None;
        }
        let Some(uv_set) = uv_sets.index_of(uv_set) else {
            let message = format!(
                "TEXCOORD_{uv_set} is the third set of coordinates that the material reads, and two are supported; \
                 the texture is left out"
            );
            warnings.push(at, message);
            return Ok(None);
        };
        let Some(texture) = self.index_of(index, role, at, warnings)? else {
            return Ok(None);
        };
        const IDENTITY: UvTransform = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        Ok(Some(TextureUse {
            texture,
            uv_set,
            transform: transform.filter(|transform| *transform != IDENTITY),
        }))
    }

    /// The index in the scene.
    fn index_of(
        &mut self,
        index: Index<Texture>,
        role: ImageRole,
        user: &str,
        warnings: &mut Warnings,
    ) -> Result<Option<usize>, Fault> {
        let root = &self.document.root;
        let without = "the texture is left out";
        let Some(texture) = find(&root.textures, index, "textures", user, without, warnings) else {
            return Ok(None);
        };
        let at = place("textures", index.value(), texture.name.as_deref());
        let Some(source) = source(texture) else {
            warnings.push(
                at,
                "has no image in a format we read; the texture is left out",
            );
            return Ok(None);
        };
        let Some(image) = self.images.add(source, role, &at, warnings) else {
            return Ok(None);
        };
        let key = (index.value(), role.derived());
        if let Some(&known) = self.indices.get(&key) {
            return Ok(Some(known));
        }
        let default = Sampler::default();
        let sampler = texture.sampler.and_then(|sampler| {
            let instead = "the default is used";
            find(&root.samplers, sampler, "samplers", &at, instead, warnings)
        });
        let sampler = sampler.unwrap_or(&default);
        let (wrap, filter) = read_sampler(sampler, &at, warnings);
        self.list.push(TextureDesc {
            image,
            wrap,
            filter,
        });
        self.indices.insert(key, self.list.len() - 1);
        Ok(Some(self.list.len() - 1))
    }

    /// Decodes the images.
    pub(super) fn finish(self, warnings: &mut Warnings) -> (Vec<TextureDesc>, Vec<ImageDesc>) {
        (self.list, self.images.finish(warnings))
    }
}

/// Where textures name images in formats that other readers may not know.
const FORMATS: [&str; 2] = ["EXT_texture_webp", "KHR_texture_basisu"];

/// The image in a format that we read, those of extensions before what stands in for them.
fn source(texture: &Texture) -> Option<Index<Image>> {
    let others = texture.extensions.as_ref().map(|used| &used.others);
    let named = |format| {
        let source = others?.get(format)?.get("source")?.as_u64()?;
        u32::try_from(source).ok()
    };
    let newer = FORMATS.into_iter().find_map(named);
    // An absent source is read as u32::MAX by the `gltf` crate.
    let plain = Some(texture.source).filter(|source| source.value() != u32::MAX as usize);
    newer.map(Index::new).or(plain)
}

/// How coordinates outside [0, 1] are read, along u and v, and how texels are combined.
fn read_sampler(sampler: &Sampler, at: &str, warnings: &mut Warnings) -> ([Wrap; 2], Filter) {
    let filter = match sampler.mag_filter {
        Some(Checked::Valid(MagFilter::Nearest)) => Filter::Nearest,
        Some(Checked::Valid(MagFilter::Linear) | Checked::Invalid) | None => {
            match sampler.min_filter {
                Some(Checked::Valid(MinFilter::Nearest | MinFilter::Linear)) => Filter::Linear,
                // Without a word of the file, as renderers do it by default.
                _ => Filter::Mipmapped,
            }
        }
    };
    let wrap = [sampler.wrap_s, sampler.wrap_t].map(|mode| match mode {
        Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
        Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
        Checked::Valid(WrappingMode::Repeat) | Checked::Invalid => Wrap::Repeat,
    });
    if sampler.mag_filter == Some(Checked::Invalid)
        || [sampler.wrap_s, sampler.wrap_t].contains(&Checked::Invalid)
    {
        warnings.push(
            at,
            "the sampler has an unknown filter or wrap mode; the default is used",
        );
    }
    (wrap, filter)
}
