//! Sources of a material's inputs, and its parameter block.

use residual_render::program::{ColorNode, ImageNode, ScalarNode};
use residual_render::surface::Attributes;
use residual_render::texture::{AnyFilter, AnyFormat, AnyWrap, Image, UvMap};

use super::Binding;
use super::images::Images;
use crate::desc::{ColorInput, Filter, ScalarInput, SceneDesc, Texels, TextureUse, Wrap};

/// Turns the inputs of one material's description into sources, collecting parameters and the attributes read.
pub(super) struct Sources<'a> {
    scene: &'a SceneDesc,
    binding: Binding,
    available: Attributes,
    images: &'a mut Images,
    params: Vec<u32>,
    read: Attributes,
}

impl<'a> Sources<'a> {
    pub(super) fn new(
        scene: &'a SceneDesc,
        binding: Binding,
        available: Attributes,
        images: &'a mut Images,
    ) -> Self {
        let read = Attributes::NONE;
        Self {
            scene,
            binding,
            available,
            images,
            params: Vec::new(),
            read,
        }
    }

    /// The attributes read since the last call.
    pub(super) fn take_attributes(&mut self) -> Attributes {
        std::mem::take(&mut self.read)
    }

    pub(super) fn into_params(self) -> Vec<u32> {
        self.params
    }

    fn param(&mut self, words: impl IntoIterator<Item = u32>) -> u32 {
        let offset = self.params.len() as u32;
        self.params.extend(words);
        offset
    }

    /// A parameter that is read as a row.
    fn param_row(&mut self, [x, y, z]: [u32; 3]) -> u32 {
        self.param([x, y, z, 0])
    }

    /// A number: 0 and 1 are always constants, since they remove code.
    pub(super) fn number(&mut self, value: f32) -> ScalarNode {
        if value == 0.0 || value == 1.0 || self.binding == Binding::Constants {
            ScalarNode::Const(value)
        } else {
            ScalarNode::Param(self.param([value.to_bits()]))
        }
    }

    /// A colour without a texture.
    pub(super) fn constant_color(&mut self, value: [f32; 3]) -> ColorNode {
        if value == [0.0; 3] || value == [1.0; 3] || self.binding == Binding::Constants {
            ColorNode::Const(value)
        } else {
            ColorNode::Param(self.param_row(value.map(f32::to_bits)))
        }
    }

    pub(super) fn color_product(&self, a: ColorNode, b: ColorNode) -> ColorNode {
        const ONE: ColorNode = ColorNode::Const([1.0; 3]);
        const ZERO: ColorNode = ColorNode::Const([0.0; 3]);
        if a == ZERO || b == ZERO {
            ZERO
        } else if a == ONE {
            b
        } else if b == ONE {
            a
        } else {
            ColorNode::Product(Box::new(a), Box::new(b))
        }
    }

    fn scalar_product(&self, a: ScalarNode, b: ScalarNode) -> ScalarNode {
        const ONE: ScalarNode = ScalarNode::Const(1.0);
        const ZERO: ScalarNode = ScalarNode::Const(0.0);
        if a == ZERO || b == ZERO {
            ZERO
        } else if a == ONE {
            b
        } else if b == ONE {
            a
        } else {
            ScalarNode::Product(Box::new(a), Box::new(b))
        }
    }

    /// A colour input; with `vertex`, times the vertex colour where meshes have one.
    pub(super) fn color(&mut self, input: &ColorInput, vertex: bool) -> ColorNode {
        let mut node = self.constant_color(input.factor);
        if node == ColorNode::Const([0.0; 3]) {
            return node;
        }
        if let Some(texture) = &input.texture {
            let image = ColorNode::Image(self.image(texture, 0, AnyFormat::SrgbRgba8));
            node = self.color_product(node, image);
        }
        if vertex && self.available.colors {
            self.read.colors = true;
            node = self.color_product(node, ColorNode::VertexColor);
        }
        node
    }

    /// A scalar input.
    pub(super) fn scalar(&mut self, input: &ScalarInput) -> ScalarNode {
        let factor = self.number(input.factor);
        match &input.texture {
            Some((texture, channel)) if input.factor != 0.0 => {
                let texel = self.channel(texture, *channel);
                self.scalar_product(factor, texel)
            }
            _ => factor,
        }
    }

    /// Alpha: an input, times the vertex alpha where meshes have one.
    pub(super) fn alpha(&mut self, input: &ScalarInput) -> ScalarNode {
        let alpha = self.scalar(input);
        if self.available.colors {
            self.read.colors = true;
            return self.scalar_product(alpha, ScalarNode::VertexAlpha);
        }
        alpha
    }

    /// Alpha, if it is the same everywhere.
    pub(super) fn known_alpha(&self, input: &ScalarInput) -> Option<f32> {
        if self.available.colors {
            return None;
        }
        let Some((texture, channel)) = &input.texture else {
            return Some(input.factor);
        };
        let image = &self.scene.images[self.scene.textures[texture.texture].image];
        let first = match &image.texels {
            Texels::Rgba8(texels) => {
                let first = texels[0][*channel];
                let uniform = texels.iter().all(|texel| texel[*channel] == first);
                uniform.then(|| f32::from(first) / 255.0)
            }
            Texels::RgbaF32(texels) => {
                let first = texels[0][*channel];
                texels
                    .iter()
                    .all(|texel| texel[*channel] == first)
                    .then_some(first)
            }
        };
        first.map(|texel| texel * input.factor)
    }

    /// One channel of a texture, linear.
    pub(super) fn channel(&mut self, texture: &TextureUse, channel: usize) -> ScalarNode {
        ScalarNode::Image(self.image(texture, channel as u32, AnyFormat::LinearRgba8))
    }

    /// A texture's red, green and blue, linear.
    pub(super) fn linear_texel(&mut self, texture: &TextureUse) -> ColorNode {
        ColorNode::Image(self.image(texture, 0, AnyFormat::LinearRgba8))
    }

    fn image(&mut self, texture: &TextureUse, channel: u32, bytes: AnyFormat) -> ImageNode {
        let desc = &self.scene.textures[texture.texture];
        let format = match self.scene.images[desc.image].texels {
            Texels::Rgba8(_) => bytes,
            Texels::RgbaF32(_) => AnyFormat::LinearFloat,
        };
        let wrap = desc.wrap.map(|wrap| match wrap {
            Wrap::Repeat => AnyWrap::Repeat,
            Wrap::Mirror => AnyWrap::Mirror,
            Wrap::Clamp => AnyWrap::Clamp,
        });
        let filter = match desc.filter {
            Filter::Nearest => AnyFilter::Nearest,
            Filter::Linear => AnyFilter::Bilinear,
        };
        match texture.uv_set {
            0 => self.read.uv0 |= self.available.uv0,
            _ => self.read.uv1 |= self.available.uv1,
        }
        let place = self.images.place(self.scene, desc.image);
        let slot = self.param_row(place);
        let transform = texture.transform.map(|matrix| {
            let [first, _] = matrix.map(|row| self.param_row(row.map(f32::to_bits)));
            first
        });
        let uv = UvMap {
            set: texture.uv_set,
            transform,
        };
        Image {
            slot,
            uv,
            channel,
            wrap: (wrap[0], wrap[1]),
            filter,
            format,
        }
    }
}
