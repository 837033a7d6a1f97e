//! Inputs of materials: colours, numbers and normals, constant or read from textures.

/// Affine map of texture coordinates (KHR_texture_transform): `uv' = matrix · (u, v, 1)`, two rows.
pub type UvTransform = [[f32; 3]; 2];

/// A use of a texture.
#[derive(Debug, Clone, PartialEq)]
pub struct TextureUse {
    /// Index into [`SceneDesc::textures`](super::SceneDesc::textures).
    pub texture: usize,
    /// 0 for `TEXCOORD_0`, 1 for `TEXCOORD_1`.
    pub uv_set: usize,
    /// `None` is the identity.
    pub transform: Option<UvTransform>,
}

/// A colour: a factor, times a texture's sRGB-encoded RGB where there is one.
#[derive(Debug, Clone, PartialEq)]
pub struct ColorInput {
    /// Linear factor.
    pub factor: [f32; 3],
    /// Colour texture; [`Texels::Rgba8`](super::Texels::Rgba8) and [`Texels::Rgba16`](super::Texels::Rgba16) are decoded from sRGB.
    pub texture: Option<TextureUse>,
}

/// A number: a factor, times one channel of a texture where there is one.
#[derive(Debug, Clone, PartialEq)]
pub struct ScalarInput {
    /// Factor.
    pub factor: f32,
    /// Texture and the channel (0 red … 3 alpha) that is read, linear.
    pub texture: Option<(TextureUse, usize)>,
}

/// A tangent-space normal map.
#[derive(Debug, Clone, PartialEq)]
pub struct NormalMap {
    /// Texture, read as linear RGB, `2·rgb − 1`.
    pub texture: TextureUse,
    /// Factor on x and y.
    pub scale: f32,
}

impl ColorInput {
    /// A colour without a texture.
    pub fn constant(factor: [f32; 3]) -> Self {
        Self {
            factor,
            texture: None,
        }
    }
}

impl ScalarInput {
    /// A number without a texture.
    pub fn constant(factor: f32) -> Self {
        Self {
            factor,
            texture: None,
        }
    }
}
