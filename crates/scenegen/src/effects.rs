//! Effects: what a scene calls for, and which material, light or camera calls for it.
//!
//! They are read off the plan, so the table cannot disagree with the program that is emitted from it.

use std::collections::BTreeMap;

use residual_render::bsdf::AnyInterface;
use residual_render::program::{
    AlphaTestNode, BsdfNode, CameraNode, ColorNode, FresnelNode, ImageNode, LayerFrameNode, Leaf,
    LightNode, Program, RoughnessNode, Source, SourceNode,
};
use residual_render::texture::{AnyFilter, AnyFormat, AnyWrap, UvMap};

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
        if structure.between.nests() {
            for body in plan
                .materials
                .iter()
                .flatten()
                .filter(|material| material.body)
            {
                effects.add(Effect::NestedBodies, &Caller::new(body).place);
            }
        }
        for (light, of_kind) in structure.lights.iter().zip(&plan.lights) {
            for source in &of_kind.sources {
                effects.add(light_effect(light), source);
            }
        }
        if structure.light_tree.is_some() {
            let lights: usize = plan.lights.iter().map(|kind| kind.count).sum();
            effects.add(Effect::LightTree, &format!("{lights} lights"));
        }
        let camera = format!("camera {:?}", plan.camera_name);
        effects.add(camera_effect(&structure.camera), &camera);
        if let Some(motion) = &plan.motion {
            let sources = motion.sources.clone();
            effects.reasons.insert(Effect::MotionBlur, sources);
        }
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
        if who.material.absorbs {
            self.add(Effect::Absorption, place);
        }
        if who.material.scatters {
            self.add(Effect::ScatteringMedia, place);
        }
        if program.disperses() {
            self.add(Effect::Dispersion, place);
        }
        if let Some(emission) = program.emission {
            self.add(Effect::EmittingSurfaces, place);
            let is_textured = match &program.inputs[emission.radiance.0].source {
                SourceNode::Color(ColorNode::UnderCoat { color, .. }) => {
                    self.add(Effect::CoatedEmission, place);
                    has_image(&**color)
                }
                source => has_image(source),
            };
            if is_textured {
                self.add(Effect::TexturedEmission, place);
            }
        }
        if let Some(test) = &program.alpha_test {
            self.add(alpha_effect(test), place);
        }
        for leaf in program.leaves() {
            match leaf {
                Leaf::Constant | Leaf::Parameter => {}
                Leaf::VertexColor => self.add(Effect::VertexColors, place),
                Leaf::Image(image) => self.add_image(image, who),
                Leaf::Coordinates(uv) => {
                    self.add(Effect::ProceduralTextures, place);
                    self.add_coordinates(uv, place);
                }
            }
        }
        self.add_bsdf(&program.bsdf, place);
    }

    fn add_bsdf(&mut self, node: &BsdfNode, place: &str) {
        if let BsdfNode::Coated { coat, base } = node {
            let (coat, normal) = match &**coat {
                BsdfNode::OwnNormal { bsdf, normal } => (&**bsdf, Some(normal)),
                coat => (coat, None),
            };
            if let Some(LayerFrameNode::MappedFrame { .. }) = normal {
                self.add(Effect::CoatNormalMaps, place);
            }
            self.add(coat_effect(coat, base), place);
            if let BsdfNode::Glossy { fresnel, roughness } = coat {
                self.add_facets(Some(fresnel), roughness, place);
            }
            return self.add_bsdf(base, place);
        }
        for child in node.children() {
            self.add_bsdf(child, place);
        }
        for effect in bsdf_effects(node) {
            self.add(*effect, place);
        }
        match node {
            BsdfNode::Glossy { fresnel, roughness } => {
                self.add_facets(Some(fresnel), roughness, place);
            }
            BsdfNode::RoughDielectric { roughness, .. }
            | BsdfNode::RoughSheet { roughness, .. } => {
                self.add_facets(None, roughness, place);
            }
            _ => {}
        }
    }

    fn add_facets(
        &mut self,
        fresnel: Option<&FresnelNode>,
        roughness: &RoughnessNode,
        place: &str,
    ) {
        if let Some(FresnelNode::ThinFilm { .. }) = fresnel {
            self.add(Effect::Iridescence, place);
        }
        match roughness {
            RoughnessNode::Isotropic { .. } => {}
            RoughnessNode::Anisotropic { .. } => self.add(Effect::Anisotropy, place),
        }
    }

    fn add_image(&mut self, image: &ImageNode, who: &Caller<'_>) {
        self.add(Effect::Textures, &who.image(image));
        for wrap in [image.wrap.0, image.wrap.1] {
            self.add(wrap_effect(wrap), &who.place);
        }
        self.add(filter_effect(image.filter), &who.place);
        self.add(format_effect(image.format), &who.place);
        self.add_coordinates(image.uv, &who.place);
    }

    fn add_coordinates(&mut self, uv: UvMap, place: &str) {
        if uv.transform.is_some() {
            self.add(Effect::TextureTransforms, place);
        }
        if uv.set == 1 {
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

/// What a coat is: on a matte surface the reflection of a dielectric, on others a clear coat.
fn coat_effect(coat: &BsdfNode, base: &BsdfNode) -> Effect {
    match coat {
        BsdfNode::Sheen { .. } => Effect::Sheen,
        _ if is_matte(base) => Effect::DielectricCoat,
        _ => Effect::ClearCoat,
    }
}

fn is_matte(bsdf: &BsdfNode) -> bool {
    match bsdf {
        BsdfNode::Black
        | BsdfNode::Diffuse { .. }
        | BsdfNode::RoughDiffuse { .. }
        | BsdfNode::DiffuseTransmission { .. } => true,
        BsdfNode::Mix { a, b, .. } => is_matte(a) && is_matte(b),
        _ => false,
    }
}

/// The effects of a BSDF itself, without those of the BSDFs that it combines and of its facets.
fn bsdf_effects(bsdf: &BsdfNode) -> &'static [Effect] {
    match bsdf {
        BsdfNode::Black => &[],
        BsdfNode::Diffuse { .. } => &[Effect::DiffuseReflection],
        BsdfNode::RoughDiffuse { .. } => &[Effect::RoughDiffuseReflection],
        BsdfNode::DiffuseTransmission { .. } => &[Effect::DiffuseTransmission],
        BsdfNode::Glossy { .. } => &[Effect::MetallicReflection],
        BsdfNode::Sheen { .. } => &[Effect::Sheen],
        BsdfNode::Coated { .. } | BsdfNode::OwnNormal { .. } => &[],
        BsdfNode::Dielectric { interface, .. } => match interface {
            AnyInterface::Solid | AnyInterface::SolidAmongSolids => &[Effect::Refraction],
            AnyInterface::Thin => &[Effect::ThinTransmission],
        },
        BsdfNode::RoughDielectric { .. } => &[Effect::Refraction, Effect::RoughTransmission],
        BsdfNode::RoughSheet { .. } => &[Effect::ThinTransmission, Effect::RoughTransmission],
        BsdfNode::Phong { .. } => &[Effect::PhongReflection],
        BsdfNode::Mirror { .. } => &[Effect::MirrorReflection],
        BsdfNode::Mix { .. } | BsdfNode::Sum { .. } => &[Effect::MixedLobes],
    }
}

fn alpha_effect(test: &AlphaTestNode) -> Effect {
    match test {
        AlphaTestNode::AlphaMask { .. } => Effect::AlphaMasks,
        AlphaTestNode::AlphaBlend { .. } => Effect::AlphaBlending,
    }
}

fn wrap_effect(wrap: AnyWrap) -> Effect {
    match wrap {
        AnyWrap::Repeat => Effect::RepeatWrap,
        AnyWrap::MirroredRepeat => Effect::MirrorWrap,
        AnyWrap::Clamp => Effect::ClampWrap,
        AnyWrap::WhiteBorder | AnyWrap::BlackBorder | AnyWrap::FlatBorder => Effect::BorderWrap,
    }
}

fn filter_effect(filter: AnyFilter) -> Effect {
    match filter {
        AnyFilter::Nearest => Effect::NearestFilter,
        AnyFilter::Bilinear => Effect::BilinearFilter,
        AnyFilter::Trilinear => Effect::Mipmaps,
    }
}

fn format_effect(format: AnyFormat) -> Effect {
    match format {
        AnyFormat::SrgbRgba8 => Effect::SrgbTexels,
        AnyFormat::LinearRgba8 => Effect::LinearTexels,
        AnyFormat::LinearHalf => Effect::HalfTexels,
        AnyFormat::LinearFloat => Effect::FloatTexels,
    }
}

fn light_effect(light: &LightNode) -> Effect {
    match light {
        LightNode::Area { .. } => Effect::EmittingSurfaces,
        LightNode::AreaBySolidAngle { .. } => Effect::SolidAngleSampling,
        LightNode::Point => Effect::PointLights,
        LightNode::Spot => Effect::SpotLights,
        LightNode::Directional => Effect::DirectionalLights,
        LightNode::SphericalPoint => Effect::SphericalPointLights,
        LightNode::SphericalSpot => Effect::SphericalSpotLights,
        LightNode::Sun => Effect::Suns,
        LightNode::Environment => Effect::Environment,
    }
}

fn camera_effect(camera: &CameraNode) -> Effect {
    match camera {
        CameraNode::Perspective => Effect::PerspectiveCamera,
        CameraNode::ThinLens => Effect::DepthOfField,
        CameraNode::Orthographic => Effect::OrthographicCamera,
        CameraNode::Panorama => Effect::PanoramicCamera,
    }
}

fn has_image(source: &impl Source) -> bool {
    let leaves = source.leaves();
    leaves.iter().any(|leaf| matches!(leaf, Leaf::Image(_)))
}
