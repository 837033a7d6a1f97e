//! Effects: what a scene calls for, and which material, light or camera calls for it.
//!
//! They are read off the plan, so the table cannot disagree with the program that is emitted from it.

use std::collections::BTreeMap;
use std::fmt;

use residual_render::alpha::AlphaTest;
use residual_render::camera::AnyCamera;
use residual_render::program::{
    BsdfNode, ColorNode, Culling, ImageNode, LightNode, Program, ScalarNode, SourceNode,
};
use residual_render::texture::{AnyFilter, AnyFormat, AnyWrap};

use crate::plan::Plan;

macro_rules! effects {
    ($($(#[doc = $doc:literal])* $name:ident = $text:literal,)*) => {
        /// Something a renderer can simulate.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Effect {
            $(#[doc = $text] $name,)*
        }

        impl Effect {
            /// All effects.
            pub const ALL: &[Self] = &[$(Self::$name,)*];
        }

        impl fmt::Display for Effect {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(match self { $(Self::$name => $text,)* })
            }
        }
    };
}

effects! {
    DiffuseReflection = "diffuse reflection",
    GlossyCoat = "glossy coat",
    MetallicReflection = "metallic reflection",
    PhongReflection = "Phong reflection",
    ThinTransmission = "thin transmission",
    Refraction = "refraction",
    MixedLobes = "mixed lobes",
    Textures = "textures",
    NearestFilter = "nearest filter",
    BilinearFilter = "bilinear filter",
    RepeatWrap = "repeat wrap",
    MirrorWrap = "mirror wrap",
    ClampWrap = "clamp wrap",
    SrgbTexels = "sRGB texels",
    LinearTexels = "linear texels",
    FloatTexels = "float texels",
    TextureTransforms = "texture transforms",
    SecondUvSet = "second UV set",
    VertexColors = "vertex colours",
    SmoothNormals = "smooth normals",
    NormalMaps = "normal maps",
    AlphaMasks = "alpha masks",
    AlphaBlending = "alpha blending",
    BackFaceCulling = "back-face culling",
    EmittingSurfaces = "emitting surfaces",
    TexturedEmission = "textured emission",
    PointLights = "point lights",
    SpotLights = "spot lights",
    DirectionalLights = "directional lights",
    Environment = "environment",
    PerspectiveCamera = "perspective camera",
    OrthographicCamera = "orthographic camera",
}

/// The effects that are in, each with those that call for it.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Effects {
    reasons: BTreeMap<Effect, Vec<String>>,
}

impl Effects {
    /// The effects of a plan.
    pub fn of(plan: &Plan) -> Self {
        let mut effects = Self::default();
        let structure = &plan.structure;
        for (program, names) in structure.programs.iter().zip(&plan.materials) {
            effects.add_program(program, &names.join(", "));
        }
        for (light, count) in structure.lights.iter().zip(&plan.light_counts) {
            effects.add_light(light, &format!("lights ({count})"));
        }
        match structure.culling {
            Culling::None => {}
            Culling::Back => effects.add(Effect::BackFaceCulling, "all triangles"),
            Culling::PerTriangle => effects.add(Effect::BackFaceCulling, "some triangles"),
        }
        let camera = format!("camera {:?}", plan.camera_name);
        effects.add(
            match structure.camera {
                AnyCamera::Perspective => Effect::PerspectiveCamera,
                AnyCamera::Orthographic => Effect::OrthographicCamera,
            },
            &camera,
        );
        effects
    }

    /// Who calls for an effect; empty where it is out.
    pub fn reasons(&self, effect: Effect) -> &[String] {
        self.reasons.get(&effect).map_or(&[], Vec::as_slice)
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

    fn add_program(&mut self, program: &Program, who: &str) {
        if program.attributes.normals {
            self.add(Effect::SmoothNormals, who);
        }
        if program.normal.is_some() {
            self.add(Effect::NormalMaps, who);
        }
        if let Some(emission) = program.emission {
            self.add(Effect::EmittingSurfaces, who);
            if matches!(&program.inputs[emission.radiance.0].source, SourceNode::Color(node) if has_image(node))
            {
                self.add(Effect::TexturedEmission, who);
            }
        }
        if let Some(alpha) = &program.alpha {
            self.add_scalar(&alpha.alpha, who);
            self.add(
                match alpha.test {
                    AlphaTest::Mask(_) => Effect::AlphaMasks,
                    AlphaTest::Blend => Effect::AlphaBlending,
                },
                who,
            );
        }
        for input in &program.inputs {
            match &input.source {
                SourceNode::Color(node) => self.add_color(node, who),
                SourceNode::Scalar(node) => self.add_scalar(node, who),
            }
        }
        self.add_bsdf(&program.bsdf, who);
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

    fn add_color(&mut self, node: &ColorNode, who: &str) {
        match node {
            ColorNode::Const(_) | ColorNode::Param(_) => {}
            ColorNode::VertexColor => self.add(Effect::VertexColors, who),
            ColorNode::Image(image) => self.add_image(image, who),
            ColorNode::Gray(node) => self.add_scalar(node, who),
            ColorNode::Product(a, b) => {
                self.add_color(a, who);
                self.add_color(b, who);
            }
        }
    }

    fn add_scalar(&mut self, node: &ScalarNode, who: &str) {
        match node {
            ScalarNode::Const(_) | ScalarNode::Param(_) => {}
            ScalarNode::VertexAlpha => self.add(Effect::VertexColors, who),
            ScalarNode::Image(image) => self.add_image(image, who),
            ScalarNode::Product(a, b) => {
                self.add_scalar(a, who);
                self.add_scalar(b, who);
            }
        }
    }

    fn add_image(&mut self, image: &ImageNode, who: &str) {
        self.add(Effect::Textures, who);
        for wrap in [image.wrap.0, image.wrap.1] {
            self.add(
                match wrap {
                    AnyWrap::Repeat => Effect::RepeatWrap,
                    AnyWrap::Mirror => Effect::MirrorWrap,
                    AnyWrap::Clamp => Effect::ClampWrap,
                },
                who,
            );
        }
        self.add(
            match image.filter {
                AnyFilter::Nearest => Effect::NearestFilter,
                AnyFilter::Bilinear => Effect::BilinearFilter,
            },
            who,
        );
        self.add(
            match image.format {
                AnyFormat::SrgbRgba8 => Effect::SrgbTexels,
                AnyFormat::LinearRgba8 => Effect::LinearTexels,
                AnyFormat::LinearFloat => Effect::FloatTexels,
            },
            who,
        );
        if image.uv.transform.is_some() {
            self.add(Effect::TextureTransforms, who);
        }
        if image.uv.set == 1 {
            self.add(Effect::SecondUvSet, who);
        }
    }

    fn add_light(&mut self, light: &LightNode, who: &str) {
        let effect = match light {
            LightNode::Area { .. } => Effect::EmittingSurfaces,
            LightNode::Point => Effect::PointLights,
            LightNode::Spot => Effect::SpotLights,
            LightNode::Directional => Effect::DirectionalLights,
            LightNode::Environment => Effect::Environment,
        };
        self.add(effect, who);
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
