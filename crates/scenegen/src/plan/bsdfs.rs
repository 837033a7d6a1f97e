//! Surfaces to BSDFs: which lobes a description calls for, and which of them its inputs leave nothing of.

use residual_render::bsdf::AnyInterface;
use residual_render::program::{BsdfNode, ColorNode, ScalarNode};

use residual_render::tracer::AnyNesting;

use super::program::{Builder, is_black};
use crate::desc::{ColorInput, NormalMap, PhongSurface, SurfaceDesc};

impl Builder<'_> {
    /// The BSDF of a surface whose normals may be those of a map.
    pub(super) fn bsdf(
        &mut self,
        surface: &SurfaceDesc,
        normal_map: Option<&NormalMap>,
    ) -> BsdfNode {
        match surface {
            SurfaceDesc::MetallicRoughness(surface) => self.metallic_roughness(surface, normal_map),
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
                self.dielectric(tint, *ior, self.solid())
            }
        }
    }

    pub(super) fn diffuse(&mut self, albedo: ColorNode) -> BsdfNode {
        if is_black(&albedo) {
            return BsdfNode::Black;
        }
        BsdfNode::Diffuse {
            albedo: self.color("albedo", albedo),
        }
    }

    /// The interface of a body.
    pub(super) fn solid(&self) -> AnyInterface {
        match self.nesting {
            AnyNesting::Beside => AnyInterface::Solid,
            AnyNesting::Nested => AnyInterface::SolidAmongSolids,
        }
    }

    fn dielectric(&mut self, tint: ColorNode, ior: f32, interface: AnyInterface) -> BsdfNode {
        let ior = self.sources.number(ior);
        self.smooth_dielectric(tint, ior, interface)
    }

    /// A smooth dielectric.
    pub(super) fn smooth_dielectric(
        &mut self,
        tint: ColorNode,
        ior: ScalarNode,
        interface: AnyInterface,
    ) -> BsdfNode {
        BsdfNode::Dielectric {
            transmittance: self.color("transmittance", tint),
            ior: self.scalar("ior", ior),
            interface,
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
