//! Materials to programs: which inputs there are, when each is known, and which materials share a program.

use std::collections::BTreeMap;

use residual_render::alpha::AlphaTest;
use residual_render::program::{
    AlphaNode, BsdfNode, ColorNode, EmissionNode, InputNode, NormalNode, Program, ScalarNode,
    SourceNode,
};
use residual_render::surface::Attributes;
use residual_render::texture::Input;
use residual_render::tracer::{DebugView, TracerNode};

use super::closed::is_closed;
use super::geometry::is_smooth;
use super::images::Images;
use super::sources::Sources;
use super::{CullingRule, MaterialUse, Materials, PlanOptions, PlannedMaterial};
use crate::desc::{
    AlphaMode, MaterialDesc, MetallicRoughness, Phong, SceneDesc, SurfaceDesc, Warning, WarningKind,
};
use crate::effect::Effect;

/// Plans the materials of all instanced meshes that are seen.
pub(super) fn plan_materials(
    scene: &SceneDesc,
    options: &PlanOptions,
    images: &mut Images,
    warnings: &mut Vec<Warning>,
) -> Materials {
    let mut materials = Materials {
        planned: vec![None; scene.materials.len()],
        ..Materials::default()
    };
    let mut numbers = BTreeMap::new();
    for (number, available) in available_attributes(scene).into_iter().enumerate() {
        let Some(available) = available else { continue };
        let desc = &scene.materials[number];
        let place = format!("material {:?}", desc.name);
        let sources = Sources::new(scene, options.binding, available, images, place);
        let encloses = encloses_a_body(scene, number);
        let mut builder = Builder {
            sources,
            inputs: Vec::new(),
            warnings,
            name: &desc.name,
            encloses,
        };
        let presence = builder.presence(desc);
        if presence == Presence::Never {
            materials
                .dismissed
                .extend(builder.sources.collected().dismissed);
            continue;
        }
        let available = Attributes {
            normals: available.normals && !options.flat_normals,
            ..available
        };
        let mut program = builder.program(desc, available, presence);
        if options.tracer == TracerNode::Debug(DebugView::TextureCoordinates) {
            program.attributes.uv0 |= available.uv0;
        }
        let collected = builder.sources.collected();
        let transmits = bsdf_transmits(&program.bsdf);
        let culled = options.culling == CullingRule::Gltf && !desc.double_sided && !transmits;
        let lets_through = program.alpha.is_some();
        // Programs are the same if they print the same: floats print exactly, so this neither merges nor splits
        // what must not be.
        let key = format!("{program:?}");
        let index = *numbers.entry(key).or_insert_with(|| {
            materials.programs.push(program);
            materials.uses.push(Vec::new());
            materials.programs.len() as u32 - 1
        });
        materials.uses[index as usize].push(MaterialUse {
            name: desc.name.clone(),
            images: collected.images,
            culled,
        });
        materials.planned[number] = Some(PlannedMaterial {
            program: index,
            params: materials.params.len() as u32,
            culled,
            lets_through,
        });
        materials.params.extend(collected.params);
        materials.dismissed.extend(collected.dismissed);
    }
    materials
}

/// For each material that some instance uses, the attributes that any of its meshes has.
fn available_attributes(scene: &SceneDesc) -> Vec<Option<Attributes>> {
    let mut available = vec![None; scene.materials.len()];
    let mut seen = vec![false; scene.meshes.len()];
    for instance in &scene.instances {
        let mesh = &scene.meshes[instance.mesh];
        if std::mem::replace(&mut seen[instance.mesh], true) {
            continue;
        }
        let has = Attributes {
            normals: is_smooth(mesh),
            tangents: mesh.tangents.is_some(),
            uv0: mesh.uvs[0].is_some(),
            uv1: mesh.uvs[1].is_some(),
            colors: mesh.colors.is_some(),
        };
        let all: &mut Option<Attributes> = &mut available[mesh.material];
        *all = Some(all.unwrap_or_default().union(has));
    }
    available
}

/// Whether a transmitting material's surfaces are all closed. Its rays are then refracted even where the file has no
/// KHR_materials_volume: the specification's thin walls are meant for sheets, and other offline renderers (Cycles,
/// Mitsuba) refract as well.
fn encloses_a_body(scene: &SceneDesc, material: usize) -> bool {
    let transmits = |surface: &SurfaceDesc| match surface {
        SurfaceDesc::MetallicRoughness(surface) => surface.transmission.factor > 0.0,
        SurfaceDesc::Phong(_) | SurfaceDesc::Dielectric { .. } => false,
    };
    transmits(&scene.materials[material].surface)
        && scene
            .meshes
            .iter()
            .filter(|mesh| mesh.material == material)
            .all(is_closed)
}

fn bsdf_transmits(bsdf: &BsdfNode) -> bool {
    match bsdf {
        BsdfNode::Dielectric { .. } => true,
        BsdfNode::Mix { a, b, .. } | BsdfNode::Sum { a, b, .. } => {
            bsdf_transmits(a) || bsdf_transmits(b)
        }
        BsdfNode::Black
        | BsdfNode::Diffuse { .. }
        | BsdfNode::Conductor { .. }
        | BsdfNode::Glossy { .. }
        | BsdfNode::Phong { .. } => false,
    }
}

/// Where surfaces are there at all, as their alpha has it.
#[derive(Clone, Copy, PartialEq)]
enum Presence {
    Always,
    Tested(AlphaTest<f32>),
    Never,
}

/// Builds one program.
struct Builder<'a> {
    sources: Sources<'a>,
    inputs: Vec<InputNode>,
    warnings: &'a mut Vec<Warning>,
    name: &'a str,
    /// The material's surfaces are closed.
    encloses: bool,
}

impl Builder<'_> {
    fn program(
        &mut self,
        desc: &MaterialDesc,
        available: Attributes,
        presence: Presence,
    ) -> Program {
        let normal = desc
            .normal_map
            .as_ref()
            .filter(|_| available.tangents)
            .filter(|map| {
                let flat = map.scale == 0.0 || self.sources.is_flat(&map.texture);
                if flat {
                    self.sources
                        .dismiss(Effect::NormalMaps, "its normal map bends no normal");
                }
                !flat
            })
            .map(|map| {
                let texel = self.sources.linear_texel(&map.texture);
                let scale = self.sources.number(map.scale);
                NormalNode {
                    texel: self.color("normal_texel", texel),
                    scale: self.scalar("normal_scale", scale),
                }
            });
        let bsdf = match &desc.surface {
            SurfaceDesc::MetallicRoughness(surface) => self.metallic_roughness(surface),
            SurfaceDesc::Phong(surface) => self.phong(surface),
            SurfaceDesc::Dielectric { ior, transmittance } => {
                let tint = self.sources.constant_color(*transmittance);
                self.dielectric(tint, *ior, true)
            }
        };
        let emission = self.sources.color(&desc.emission, false);
        if is_black(&emission) && desc.emission.factor != [0.0; 3] {
            self.sources
                .dismiss(Effect::EmittingSurfaces, "its emissive texture is black");
        }
        let emission = (!is_black(&emission)).then(|| EmissionNode {
            radiance: self.color("emission", emission),
            double_sided: desc.double_sided,
        });
        let mut attributes = self.sources.take_attributes();
        attributes.normals |= available.normals;
        attributes.tangents |= normal.is_some();
        let alpha = match presence {
            Presence::Always | Presence::Never => None,
            Presence::Tested(test) => Some(self.alpha(desc, test)),
        };
        let inputs = std::mem::take(&mut self.inputs);
        Program {
            attributes,
            inputs,
            normal,
            emission,
            bsdf,
            alpha,
        }
    }

    fn input(&mut self, name: &'static str, source: SourceNode) -> Input {
        let node = InputNode { name, source };
        // The same source under the same name is the same input.
        let found = self.inputs.iter().position(|other| *other == node);
        Input(found.unwrap_or_else(|| {
            self.inputs.push(node);
            self.inputs.len() - 1
        }))
    }

    fn color(&mut self, name: &'static str, node: ColorNode) -> Input {
        self.input(name, SourceNode::Color(node))
    }

    fn scalar(&mut self, name: &'static str, node: ScalarNode) -> Input {
        self.input(name, SourceNode::Scalar(node))
    }

    fn diffuse(&mut self, albedo: ColorNode) -> BsdfNode {
        if is_black(&albedo) {
            return BsdfNode::Black;
        }
        BsdfNode::Diffuse {
            albedo: self.color("albedo", albedo),
        }
    }

    fn dielectric(&mut self, tint: ColorNode, ior: f32, solid: bool) -> BsdfNode {
        let ior = self.sources.number(ior);
        BsdfNode::Dielectric {
            transmittance: self.color("transmittance", tint),
            ior: self.scalar("ior", ior),
            solid,
        }
    }

    /// glTF 2.0, appendix B.3.5: `mix(dielectric, metal, metallic)`.
    fn metallic_roughness(&mut self, surface: &MetallicRoughness) -> BsdfNode {
        let base = self.sources.color(&surface.base_color, true);
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
        let solid = surface.solid || self.encloses;
        let transmission = self.sources.scalar(&surface.transmission);
        if surface.transmission.factor > 0.0
            && let Some(reason) = opaque(&transmission, &base)
        {
            let effect = if solid {
                Effect::Refraction
            } else {
                Effect::ThinTransmission
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
        let clear = self.dielectric(base.clone(), surface.ior, solid);
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
        let reflectance = self.sources.color(&at_normal, false);
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
        BsdfNode::Glossy {
            albedo: self.color("albedo", albedo),
            roughness: self.scalar("roughness", roughness),
            reflectance: self.color("reflectance", reflectance),
            grazing: self.scalar("grazing_reflectance", grazing),
        }
    }

    fn phong(&mut self, surface: &Phong) -> BsdfNode {
        let albedo = self.sources.color(&surface.diffuse, true);
        let specular = self.sources.color(&surface.specular, false);
        let diffuse = self.diffuse(albedo);
        if is_black(&specular) {
            return diffuse;
        }
        let exponent = self.sources.scalar(&surface.exponent);
        let lobe = BsdfNode::Phong {
            color: self.color("specular", specular),
            exponent: self.scalar("exponent", exponent),
        };
        if diffuse == BsdfNode::Black {
            return lobe;
        }
        let weight = |factor: [f32; 3]| factor.iter().sum::<f32>();
        let share = weight(surface.specular.factor)
            / (weight(surface.specular.factor) + weight(surface.diffuse.factor));
        let probability = self.sources.number(share.clamp(0.1, 0.9));
        BsdfNode::Sum {
            a: Box::new(diffuse),
            b: Box::new(lobe),
            probability: self.scalar("specular_probability", probability),
        }
    }

    /// Whether alpha can fail its test, and whether it always does.
    fn presence(&mut self, desc: &MaterialDesc) -> Presence {
        // Filtering stays between the extremes of the texels, but for rounding.
        const ROUNDING: f32 = 1e-5;
        let (effect, test) = match desc.alpha_mode {
            AlphaMode::Opaque => return Presence::Always,
            AlphaMode::Mask(cutoff) => (Effect::AlphaMasks, AlphaTest::Mask(cutoff)),
            AlphaMode::Blend => (Effect::AlphaBlending, AlphaTest::Blend),
        };
        let Some([least, greatest]) = self.sources.alpha_extremes(&desc.alpha) else {
            return Presence::Tested(test);
        };
        let (always, never) = match test {
            AlphaTest::Mask(cutoff) if least == greatest => (least >= cutoff, least < cutoff),
            AlphaTest::Mask(cutoff) => (
                cutoff <= 0.0 || least >= cutoff + ROUNDING,
                greatest < cutoff - ROUNDING,
            ),
            AlphaTest::Blend => (least >= 1.0, greatest <= 0.0),
        };
        if always {
            self.sources
                .dismiss(effect, "its alpha lets nothing through");
            Presence::Always
        } else if never {
            self.sources
                .dismiss(effect, "its alpha lets everything through");
            Presence::Never
        } else {
            Presence::Tested(test)
        }
    }

    fn alpha(&mut self, desc: &MaterialDesc, test: AlphaTest<f32>) -> AlphaNode {
        let alpha = self.sources.alpha(&desc.alpha);
        let test = match test {
            AlphaTest::Mask(cutoff) => AlphaTest::Mask(self.sources.number(cutoff)),
            AlphaTest::Blend => AlphaTest::Blend,
        };
        AlphaNode {
            alpha,
            test,
            attributes: self.sources.take_attributes(),
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

fn is_black(node: &ColorNode) -> bool {
    *node == ColorNode::Const([0.0; 3])
}
