//! References from materials to textures, which glTF spells in two ways.

use gltf::json::extensions::texture::TextureTransform;
use gltf::json::material::NormalTexture;
use gltf::json::texture::Info;
use gltf::json::{Index, Texture, deserialize};

use crate::desc::UvTransform;
use crate::import::error::Fault;

/// A texture, and the coordinates that it is read with.
pub(super) struct TextureReference {
    /// The texture.
    pub(super) index: Index<Texture>,
    /// `n` of `TEXCOORD_n`.
    pub(super) uv_set: u32,
    /// KHR_texture_transform, with any bits in the floats.
    pub(super) transform: Option<UvTransform>,
}

impl From<&Info> for TextureReference {
    fn from(info: &Info) -> Self {
        let extensions = info.extensions.as_ref();
        let transform = extensions.and_then(|extensions| extensions.texture_transform.as_ref());
        Self::new(info.index, info.tex_coord, transform)
    }
}

impl TextureReference {
    /// Of a normal texture, whose extensions the `gltf` crate leaves as JSON.
    pub(super) fn to_normals(texture: &NormalTexture, at: &str) -> Result<Self, Fault> {
        let extensions = texture.extensions.as_ref();
        let json = extensions.and_then(|extensions| extensions.others.get("KHR_texture_transform"));
        let transform: Option<TextureTransform> = json
            .map(|json| deserialize::from_value(json.clone()))
            .transpose()
            .map_err(|error| {
                Fault::new(
                    format!("{at}/extensions/KHR_texture_transform"),
                    error.to_string(),
                )
            })?;
        Ok(Self::new(
            texture.index,
            texture.tex_coord,
            transform.as_ref(),
        ))
    }

    fn new(index: Index<Texture>, uv_set: u32, transform: Option<&TextureTransform>) -> Self {
        Self {
            index,
            uv_set: transform
                .and_then(|transform| transform.tex_coord)
                .unwrap_or(uv_set),
            transform: transform.map(uv_matrix),
        }
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
