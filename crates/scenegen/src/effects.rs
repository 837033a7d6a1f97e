//! Effects: what a scene calls for, and which material, light or camera calls for it.
//!
//! They are read off the plan, so the table cannot disagree with the program that is emitted from it.

use std::collections::BTreeMap;

use residual_render::alpha::AlphaTest;
use residual_render::camera::AnyCamera;
use residual_render::program::{
    BsdfNode, ColorNode, ImageNode, LightNode, Program, ScalarNode, SourceNode,
};
use residual_render::texture::{AnyFilter, AnyFormat, AnyWrap};

use crate::plan::{MaterialUse, Plan};

pub use crate::effect::Effect;

/// The effects that are in, each with those that call for it.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Effects {
    reasons: BTreeMap<Effect, Vec<String>>,
    dismissed: BTreeMap<Effect, Vec<String>>,
}

impl Effects {
    /// The effects of a plan.
    pub fn of(plan: &Plan) -> Self {
        let mut effects = Self::default();
        let structure = &plan.structure;
        for (program, materials) in structure.programs.iter().zip(&plan.materials) {
            for material in materials {
                effects.add_program(program, &Caller::new(material));
            }
        }
        for (light, of_kind) in structure.lights.iter().zip(&plan.lights) {
            for source in &of_kind.sources {
                effects.add(light_effect(light), source);
            }
        }
        let camera = match structure.camera {
            AnyCamera::Perspective => Effect::PerspectiveCamera,
            AnyCamera::Orthographic => Effect::OrthographicCamera,
        };
        effects.add(camera, &format!("camera {:?}", plan.camera_name));
        for dismissed in &plan.dismissed {
            if let Some(effect) = dismissed.effect {
                let reasons = effects.dismissed.entry(effect).or_default();
                reasons.push(format!("{}: {}", dismissed.place, dismissed.reason));
            }
        }
        effects
    }

    /// Who calls for an effect; empty where it is out.
    pub fn reasons(&self, effect: Effect) -> &[String] {
        self.reasons.get(&effect).map_or(&[], Vec::as_slice)
    }

    /// Who seems to call for an effect, and why it would change nothing there.
    pub fn dismissed(&self, effect: Effect) -> &[String] {
        self.dismissed.get(&effect).map_or(&[], Vec::as_slice)
    }

    /// Whether an effect is in.
    pub fn has(&self, effect: Effect) -> bool {
        self.reasons.contains_key(&effect)
    }

    /// The effects that are in.
    pub fn iter(&self) -> impl Iterator<Item = Effect> {
        self.reasons.keys().copied()
    }

    fn add(&mut self, effect: Effect, reason: &str) {
        let reasons = self.reasons.entry(effect).or_default();
        if !reasons.iter().any(|other| other == reason) {
            reasons.push(reason.to_owned());
        }
    }

    fn add_program(&mut self, program: &Program, who: &Caller<'_>) {
        let place = &who.place;
        if program.attributes.normals {
            self.add(Effect::SmoothNormals, place);
        }
        if program.normal.is_some() {
            self.add(Effect::NormalMaps, place);
        }
        if who.material.culled {
            self.add(Effect::BackFaceCulling, place);
        }
        if let Some(emission) = program.emission {
            self.add(Effect::EmittingSurfaces, place);
            if matches!(&program.inputs[emission.radiance.0].source, SourceNode::Color(node) if has_image(node))
            {
                self.add(Effect::TexturedEmission, place);
            }
        }
        if let Some(alpha) = &program.alpha {
            self.add_scalar(&alpha.alpha, who);
            self.add(
                match alpha.test {
                    AlphaTest::Mask(_) => Effect::AlphaMasks,
                    AlphaTest::Blend => Effect::AlphaBlending,
                },
                place,
            );
        }
        for input in &program.inputs {
            match &input.source {
                SourceNode::Color(node) => self.add_color(node, who),
                SourceNode::Scalar(node) => self.add_scalar(node, who),
            }
        }
        self.add_bsdf(&program.bsdf, place);
    }

    fn add_bsdf(&mut self, node: &BsdfNode, who: &str) {
        let effect = match node {
            BsdfNode::Black => return,
            BsdfNode::Diffuse { .. } => Effect::DiffuseReflection,
            BsdfNode::Conductor { .. } => Effect::MetallicReflection,
            BsdfNode::Glossy { .. } => {
                self.add(Effect::DiffuseReflection, who);
                Effect::GlossyCoat
            }
            BsdfNode::Dielectric { solid: true, .. } => Effect::Refraction,
            BsdfNode::Dielectric { solid: false, .. } => Effect::ThinTransmission,
            BsdfNode::Phong { .. } => Effect::PhongReflection,
            BsdfNode::Mix { a, b, .. } | BsdfNode::Sum { a, b, .. } => {
                self.add_bsdf(a, who);
                self.add_bsdf(b, who);
                Effect::MixedLobes
            }
        };
        self.add(effect, who);
    }

    fn add_color(&mut self, node: &ColorNode, who: &Caller<'_>) {
        match node {
            ColorNode::Const(_) | ColorNode::Param(_) => {}
            ColorNode::VertexColor => self.add(Effect::VertexColors, &who.place),
            ColorNode::Image(image) => self.add_image(image, who),
            ColorNode::Gray(node) => self.add_scalar(node, who),
            ColorNode::Product(a, b) => {
                self.add_color(a, who);
                self.add_color(b, who);
            }
        }
    }

    fn add_scalar(&mut self, node: &ScalarNode, who: &Caller<'_>) {
        match node {
            ScalarNode::Const(_) | ScalarNode::Param(_) => {}
            ScalarNode::VertexAlpha => self.add(Effect::VertexColors, &who.place),
            ScalarNode::Image(image) => self.add_image(image, who),
            ScalarNode::Product(a, b) => {
                self.add_scalar(a, who);
                self.add_scalar(b, who);
            }
        }
    }

    fn add_image(&mut self, image: &ImageNode, who: &Caller<'_>) {
        let place = &who.place;
        self.add(Effect::Textures, &who.image(image));
        for wrap in [image.wrap.0, image.wrap.1] {
            self.add(
                match wrap {
                    AnyWrap::Repeat => Effect::RepeatWrap,
                    AnyWrap::Mirror => Effect::MirrorWrap,
                    AnyWrap::Clamp => Effect::ClampWrap,
                },
                place,
            );
        }
        self.add(
            match image.filter {
                AnyFilter::Nearest => Effect::NearestFilter,
                AnyFilter::Bilinear => Effect::BilinearFilter,
            },
            place,
        );
        self.add(
            match image.format {
                AnyFormat::SrgbRgba8 => Effect::SrgbTexels,
                AnyFormat::LinearRgba8 => Effect::LinearTexels,
                AnyFormat::LinearFloat => Effect::FloatTexels,
            },
            place,
        );
        if image.uv.transform.is_some() {
            self.add(Effect::TextureTransforms, place);
        }
        if image.uv.set == 1 {
            self.add(Effect::SecondUvSet, place);
        }
    }
}

/// A material, as a reason.
struct Caller<'a> {
    material: &'a MaterialUse,
    place: String,
}

impl<'a> Caller<'a> {
    fn new(material: &'a MaterialUse) -> Self {
        Self {
            material,
            place: format!("material {:?}", material.name),
        }
    }

    /// One of its images.
    fn image(&self, image: &ImageNode) -> String {
        let name = self.material.images.get(&image.slot);
        format!(
            "{}, image {:?}",
            self.place,
            name.map_or("", String::as_str)
        )
    }
}

fn light_effect(light: &LightNode) -> Effect {
    match light {
        LightNode::Area { .. } => Effect::EmittingSurfaces,
        LightNode::Point => Effect::PointLights,
        LightNode::Spot => Effect::SpotLights,
        LightNode::Directional => Effect::DirectionalLights,
        LightNode::Environment => Effect::Environment,
    }
}

fn has_image(node: &ColorNode) -> bool {
    match node {
        ColorNode::Image(_) => true,
        ColorNode::Product(a, b) => has_image(a) || has_image(b),
        ColorNode::Const(_) | ColorNode::Param(_) | ColorNode::VertexColor | ColorNode::Gray(_) => {
            false
        }
    }
}
