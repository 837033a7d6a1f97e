//! Programs of materials as Mitsuba's BSDFs.

use residual_render::bsdf::AnyInterface;
use residual_render::program::{
    BsdfNode, ColorNode, FresnelNode, ImageNode, Program, RoughnessNode, ScalarNode, SourceNode,
};
use residual_render::texture::Input;

use super::coat::albedos;
use super::opacity::masked;
use super::shapes::has_two_uv_sets;
use super::textures::Textures;
use super::xml::Element;

/// The BSDF of a program whose numbers are constants, and its test of alpha.
///
/// # Errors
/// What of it has no counterpart.
pub(super) fn bsdf(program: &Program, textures: &mut Textures<'_>) -> Result<Element, String> {
    if program.normal.is_some() {
        return Err("a normal map".to_owned());
    }
    if has_two_uv_sets(program) {
        return Err("textures over two sets of coordinates".to_owned());
    }
    let bsdf = Inputs(program).bsdf(&program.bsdf, textures)?;
    match &program.alpha_test {
        Some(test) => masked(bsdf, test, textures),
        None => Ok(bsdf),
    }
}

/// The radiance that a surface emits; `None` if there is none.
///
/// # Errors
/// What of it has no counterpart.
pub(super) fn emission(program: &Program) -> Result<Option<[f32; 3]>, String> {
    let Some(emission) = program.emission else {
        return Ok(None);
    };
    Inputs(program).constant(emission.radiance).map(Some)
}

/// Mitsuba's facets are no smoother.
const LEAST_ALPHA: f32 = 1e-4;

struct Inputs<'a>(&'a Program);

impl Inputs<'_> {
    /// A colour of a BSDF under the name that it has there.
    fn color(
        &self,
        name: &str,
        Input(index): Input,
        textures: &mut Textures<'_>,
    ) -> Result<Element, String> {
        let input = &self.0.inputs[index];
        match &input.source {
            SourceNode::Color(ColorNode::Const(value)) => Ok(Element::color(name, *value)),
            SourceNode::Color(node) if let Some((factor, image)) = factor_and_image(node) => {
                textures.color(name, factor, image)
            }
            _ => Err(format!("vertex colours or more for {:?}", input.name)),
        }
    }

    fn constant(&self, Input(index): Input) -> Result<[f32; 3], String> {
        let input = &self.0.inputs[index];
        match &input.source {
            SourceNode::Color(ColorNode::Const(value)) => Ok(*value),
            SourceNode::Color(ColorNode::UnderCoat { .. }) => {
                Err("emission under a clear coat".to_owned())
            }
            _ => Err(format!("a texture or vertex colours for {:?}", input.name)),
        }
    }

    fn number(&self, Input(index): Input) -> Result<f32, String> {
        let input = &self.0.inputs[index];
        match &input.source {
            SourceNode::Scalar(ScalarNode::Const(value)) => Ok(*value),
            _ => Err(format!("a texture or vertex colours for {:?}", input.name)),
        }
    }

    /// Reflectance at normal and at grazing incidence.
    fn fresnel(&self, node: &FresnelNode) -> Result<(Input, f32), String> {
        match node {
            FresnelNode::Schlick { normal, grazing } => Ok((*normal, self.number(*grazing)?)),
            FresnelNode::ThinFilm { .. } => Err("a thin film".to_owned()),
        }
    }

    fn roughness(&self, node: &RoughnessNode) -> Result<f32, String> {
        match node {
            RoughnessNode::Isotropic { roughness } => self.number(*roughness),
            RoughnessNode::Anisotropic { .. } => Err("anisotropy".to_owned()),
        }
    }

    fn bsdf(&self, node: &BsdfNode, textures: &mut Textures<'_>) -> Result<Element, String> {
        let mut color = |name: &str, input: &Input| self.color(name, *input, textures);
        match node {
            BsdfNode::Black => Ok(both_sides(diffuse(Element::color("reflectance", [0.0; 3])))),
            BsdfNode::Diffuse { albedo } => Ok(both_sides(diffuse(color("reflectance", albedo)?))),
            BsdfNode::Mirror { reflectance } => {
                let mirror = Element::plugin("bsdf", "conductor").string("material", "none");
                let reflectance = color("specular_reflectance", reflectance)?;
                Ok(both_sides(mirror.child(reflectance)))
            }
            // Fresnel as Schlick has it, GGX with α = roughness², visible normals: the same formulas, but for what facets
            // throw at one another.
            BsdfNode::Glossy { fresnel, roughness } => {
                let (normal, _) = self.fresnel(fresnel)?;
                Ok(both_sides(
                    Element::plugin("bsdf", "principled")
                        .child(color("base_color", &normal)?)
                        .float("roughness", self.roughness(roughness)?)
                        .float("metallic", 1),
                ))
            }
            BsdfNode::Coated { coat, base } => match (&**coat, &**base) {
                (BsdfNode::Glossy { fresnel, roughness }, BsdfNode::Diffuse { albedo }) => {
                    let (normal, grazing) = self.fresnel(fresnel)?;
                    let [r, g, b] = self.constant(normal)?;
                    if r != g || g != b || grazing != 1.0 {
                        return Err("a tinted or weakened coat".to_owned());
                    }
                    let base = color("base_color", albedo)?;
                    Ok(both_sides(
                        Element::plugin("bsdf", "coat")
                            .child(base)
                            .float("alpha", self.roughness(roughness)?.powi(2).max(LEAST_ALPHA))
                            .float("normal", r)
                            .string("albedo", &albedos(self.0, coat, textures.point())),
                    ))
                }
                _ => Err("a coat on what is not matte".to_owned()),
            },
            BsdfNode::Dielectric {
                transmittance,
                ior,
                interface: AnyInterface::Solid,
            } => Ok(Element::plugin("bsdf", "dielectric")
                .float("int_ior", self.number(*ior)?)
                .float("ext_ior", 1)
                .child(color("specular_transmittance", transmittance)?)),
            BsdfNode::Dielectric {
                interface: AnyInterface::Thin,
                ..
            }
            | BsdfNode::RoughSheet { .. } => Err("a thin dielectric".to_owned()),
            BsdfNode::Dielectric {
                interface: AnyInterface::SolidAmongSolids,
                ..
            }
            | BsdfNode::RoughDielectric {
                interface: AnyInterface::SolidAmongSolids,
                ..
            } => Err("a body within another".to_owned()),
            BsdfNode::RoughDielectric {
                transmittance,
                ior,
                roughness,
                interface: _,
                albedos: _,
            } => Ok(Element::plugin("bsdf", "roughdielectric")
                .string("distribution", "ggx")
                .float("alpha", self.roughness(roughness)?.powi(2))
                .float("int_ior", self.number(*ior)?)
                .float("ext_ior", 1)
                .child(color("specular_transmittance", transmittance)?)),
            BsdfNode::RoughDiffuse { .. } => Err("rough diffuse reflection".to_owned()),
            BsdfNode::DiffuseTransmission { .. } => Err("diffuse transmission".to_owned()),
            BsdfNode::Sheen { .. } => Err("sheen".to_owned()),
            BsdfNode::OwnNormal { .. } => Err("a coat with its own normals".to_owned()),
            BsdfNode::Phong { .. } => Err("a Phong lobe".to_owned()),
            BsdfNode::Mix { .. } | BsdfNode::Sum { .. } => Err("a mix of lobes".to_owned()),
        }
    }
}

fn factor_and_image(node: &ColorNode) -> Option<([f32; 3], &ImageNode)> {
    match node {
        ColorNode::Image(image) => Some(([1.0; 3], image)),
        ColorNode::Product(factor, image) => match (&**factor, &**image) {
            (ColorNode::Const(factor), ColorNode::Image(image)) => Some((*factor, image)),
            _ => None,
        },
        _ => None,
    }
}

fn diffuse(reflectance: Element) -> Element {
    Element::plugin("bsdf", "diffuse").child(reflectance)
}

/// Ours scatter on both sides, Mitsuba's on the front unless they are told.
fn both_sides(bsdf: Element) -> Element {
    Element::plugin("bsdf", "twosided").child(bsdf)
}
