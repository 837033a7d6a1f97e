//! Sources of a material's inputs, and its parameter block.

use std::collections::BTreeMap;

use residual_render::math::vec3::vec3;
use residual_render::program::{ColorNode, ImageNode, ScalarNode, Source};
use residual_render::record::BufferRecord;
use residual_render::surface::Attributes;
use residual_render::texture::{AnyFormat, ColorParam, Image, TransformParam, UvMap};
use residual_render::tracer::TracerNode;

use super::image_reading;
use super::images::Images;
use super::options::{Binding, PlanOptions, TextureResolution};
use crate::desc::{ColorInput, Dismissed, ScalarInput, SceneDesc, TextureUse};
use crate::effect::Effect;

/// Turns the inputs of one material's description into sources, collecting parameters.
pub(super) struct Sources<'a> {
    scene: &'a SceneDesc,
    binding: Binding,
    textures: TextureResolution,
    available: Attributes,
    images: &'a mut Images,
    /// The material, for messages.
    place: String,
    params: Vec<u32>,
    /// Inputs that several lobes share become one source.
    scalars: Vec<(ScalarInput, ScalarNode)>,
    colors: Vec<(ColorInput, ColorNode)>,
    image_names: BTreeMap<u32, String>,
    dismissed: Vec<Dismissed>,
}

/// What a material's sources amount to, beside its program.
pub(super) struct Collected {
    /// The parameter block.
    pub(super) params: Vec<u32>,
    /// Names of the images that are read, by their slots in the parameter block.
    pub(super) images: BTreeMap<u32, String>,
    /// Inputs that change nothing.
    pub(super) dismissed: Vec<Dismissed>,
}

impl<'a> Sources<'a> {
    pub(super) fn new(
        scene: &'a SceneDesc,
        options: &PlanOptions,
        available: Attributes,
        images: &'a mut Images,
        place: String,
    ) -> Self {
        Self {
            scene,
            binding: options.binding,
            textures: match options.tracer {
                TracerNode::Path(_) | TracerNode::Bidirectional(_) => options.textures,
                TracerNode::AmbientOcclusion | TracerNode::Debug(_) => TextureResolution::Full,
            },
            available,
            images,
            place,
            params: Vec::new(),
            scalars: Vec::new(),
            colors: Vec::new(),
            image_names: BTreeMap::new(),
            dismissed: Vec::new(),
        }
    }

    /// The vertex attributes that a source reads of those that there are.
    pub(super) fn read(&self, source: &impl Source) -> Attributes {
        source.attributes().intersection(self.available)
    }

    /// Whether meshes have tangents.
    pub(super) fn has_tangents(&self) -> bool {
        self.available.tangents
    }

    /// Notes that something of the material changes nothing.
    pub(super) fn dismiss(&mut self, effect: Effect, reason: impl Into<String>) {
        let dismissed = Dismissed {
            effect: Some(effect),
            place: self.place.clone(),
            reason: reason.into(),
        };
        if !self.dismissed.contains(&dismissed) {
            self.dismissed.push(dismissed);
        }
    }

    pub(super) fn collected(self) -> Collected {
        Collected {
            params: self.params,
            images: self.image_names,
            dismissed: self.dismissed,
        }
    }

    fn param(&mut self, value: f32) -> u32 {
        let offset = self.params.len() as u32;
        self.params.push(value.to_bits());
        offset
    }

    fn param_record(&mut self, record: impl BufferRecord) -> u32 {
        let offset = self.params.len() as u32;
        record.append_to(&mut self.params);
        offset
    }

    /// An index, always a parameter.
    pub(super) fn index(&mut self, index: u32) -> u32 {
        let offset = self.params.len() as u32;
        self.params.push(index);
        offset
    }

    /// Numbers, always parameters; their first one's offset.
    pub(super) fn table(&mut self, numbers: &[f32]) -> u32 {
        let offset = self.params.len() as u32;
        self.params.extend(numbers.iter().map(|x| x.to_bits()));
        offset
    }

    /// A number: 0 and 1 are always constants, since they remove code.
    pub(super) fn number(&mut self, value: f32) -> ScalarNode {
        if value == 0.0 || value == 1.0 || self.binding == Binding::Constants {
            ScalarNode::Const(value)
        } else {
            ScalarNode::Param(self.param(value))
        }
    }

    /// A colour without a texture.
    pub(super) fn constant_color(&mut self, value: [f32; 3]) -> ColorNode {
        if value == [0.0; 3] || value == [1.0; 3] || self.binding == Binding::Constants {
            ColorNode::Const(value)
        } else {
            ColorNode::Param(self.param_record(ColorParam {
                color: value.into(),
            }))
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

    pub(super) fn scalar_product(&self, a: ScalarNode, b: ScalarNode) -> ScalarNode {
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

    /// A colour input, times the vertex colour where meshes have one.
    pub(super) fn tinted_color(&mut self, input: &ColorInput) -> ColorNode {
        let color = self.color(input);
        match self.available.colors {
            true => self.color_product(color, ColorNode::VertexColor),
            false => color,
        }
    }

    /// A colour input.
    pub(super) fn color(&mut self, input: &ColorInput) -> ColorNode {
        let mut known = self.colors.iter();
        if let Some((_, node)) = known.find(|(other, _)| other == input) {
            return node.clone();
        }
        let node = self.new_color(input);
        self.colors.push((input.clone(), node.clone()));
        node
    }

    /// A colour input at the full resolution of its texture: that of a light, from which samples are drawn, too.
    pub(super) fn full_color(&mut self, input: &ColorInput) -> ColorNode {
        match std::mem::replace(&mut self.textures, TextureResolution::Full) {
            TextureResolution::Full => self.color(input),
            textures @ TextureResolution::Filtered => {
                let node = self.new_color(input);
                self.textures = textures;
                node
            }
        }
    }

    fn new_color(&mut self, input: &ColorInput) -> ColorNode {
        let mut factor = input.factor;
        let mut texture = input.texture.as_ref();
        if let Some(of) = texture {
            let extremes = [0, 1, 2].map(|k| self.extremes(of, k, AnyFormat::SrgbRgba8));
            if factor == [0.0; 3] {
                self.dismiss_image(of, "its factor is 0");
                texture = None;
            } else if extremes.iter().all(|[least, greatest]| least == greatest) {
                self.dismiss_image(of, "it is of one colour");
                factor = [0, 1, 2].map(|k| factor[k] * extremes[k][0]);
                texture = None;
            }
        }
        let mut node = self.constant_color(factor);
        if factor == [0.0; 3] {
            return node;
        }
        if let Some(texture) = texture {
            let image = ColorNode::Image(self.image(texture, 0, AnyFormat::SrgbRgba8));
            node = self.color_product(node, image);
        }
        node
    }

    /// A checkerboard of two colours over the first texture coordinates, scaled.
    pub(super) fn checkerboard(
        &mut self,
        even: &ColorInput,
        odd: &ColorInput,
        [u, v]: [f32; 2],
    ) -> ColorNode {
        if even == odd {
            return self.color(even);
        }
        let (even, odd) = (Box::new(self.color(even)), Box::new(self.color(odd)));
        let transform = TransformParam {
            u: vec3(u, 0.0, 0.0),
            v: vec3(0.0, v, 0.0),
        };
        let transform = match [u, v] {
            [1.0, 1.0] => None,
            _ => Some(self.param_record(transform)),
        };
        let uv = UvMap { set: 0, transform };
        ColorNode::Checkerboard { even, odd, uv }
    }

    /// A scalar input.
    pub(super) fn scalar(&mut self, input: &ScalarInput) -> ScalarNode {
        let mut known = self.scalars.iter();
        if let Some((_, node)) = known.find(|(other, _)| other == input) {
            return node.clone();
        }
        let node = self.new_scalar(input);
        self.scalars.push((input.clone(), node.clone()));
        node
    }

    fn new_scalar(&mut self, input: &ScalarInput) -> ScalarNode {
        let known = self.known(input);
        let Some((texture, channel)) = &input.texture else {
            return self.number(input.factor);
        };
        if let Some(value) = known {
            let reason = match input.factor {
                0.0 => "its factor is 0",
                _ => "its channel is the same everywhere",
            };
            self.dismiss_image(texture, reason);
            return self.number(value);
        }
        let factor = self.number(input.factor);
        let texel = self.channel(texture, *channel);
        self.scalar_product(factor, texel)
    }

    /// A number between `low`, where the texture of an input is 0, and its factor, where the texture is 1 or not there.
    pub(super) fn between(&mut self, low: f32, high: &ScalarInput) -> ScalarNode {
        let texture = ScalarInput {
            factor: 1.0,
            texture: high.texture.clone(),
        };
        match (self.known(&texture), &high.texture) {
            (None, Some((texture, channel))) => {
                let [low, high] = [low, high.factor].map(|value| Box::new(self.number(value)));
                let at = Box::new(self.channel(texture, *channel));
                ScalarNode::Between { low, high, at }
            }
            (known, _) => {
                let at = known.unwrap_or(1.0);
                self.number(low + (high.factor - low) * at)
            }
        }
    }

    /// The value of a scalar input that has the same everywhere.
    pub(super) fn known(&mut self, input: &ScalarInput) -> Option<f32> {
        match &input.texture {
            Some((texture, channel)) if input.factor != 0.0 => {
                let [least, greatest] = self.extremes(texture, *channel, AnyFormat::LinearRgba8);
                (least == greatest).then_some(input.factor * least)
            }
            _ => Some(input.factor),
        }
    }

    /// Alpha: an input, times the vertex alpha where meshes have one.
    pub(super) fn alpha(&mut self, input: &ScalarInput) -> ScalarNode {
        let alpha = self.scalar(input);
        if self.available.colors {
            return self.scalar_product(alpha, ScalarNode::VertexColor);
        }
        alpha
    }

    /// Least and greatest alpha of a material, if that is known.
    pub(super) fn alpha_extremes(&mut self, input: &ScalarInput) -> Option<[f32; 2]> {
        if self.available.colors {
            return (self.known(input) == Some(0.0)).then_some([0.0; 2]);
        }
        let texels = match &input.texture {
            Some((texture, channel)) => self.extremes(texture, *channel, AnyFormat::LinearRgba8),
            None => [1.0; 2],
        };
        Some(texels.map(|texel| input.factor * texel))
    }

    /// Whether a normal map bends no normal: its texels are one, within a code of (0.5, 0.5, 1), which bytes cannot
    /// write exactly.
    pub(super) fn is_flat(&mut self, texture: &TextureUse) -> bool {
        const FLAT: [f32; 3] = [0.5, 0.5, 1.0];
        let channels = [0, 1, 2].map(|k| self.extremes(texture, k, AnyFormat::LinearRgba8));
        channels.iter().zip(FLAT).all(|([least, greatest], flat)| {
            least == greatest && (least - flat).abs() < 1.0 / 255.0
        })
    }

    fn extremes(&mut self, texture: &TextureUse, channel: usize, bytes: AnyFormat) -> [f32; 2] {
        let desc = &self.scene.textures[texture.texture];
        let extremes = self.images.extremes(self.scene, desc.image, channel, bytes);
        image_reading::with_border(extremes, desc.wrap)
    }

    fn dismiss_image(&mut self, texture: &TextureUse, reason: &str) {
        let name = &self.scene.images[self.scene.textures[texture.texture].image].name;
        self.dismiss(Effect::Textures, format!("image {name:?}: {reason}"));
    }

    /// One channel of a texture, linear.
    pub(super) fn channel(&mut self, texture: &TextureUse, channel: usize) -> ScalarNode {
        ScalarNode::Image(self.image(texture, channel as u32, AnyFormat::LinearRgba8))
    }

    /// A texture's red, green and blue, linear.
    pub(super) fn linear_texel(&mut self, texture: &TextureUse) -> ColorNode {
        ColorNode::Image(self.image(texture, 0, AnyFormat::LinearRgba8))
    }

    /// The texel of a map of normals.
    pub(super) fn normal_texel(&mut self, texture: &TextureUse) -> ColorNode {
        let mut image = self.image(texture, 0, AnyFormat::LinearRgba8);
        image.wrap = image_reading::wraps_of_normals(image.wrap);
        ColorNode::Image(image)
    }

    fn image(&mut self, texture: &TextureUse, channel: u32, bytes: AnyFormat) -> ImageNode {
        let desc = &self.scene.textures[texture.texture];
        let format = self.images.format(self.scene, desc.image, bytes);
        let wrap = desc.wrap.map(image_reading::wrap);
        let filter = image_reading::filter(desc.filter, self.textures, bytes);
        let (images, formats) = (&mut self.images, [bytes, format]);
        let image = images.param(self.scene, desc.image, formats, filter);
        let slot = self.param_record(image);
        let name = &self.scene.images[desc.image].name;
        self.image_names.insert(slot, name.clone());
        let transform = texture.transform.map(|matrix| {
            let [u, v] = matrix.map(Into::into);
            self.param_record(TransformParam { u, v })
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
