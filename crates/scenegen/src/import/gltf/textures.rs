//! glTF textures, samplers and images, collected as materials ask for them.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::Path;

use gltf::json::extensions::texture::TextureTransform;
use gltf::json::texture::{Info, MagFilter, Sampler, WrappingMode};
use gltf::json::validation::Checked;
use gltf::json::{Index, Texture, Value};

use super::document::{Document, get};
use crate::desc::{Filter, ImageDesc, TextureDesc, TextureUse, UvTransform, Wrap};
use crate::import::error::{Fault, Warnings, place};
use crate::import::files;
use crate::import::images::{self, ImageRequest};

/// Textures in use, with their images still encoded.
pub(super) struct Textures<'a> {
    document: &'a Document,
    textures: Vec<TextureDesc>,
    texture_ids: BTreeMap<usize, usize>,
    requests: Vec<ImageRequest<'a>>,
    image_ids: BTreeMap<usize, usize>,
}

/// A reference to a texture, however the JSON spells it.
pub(super) struct Reference<'b> {
    index: Index<Texture>,
    uv_set: u32,
    transform: Option<Cow<'b, TextureTransform>>,
}

impl<'b> From<&'b Info> for Reference<'b> {
    fn from(info: &'b Info) -> Self {
        let transform = info
            .extensions
            .as_ref()
            .and_then(|extensions| extensions.texture_transform.as_ref());
        Self {
            index: info.index,
            uv_set: info.tex_coord,
            transform: transform.map(Cow::Borrowed),
        }
    }
}

impl Reference<'_> {
    /// Of a normal texture, whose extensions the `gltf` crate leaves as JSON.
    pub(super) fn to_normal_texture(
        texture: &gltf::json::material::NormalTexture,
        at: &str,
    ) -> Result<Self, Fault> {
        let extensions = texture.extensions.as_ref();
        let transform =
            extensions.and_then(|extensions| extensions.others.get("KHR_texture_transform"));
        let parse = |value: &Value| {
            gltf::json::deserialize::from_value(value.clone())
                .map(Cow::Owned)
                .map_err(|error| {
                    Fault::new(
                        format!("{at}/extensions/KHR_texture_transform"),
                        error.to_string(),
                    )
                })
        };
        Ok(Self {
            index: texture.index,
            uv_set: texture.tex_coord,
            transform: transform.map(parse).transpose()?,
        })
    }
}

impl<'a> Textures<'a> {
    /// None yet.
    pub(super) fn new(document: &'a Document) -> Self {
        Self {
            document,
            textures: Vec::new(),
            texture_ids: BTreeMap::new(),
            requests: Vec::new(),
            image_ids: BTreeMap::new(),
        }
    }

    /// Says which images of the file are not in use.
    pub(super) fn dismiss_unused(&self, warnings: &mut Warnings) {
        for (index, image) in self.document.root.images.iter().enumerate() {
            if !self.image_ids.contains_key(&index) {
                let at = place("images", index, image.name.as_deref());
                warnings.dismiss(None, at, "no material in use reads it");
            }
        }
    }

    /// Registers a use of a texture; `None` where it cannot be read, after a warning.
    pub(super) fn add<'b>(
        &mut self,
        reference: impl Into<Reference<'b>>,
        is_normal_map: bool,
        at: &str,
        warnings: &mut Warnings,
    ) -> Result<Option<TextureUse>, Fault> {
        let reference = reference.into();
        let mut uv_set = reference.uv_set;
        let mut matrix = None;
        if let Some(transform) = &reference.transform {
            uv_set = transform.tex_coord.unwrap_or(uv_set);
            matrix = Some(uv_matrix(transform));
            if matrix.is_some_and(|rows| rows.iter().flatten().any(|value| !value.is_finite())) {
                warnings.push(at, "KHR_texture_transform is not finite and ignored");
                matrix = None;
            }
        }
        if uv_set > 1 {
            warnings.push(
                at,
                format!(
                    "TEXCOORD_{uv_set} is not supported (0 and 1 are); the texture is left out"
                ),
            );
            return Ok(None);
        }
        let Some(texture) = self.texture(reference.index, is_normal_map, at, warnings)? else {
            return Ok(None);
        };
        const IDENTITY: UvTransform = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let transform = matrix.filter(|matrix| *matrix != IDENTITY);
        Ok(Some(TextureUse {
            texture,
            uv_set: uv_set as usize,
            transform,
        }))
    }

    fn texture(
        &mut self,
        index: Index<Texture>,
        is_normal_map: bool,
        user: &str,
        warnings: &mut Warnings,
    ) -> Result<Option<usize>, Fault> {
        let root = &self.document.root;
        let texture = get(&root.textures, index, "textures", user)?;
        let at = place("textures", index.value(), texture.name.as_deref());
        let others = texture
            .extensions
            .as_ref()
            .map(|extensions| &extensions.others);
        let webp = others
            .and_then(|others| others.get("EXT_texture_webp")?.get("source")?.as_u64())
            .and_then(|source| usize::try_from(source).ok());
        // An absent source is read as u32::MAX by the `gltf` crate.
        let plain = Some(texture.source.value()).filter(|&source| source != u32::MAX as usize);
        let Some(source) = webp.or(plain) else {
            warnings.push(
                at,
                "has no image in a format we read; the texture is left out",
            );
            return Ok(None);
        };
        let image = self.image(source, is_normal_map, &at)?;
        if let Some(&known) = self.texture_ids.get(&index.value()) {
            return Ok(Some(known));
        }
        let default = Sampler::default();
        let sampler = match texture.sampler {
            Some(sampler) => get(&root.samplers, sampler, "samplers", &at)?,
            None => &default,
        };
        let filter = match sampler.mag_filter {
            Some(Checked::Valid(MagFilter::Nearest)) => Filter::Nearest,
            Some(Checked::Valid(MagFilter::Linear) | Checked::Invalid) | None => Filter::Linear,
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
        self.textures.push(TextureDesc {
            image,
            wrap,
            filter,
        });
        self.texture_ids
            .insert(index.value(), self.textures.len() - 1);
        Ok(Some(self.textures.len() - 1))
    }

    fn image(&mut self, index: usize, is_normal_map: bool, user: &str) -> Result<usize, Fault> {
        let document = self.document;
        let image = get(
            &document.root.images,
            Index::<gltf::json::Image>::new(index as u32),
            "images",
            user,
        )?;
        if let Some(&known) = self.image_ids.get(&index) {
            self.requests[known].is_normal_map |= is_normal_map;
            return Ok(known);
        }
        let at = place("images", index, image.name.as_deref());
        let uri = image.uri.as_deref();
        let bytes = match (image.buffer_view, uri) {
            (Some(view), _) => document
                .view(view, &at)
                .map(|(bytes, _)| Cow::Borrowed(bytes))
                .map_err(|fault| format!("cannot be read ({}: {})", fault.place, fault.problem)),
            (None, Some(uri)) => files::read_uri(uri, document.folder()).map(Cow::Owned),
            (None, None) => Err("has neither a uri nor a bufferView".into()),
        };
        let file_name = uri.filter(|uri| !uri.starts_with("data:"));
        let extension = file_name
            .and_then(|uri| Path::new(uri).extension()?.to_str())
            .map(str::to_owned);
        let name = image
            .name
            .clone()
            .or(file_name.map(str::to_owned))
            .unwrap_or_else(|| format!("image {index}"));
        self.requests.push(ImageRequest {
            name,
            place: at,
            bytes,
            extension,
            is_normal_map,
        });
        self.image_ids.insert(index, self.requests.len() - 1);
        Ok(self.requests.len() - 1)
    }

    /// Decodes the images.
    pub(super) fn finish(self, warnings: &mut Warnings) -> (Vec<TextureDesc>, Vec<ImageDesc>) {
        (self.textures, images::decode_all(self.requests, warnings))
    }
}

/// Translation · rotation · scale; a positive angle turns the coordinates from v towards u, which turns the
/// picture clockwise, as three.js and Bevy read the extension.
fn uv_matrix(transform: &TextureTransform) -> UvTransform {
    let [offset_u, offset_v] = transform.offset.0;
    let [scale_u, scale_v] = transform.scale.0;
    let (sin, cos) = f64::from(transform.rotation.0).sin_cos();
    let scaled = |value: f64, scale: f32| (value * f64::from(scale)) as f32;
    [
        [scaled(cos, scale_u), scaled(sin, scale_v), offset_u],
        [scaled(-sin, scale_u), scaled(cos, scale_v), offset_v],
    ]
}
