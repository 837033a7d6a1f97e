//! glTF's metallic-roughness surface to BSDFs: a base, and the layers over it.

use residual_render::bsdf::AnyInterface;
use residual_render::program::{
    BsdfNode, ColorNode, FresnelNode, LayerFrameNode, RoughnessNode, ScalarNode, TangentNode,
};
use residual_render::texture::Input;

use super::program::{Builder, is_black};
use crate::desc::{MetallicRoughness, NormalMap, SurfaceDesc};
use crate::effect::Effect;

/// Reflectance at normal incidence of a clear coat, whose index of refraction is 1.5.
const CLEARCOAT: f32 = 0.04;

/// Nearer to 1 than this the index of refraction of a rough surface is set to it: facets then bend light so little that their
/// normals cannot be told from directions.
const LEAST_ROUGH_IOR: f32 = 1.001;

const ZERO: ScalarNode = ScalarNode::Const(0.0);
const ONE: ScalarNode = ScalarNode::Const(1.0);

impl Builder<'_> {
    /// The base under its sheen under its clear coat.
    pub(super) fn metallic_roughness(
        &mut self,
        surface: &MetallicRoughness,
        normal_map: Option<&NormalMap>,
    ) -> BsdfNode {
        let base = self.base(surface);
        let base = self.under_sheen(surface, base);
        self.under_clearcoat(surface, base, normal_map)
    }

    /// How much rougher the surface is along its tangents; 0 where it has none.
    fn anisotropy(&mut self, surface: &MetallicRoughness) -> ScalarNode {
        match self.sources.has_tangents() {
            true => self.sources.scalar(&surface.anisotropy),
            false => ZERO,
        }
    }

    /// Whether the surface is rougher in one direction than in others.
    pub(super) fn is_anisotropic(&mut self, surface: &SurfaceDesc) -> bool {
        match surface {
            SurfaceDesc::MetallicRoughness(surface) => self.anisotropy(surface) != ZERO,
            _ => false,
        }
    }

    /// The direction in which an anisotropic surface is rougher, if it is not that of the tangents.
    pub(super) fn tangent(&mut self, surface: &SurfaceDesc) -> Option<TangentNode> {
        let SurfaceDesc::MetallicRoughness(surface) = surface else {
            return None;
        };
        let (texture, rotation) = (&surface.anisotropy.texture, surface.anisotropy_rotation);
        let texel = match texture {
            Some((texture, _)) => self.sources.linear_texel(texture),
            None if rotation == 0.0 => return None,
            None => ColorNode::Const([1.0, 0.5, 0.0]),
        };
        let (sin, cos) = rotation.sin_cos();
        let [cos, sin] = [cos, sin].map(|value| self.sources.number(value));
        Some(TangentNode {
            texel: self.color("anisotropy_texel", texel),
            cos: self.scalar("anisotropy_cos", cos),
            sin: self.scalar("anisotropy_sin", sin),
        })
    }

    /// glTF 2.0, appendix B.3.5: `mix(dielectric, metal, metallic)`.
    fn base(&mut self, surface: &MetallicRoughness) -> BsdfNode {
        let base = self.sources.tinted_color(&surface.base_color);
        let metallic = self.sources.scalar(&surface.metallic);
        if metallic == ZERO {
            return self.dielectric_part(surface, base);
        }
        let normal = self.color("albedo", base.clone());
        let grazing = self.scalar("metal_grazing_reflectance", ONE);
        let metal = BsdfNode::Glossy {
            fresnel: self.fresnel(surface, normal, grazing),
            roughness: self.roughness(surface),
        };
        if metallic == ONE {
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
            true => self.solid(),
            false => AnyInterface::Thin,
        };
        let transmission = self.sources.scalar(&surface.transmission);
        if surface.transmission.factor > 0.0
            && let Some(reason) = opaque(&transmission, &base)
        {
            let effect = match interface {
                AnyInterface::Solid | AnyInterface::SolidAmongSolids => Effect::Refraction,
                AnyInterface::Thin => Effect::ThinTransmission,
            };
            self.sources.dismiss(effect, reason);
            return self.opaque_dielectric(surface, base);
        }
        if transmission == ZERO {
            return self.opaque_dielectric(surface, base);
        }
        let clear = self.clear_dielectric(surface, base.clone(), interface);
        if transmission == ONE {
            return clear;
        }
        BsdfNode::Mix {
            a: Box::new(self.opaque_dielectric(surface, base)),
            b: Box::new(clear),
            weight: self.scalar("transmission", transmission),
        }
    }

    fn clear_dielectric(
        &mut self,
        surface: &MetallicRoughness,
        tint: ColorNode,
        interface: AnyInterface,
    ) -> BsdfNode {
        if self.sources.known(&surface.roughness) == Some(0.0) {
            let ior = self.refraction(surface, surface.ior, interface);
            return self.smooth_dielectric(tint, ior, interface);
        }
        let ior = surface.ior.max(LEAST_ROUGH_IOR);
        let node = self.refraction(surface, ior, interface);
        let transmittance = self.color("transmittance", tint);
        let node = self.scalar("ior", node);
        let roughness = self.roughness(surface);
        match interface {
            AnyInterface::Solid | AnyInterface::SolidAmongSolids => BsdfNode::RoughDielectric {
                transmittance,
                ior: node,
                roughness,
                interface,
                albedos: self.sources.table(self.rough_dielectrics.albedos(ior)),
            },
            AnyInterface::Thin => BsdfNode::RoughSheet {
                transmittance,
                ior: node,
                roughness,
            },
        }
    }

    /// The index of refraction, of which dispersion is seen where rays are bent.
    fn refraction(
        &mut self,
        surface: &MetallicRoughness,
        ior: f32,
        interface: AnyInterface,
    ) -> ScalarNode {
        let node = self.sources.number(ior);
        let is_bent = interface != AnyInterface::Thin && ior > 1.0;
        if surface.dispersion == 0.0 || !is_bent {
            return node;
        }
        ScalarNode::Dispersive {
            ior: Box::new(node),
            dispersion: Box::new(self.sources.number(surface.dispersion)),
        }
    }

    /// A matte base under a coat, or without one where the coat reflects nothing.
    fn opaque_dielectric(&mut self, surface: &MetallicRoughness, albedo: ColorNode) -> BsdfNode {
        let base = self.matte(surface, albedo);
        // KHR_materials_specular and KHR_materials_ior: F0 = min(((η−1)/(η+1))²·colour, 1)·strength, F90 = strength.
        let grazing = self.sources.scalar(&surface.specular);
        let strength = self.sources.known(&surface.specular);
        let normal_incidence = ((surface.ior - 1.0) / (surface.ior + 1.0)).powi(2);
        let mut at_normal = surface.specular_color.clone();
        at_normal.factor = at_normal
            .factor
            .map(|c| (c * normal_incidence).min(1.0) * strength.unwrap_or(surface.specular.factor));
        let reflectance = self.sources.color(&at_normal);
        if grazing == ZERO || (is_black(&reflectance) && surface.ior == 1.0) {
            return base;
        }
        let reflectance = match &surface.specular.texture {
            Some((texture, channel)) if strength.is_none() => {
                let strength = ColorNode::Gray(Box::new(self.sources.channel(texture, *channel)));
                self.sources.color_product(reflectance, strength)
            }
            _ => reflectance,
        };
        let normal = self.color("reflectance", reflectance);
        let grazing = self.scalar("grazing_reflectance", grazing);
        let coat = BsdfNode::Glossy {
            fresnel: self.fresnel(surface, normal, grazing),
            roughness: self.roughness(surface),
        };
        coated(coat, base)
    }

    /// `mix(reflected, transmitted, diffuse transmission)`.
    fn matte(&mut self, surface: &MetallicRoughness, albedo: ColorNode) -> BsdfNode {
        let reflected = self.rough_diffuse(surface, albedo);
        let share = self.sources.scalar(&surface.diffuse_transmission);
        if share == ZERO {
            return reflected;
        }
        let color = self.sources.color(&surface.diffuse_transmission_color);
        let transmitted = match is_black(&color) {
            true => BsdfNode::Black,
            false => BsdfNode::DiffuseTransmission {
                color: self.color("diffuse_transmittance", color),
            },
        };
        if share == ONE {
            return transmitted;
        }
        BsdfNode::Mix {
            a: Box::new(reflected),
            b: Box::new(transmitted),
            weight: self.scalar("diffuse_transmission", share),
        }
    }

    fn rough_diffuse(&mut self, surface: &MetallicRoughness, albedo: ColorNode) -> BsdfNode {
        let roughness = self.sources.scalar(&surface.diffuse_roughness);
        if roughness == ZERO || is_black(&albedo) {
            return self.diffuse(albedo);
        }
        BsdfNode::RoughDiffuse {
            albedo: self.color("albedo", albedo),
            roughness: self.scalar("diffuse_roughness", roughness),
        }
    }

    fn under_sheen(&mut self, surface: &MetallicRoughness, base: BsdfNode) -> BsdfNode {
        let color = self.sources.color(&surface.sheen_color);
        if is_black(&color) {
            return base;
        }
        let roughness = self.sources.scalar(&surface.sheen_roughness);
        let sheen = BsdfNode::Sheen {
            color: self.color("sheen_color", color),
            roughness: self.scalar("sheen_roughness", roughness),
        };
        coated(sheen, base)
    }

    /// What a clear coat lets through of what is emitted under it.
    pub(super) fn emission_under_clearcoat(
        &mut self,
        surface: &SurfaceDesc,
        emission: ColorNode,
    ) -> ColorNode {
        let SurfaceDesc::MetallicRoughness(surface) = surface else {
            return emission;
        };
        let strength = self.sources.scalar(&surface.clearcoat);
        if strength == ZERO {
            return emission;
        }
        let normal = self.sources.number(CLEARCOAT);
        ColorNode::UnderCoat {
            color: Box::new(emission),
            normal: Box::new(self.sources.scalar_product(normal, strength.clone())),
            grazing: Box::new(strength),
        }
    }

    fn under_clearcoat(
        &mut self,
        surface: &MetallicRoughness,
        base: BsdfNode,
        normal_map: Option<&NormalMap>,
    ) -> BsdfNode {
        let strength = self.sources.scalar(&surface.clearcoat);
        if strength == ZERO {
            return base;
        }
        let gray = ColorNode::Gray(Box::new(strength.clone()));
        let reflectance = self.sources.constant_color([CLEARCOAT; 3]);
        let reflectance = match strength {
            ONE => reflectance,
            _ => self.sources.color_product(reflectance, gray),
        };
        let roughness = self.sources.scalar(&surface.clearcoat_roughness);
        let coat = BsdfNode::Glossy {
            fresnel: FresnelNode::Schlick {
                normal: self.color("clearcoat_reflectance", reflectance),
                grazing: self.scalar("clearcoat", strength),
            },
            roughness: RoughnessNode::Isotropic {
                roughness: self.scalar("clearcoat_roughness", roughness),
            },
        };
        coated(self.with_own_normal(coat, surface, normal_map), base)
    }

    /// A clear coat with its own normals, if they are not those of the surface under it.
    fn with_own_normal(
        &mut self,
        coat: BsdfNode,
        surface: &MetallicRoughness,
        normal_map: Option<&NormalMap>,
    ) -> BsdfNode {
        let has_tangents = self.sources.has_tangents();
        let own = surface.clearcoat_normal.as_ref().filter(|_| has_tangents);
        if own == normal_map {
            return coat;
        }
        let normal = match own {
            None => LayerFrameNode::MeshFrame,
            Some(map) => {
                let texel = self.sources.normal_texel(&map.texture);
                let scale = self.sources.number(map.scale);
                LayerFrameNode::MappedFrame {
                    texel: self.color("clearcoat_normal_texel", texel),
                    scale: self.scalar("clearcoat_normal_scale", scale),
                }
            }
        };
        BsdfNode::OwnNormal {
            bsdf: Box::new(coat),
            normal,
        }
    }

    fn fresnel(
        &mut self,
        surface: &MetallicRoughness,
        normal: Input,
        grazing: Input,
    ) -> FresnelNode {
        let strength = self.sources.scalar(&surface.iridescence);
        if strength == ZERO {
            return FresnelNode::Schlick { normal, grazing };
        }
        let thickness = self
            .sources
            .between(surface.iridescence_minimum, &surface.iridescence_thickness);
        let ior = self.sources.number(surface.iridescence_ior);
        FresnelNode::ThinFilm {
            normal,
            grazing,
            strength: self.scalar("iridescence", strength),
            ior: self.scalar("film_ior", ior),
            thickness: self.scalar("film_thickness", thickness),
        }
    }

    fn roughness(&mut self, surface: &MetallicRoughness) -> RoughnessNode {
        let roughness = self.sources.scalar(&surface.roughness);
        let roughness = self.scalar("roughness", roughness);
        let anisotropy = self.anisotropy(surface);
        if anisotropy == ZERO {
            return RoughnessNode::Isotropic { roughness };
        }
        RoughnessNode::Anisotropic {
            roughness,
            anisotropy: self.scalar("anisotropy", anisotropy),
        }
    }
}

fn coated(coat: BsdfNode, base: BsdfNode) -> BsdfNode {
    BsdfNode::Coated {
        coat: Box::new(coat),
        base: Box::new(base),
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
