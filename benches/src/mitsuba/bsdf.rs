//! Programs of materials as Mitsuba's BSDFs.

use residual_render::bsdf::AnyInterface;
use residual_render::program::{
    BsdfNode, ColorNode, FresnelNode, Program, RoughnessNode, ScalarNode, SourceNode,
};
use residual_render::texture::Input;

use super::xml::Element;

/// The BSDF of a program whose numbers are constants.
///
/// # Errors
/// What of it has no counterpart.
pub(super) fn bsdf(program: &Program) -> Result<Element, String> {
    if program.alpha_test.is_some() {
        return Err("alpha".to_owned());
    }
    if program.normal.is_some() {
        return Err("a normal map".to_owned());
    }
    Inputs(program).bsdf(&program.bsdf)
}

/// The radiance that both sides or, as Mitsuba has it, only the front of a surface emits; `None` if there is none.
///
/// # Errors
/// What of it has no counterpart.
pub(super) fn emission(program: &Program) -> Result<Option<[f32; 3]>, String> {
    let Some(emission) = program.emission else {
        return Ok(None);
    };
    if emission.double_sided {
        return Err("emission from both sides".to_owned());
    }
    Inputs(program).color(emission.radiance).map(Some)
}

struct Inputs<'a>(&'a Program);

impl Inputs<'_> {
    fn color(&self, Input(index): Input) -> Result<[f32; 3], String> {
        let input = &self.0.inputs[index];
        match &input.source {
            SourceNode::Color(ColorNode::Const(value)) => Ok(*value),
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
    fn fresnel(&self, node: &FresnelNode) -> Result<([f32; 3], f32), String> {
        match node {
            FresnelNode::Schlick { normal, grazing } => {
                Ok((self.color(*normal)?, self.number(*grazing)?))
            }
            FresnelNode::ThinFilm { .. } => Err("a thin film".to_owned()),
        }
    }

    fn roughness(&self, node: &RoughnessNode) -> Result<f32, String> {
        match node {
            RoughnessNode::Isotropic { roughness } => self.number(*roughness),
            RoughnessNode::Anisotropic { .. } => Err("anisotropy".to_owned()),
        }
    }

    fn bsdf(&self, node: &BsdfNode) -> Result<Element, String> {
        match node {
            BsdfNode::Black => Ok(both_sides(diffuse([0.0; 3]))),
            BsdfNode::Diffuse { albedo } => Ok(both_sides(diffuse(self.color(*albedo)?))),
            BsdfNode::Mirror { reflectance } => {
                let mirror = Element::plugin("bsdf", "conductor").string("material", "none");
                let reflectance = self.color(*reflectance)?;
                Ok(both_sides(mirror.rgb("specular_reflectance", reflectance)))
            }
            // Fresnel as Schlick has it, GGX with α = roughness², visible normals: the same formulas, but for what facets
            // throw at one another.
            BsdfNode::Glossy { fresnel, roughness } => {
                let (color, _) = self.fresnel(fresnel)?;
                Ok(both_sides(
                    Element::plugin("bsdf", "principled")
                        .rgb("base_color", color)
                        .float("roughness", self.roughness(roughness)?)
                        .float("metallic", 1),
                ))
            }
            BsdfNode::Coated { coat, base } => match (&**coat, &**base) {
                (BsdfNode::Glossy { fresnel, roughness }, BsdfNode::Diffuse { albedo }) => {
                    let ([r, g, b], grazing) = self.fresnel(fresnel)?;
                    if r != g || g != b || grazing != 1.0 {
                        return Err("a tinted or weakened coat".to_owned());
                    }
                    // Disney's coat and base are close to ours, but not the same: Fresnel's formula instead of Schlick's,
                    // and a base that throws some light back at grazing angles. Specular 1 reflects 8 %.
                    Ok(both_sides(
                        Element::plugin("bsdf", "principled")
                            .rgb("base_color", self.color(*albedo)?)
                            .float("roughness", self.roughness(roughness)?)
                            .float("specular", r / 0.08),
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
                .rgb("specular_transmittance", self.color(*transmittance)?)),
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
                .rgb("specular_transmittance", self.color(*transmittance)?)),
            BsdfNode::RoughDiffuse { .. } => Err("rough diffuse reflection".to_owned()),
            BsdfNode::DiffuseTransmission { .. } => Err("diffuse transmission".to_owned()),
            BsdfNode::Sheen { .. } => Err("sheen".to_owned()),
            BsdfNode::OwnNormal { .. } => Err("a coat with its own normals".to_owned()),
            BsdfNode::Phong { .. } => Err("a Phong lobe".to_owned()),
            BsdfNode::Mix { .. } | BsdfNode::Sum { .. } => Err("a mix of lobes".to_owned()),
        }
    }
}

fn diffuse(reflectance: [f32; 3]) -> Element {
    Element::plugin("bsdf", "diffuse").rgb("reflectance", reflectance)
}

/// Ours scatter on both sides, Mitsuba's on the front unless they are told.
fn both_sides(bsdf: Element) -> Element {
    Element::plugin("bsdf", "twosided").child(bsdf)
}
