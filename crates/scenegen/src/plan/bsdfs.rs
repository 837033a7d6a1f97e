//! Surfaces to BSDFs: which lobes a description calls for, and which of them its inputs leave nothing of.

use residual_render::bsdf::AnyInterface;
use residual_render::program::{BsdfNode, ColorNode, ScalarNode};

use super::program::{Builder, is_black};
use crate::desc::{ColorInput, MetallicRoughness, PhongSurface, SurfaceDesc, Warning, WarningKind};
use crate::effect::Effect;

impl Builder<'_> {
    /// The BSDF of a surface.
    pub(super) fn bsdf(&mut self, surface: &SurfaceDesc) -> BsdfNode {
        match surface {
            SurfaceDesc::MetallicRoughness(surface) => self.metallic_roughness(surface),
            SurfaceDesc::Phong(surface) => self.phong(surface),
            SurfaceDesc::Mirror {
                diffuse,
                reflectance,
            } => self.mirror(diffuse, reflectance),
            SurfaceDesc::Checkerboard { even, odd, squares } => {
                let albedo = self.sources.checkerboard(even, odd, *squares);
                self.diffuse(albedo)
            }
            SurfaceDesc::Unlit => BsdfNode::Black,
            SurfaceDesc::Dielectric { ior, transmittance } => {
                let tint = self.sources.constant_color(*transmittance);
                self.dielectric(tint, *ior, AnyInterface::Solid)
            }
        }
    }

    fn diffuse(&mut self, albedo: ColorNode) -> BsdfNode {
        if is_black(&albedo) {
            return BsdfNode::Black;
        }
        BsdfNode::Diffuse {
            albedo: self.color("albedo", albedo),
        }
    }

    fn dielectric(&mut self, tint: ColorNode, ior: f32, interface: AnyInterface) -> BsdfNode {
        let ior = self.sources.number(ior);
        BsdfNode::Dielectric {
            transmittance: self.color("transmittance", tint),
            ior: self.scalar("ior", ior),
            interface,
        }
    }

    /// glTF 2.0, appendix B.3.5: `mix(dielectric, metal, metallic)`.
    fn metallic_roughness(&mut self, surface: &MetallicRoughness) -> BsdfNode {
        let base = self.sources.tinted_color(&surface.base_color);
        let metallic = self.sources.scalar(&surface.metallic);
        if metallic == ScalarNode::Const(0.0) {
            return self.dielectric_part(surface, base);
        }
        let roughness = self.sources.scalar(&surface.roughness);
        let metal = BsdfNode::Conductor {
            color: self.color("albedo", base.clone()),
            roughness: self.scalar("roughness", roughness),
        };
        if metallic == ScalarNode::Const(1.0) {
            return metal;
        }
        BsdfNode::Mix {
            a: Box::new(self.dielectric_part(surface, base)),
            b: Box::new(metal),
            weight: self.scalar("metallic", metallic),
        }
    }

    /// `mix(opaque, transmitting, transmission)` under the same coat.
    fn dielectric_part(&mut self, surface: &MetallicRoughness, base: ColorNode) -> BsdfNode {
        let interface = match surface.solid || self.encloses {
            true => AnyInterface::Solid,
            false => AnyInterface::Thin,
        };
        let transmission = self.sources.scalar(&surface.transmission);
        if surface.transmission.factor > 0.0
            && let Some(reason) = opaque(&transmission, &base)
        {
            let effect = match interface {
                AnyInterface::Solid => Effect::Refraction,
                AnyInterface::Thin => Effect::ThinTransmission,
            };
            self.sources.dismiss(effect, reason);
            return self.opaque_dielectric(surface, base);
        }
        if transmission == ScalarNode::Const(0.0) {
            return self.opaque_dielectric(surface, base);
        }
        if self.sources.known(&surface.roughness) != Some(0.0) {
            self.warnings.push(Warning {
                kind: WarningKind::Unfaithful,
                place: format!("material {:?}", self.name),
                message: "KHR_materials_transmission on a rough surface is rendered as if smooth"
                    .to_owned(),
            });
        }
        let clear = self.dielectric(base.clone(), surface.ior, interface);
        if transmission == ScalarNode::Const(1.0) {
            return clear;
        }
        BsdfNode::Mix {
            a: Box::new(self.opaque_dielectric(surface, base)),
            b: Box::new(clear),
            weight: self.scalar("transmission", transmission),
        }
    }

    /// A diffuse base under a coat, or without one where the coat reflects nothing.
    fn opaque_dielectric(&mut self, surface: &MetallicRoughness, albedo: ColorNode) -> BsdfNode {
        // KHR_materials_specular and KHR_materials_ior: F0 = min(((η−1)/(η+1))²·colour, 1)·strength, F90 = strength.
        let grazing = self.sources.scalar(&surface.specular);
        let strength = self.sources.known(&surface.specular);
        let normal_incidence = ((surface.ior - 1.0) / (surface.ior + 1.0)).powi(2);
        let mut at_normal = surface.specular_color.clone();
        at_normal.factor = at_normal
            .factor
            .map(|c| (c * normal_incidence).min(1.0) * strength.unwrap_or(surface.specular.factor));
        let reflectance = self.sources.color(&at_normal);
        if grazing == ScalarNode::Const(0.0) || (is_black(&reflectance) && surface.ior == 1.0) {
            return self.diffuse(albedo);
        }
        let reflectance = match &surface.specular.texture {
            Some((texture, channel)) if strength.is_none() => {
                let strength = ColorNode::Gray(Box::new(self.sources.channel(texture, *channel)));
                self.sources.color_product(reflectance, strength)
            }
            _ => reflectance,
        };
        let roughness = self.sources.scalar(&surface.roughness);
        BsdfNode::CoatedDiffuse {
            albedo: self.color("albedo", albedo),
            roughness: self.scalar("roughness", roughness),
            reflectance: self.color("reflectance", reflectance),
            grazing: self.scalar("grazing_reflectance", grazing),
        }
    }

    fn phong(&mut self, surface: &PhongSurface) -> BsdfNode {
        let albedo = self.sources.tinted_color(&surface.diffuse);
        let specular = self.sources.color(&surface.specular);
        let diffuse = self.diffuse(albedo);
        if is_black(&specular) {
            return diffuse;
        }
        let exponent = self.sources.scalar(&surface.exponent);
        let lobe = BsdfNode::Phong {
            color: self.color("specular", specular),
            exponent: self.scalar("exponent", exponent),
        };
        self.sum(diffuse, lobe, &surface.diffuse, &surface.specular)
    }

    fn mirror(&mut self, diffuse: &ColorInput, reflectance: &ColorInput) -> BsdfNode {
        let albedo = self.sources.tinted_color(diffuse);
        let color = self.sources.color(reflectance);
        let base = self.diffuse(albedo);
        if is_black(&color) {
            return base;
        }
        let lobe = BsdfNode::Mirror {
            reflectance: self.color("reflectance", color),
        };
        self.sum(base, lobe, diffuse, reflectance)
    }

    /// A lobe added to a diffuse one, which is sampled in proportion to their colours.
    fn sum(
        &mut self,
        diffuse: BsdfNode,
        lobe: BsdfNode,
        albedo: &ColorInput,
        specular: &ColorInput,
    ) -> BsdfNode {
        if diffuse == BsdfNode::Black {
            return lobe;
        }
        let [albedo, specular] = [albedo, specular].map(|input| input.factor.iter().sum::<f32>());
        let share = specular / (specular + albedo);
        let probability = self.sources.number(share.clamp(0.1, 0.9));
        BsdfNode::Sum {
            a: Box::new(diffuse),
            b: Box::new(lobe),
            probability: self.scalar("specular_probability", probability),
        }
    }
}

/// Why nothing is seen through a dielectric, if nothing is.
fn opaque(transmission: &ScalarNode, tint: &ColorNode) -> Option<&'static str> {
    if *transmission == ScalarNode::Const(0.0) {
        Some("its transmission texture is black everywhere")
    } else if is_black(tint) {
        Some("what it transmits is tinted black")
    } else {
        None
    }
}
