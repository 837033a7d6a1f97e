//! Lights: records, and the alias table or the tree from which one is picked.

mod later;

use std::collections::HashSet;

use glam::DVec3;
use residual_render::alias_table::alias_entries;
use residual_render::domain::{Buffer, Scalar, Uint};
use residual_render::light::{
    self, AreaRecord, EnvironmentHeader, LightRecord, LightTree, PunctualRecord, push_light,
    set_picks,
};
use residual_render::program::{ColorNode, LightNode, Program, Source, SourceNode};
use residual_render::scene_data::SceneData;
use residual_render::texture::srgb_table;

use super::environment_weights::EnvironmentWeights;
use super::geometry::Geometry;
use super::images::Images;
use super::light_places;
use super::light_places_gain::Emitter;
use super::light_tree::{self, LightBounds, Reach};
use super::light_tree_gain;
use super::luminance::luminance;
use super::options::{LightPicks, LightPlaces, PlanOptions};
use super::planned::LightKindUse;
use super::planned_materials::Materials;
use super::punctual::Punctual;
use crate::desc::{ColorInput, EnvironmentDesc, LightDesc, SceneDesc, SurfaceDesc, Texels, Wrap};
use crate::sixteen_bits;

/// The kinds of lights of a scene and how many there are of each.
#[derive(Debug, Default)]
pub(super) struct PlannedLights {
    pub(super) kinds: Vec<LightNode>,
    pub(super) uses: Vec<LightKindUse>,
    pub(super) picks: LightPicks,
    pub(super) tree: Option<LightTree>,
    /// Power of each light, and the index of its kind.
    powers: Vec<(f64, usize)>,
    /// Where each shines.
    reaches: Vec<Reach>,
    /// How often each is picked from a table.
    probabilities: Vec<f64>,
    /// Those that are triangles.
    emitters: Vec<Emitter>,
    /// What arrives of the environment from all directions together.
    environment: f64,
    /// All lights are there only because there are some at other moments.
    pub(super) is_dark: bool,
}

/// Of fewer lights at finite places there is no tree, unless it is asked for.
const FEW_LIGHTS: usize = 8;
/// From how many on there is always one.
const MANY_LIGHTS: usize = 1024;
/// Among numbers between the two there is one where samples have so much less [variance](light_tree_gain::gain).
const LEAST_GAIN: f64 = 1.5;

/// Builds the tree over lights with the probabilities that a table gives them, if it pays or is asked for.
fn tree(lights: &[(Reach, f64)], picks: LightPicks, data: &mut SceneData) -> Option<LightTree> {
    let bounded = lights.iter();
    let bounded = bounded.filter(|(reach, _)| matches!(reach, Reach::Bounded(_)));
    let count = bounded.count();
    if lights.is_empty() || (picks == LightPicks::Auto && count < FEW_LIGHTS) {
        return None;
    }
    let tree = light_tree::build(lights, data);
    if picks == LightPicks::Auto && count < MANY_LIGHTS {
        let gain = light_tree_gain::gain(lights, tree, data);
        if gain < LEAST_GAIN {
            data.buffer_mut(Buffer::LightTree).clear();
            return None;
        }
    }
    Some(tree)
}

/// Plans all lights of the scene's first pose and writes their buffers. `radius` is that of the sphere around everything.
pub(super) fn plan_lights(
    scene: &SceneDesc,
    materials: &Materials,
    geometry: &Geometry,
    radius: f64,
    images: &mut Images,
    options: &PlanOptions,
    data: &mut SceneData,
) -> PlannedLights {
    let mut lights = PlannedLights::default();
    lights.add_emitting_triangles(scene, materials, geometry, data);
    for light in &scene.lights {
        lights.add_punctual(light, radius, data);
    }
    if let Some(environment) = &scene.environment {
        let is_found_otherwise = options.bsdf_samples_find_lights();
        lights.add_environment(scene, environment, images, radius, is_found_otherwise, data);
    }
    if !scene.later.is_empty() {
        lights.stay_countable(data);
    }
    lights.set_picks(options.light_picks_of_tracer(), data);
    let places = options.light_places_of_tracer(!scene.later.is_empty());
    lights.set_places(places, data);
    lights
}

/// The triangles of a program, which emit what a source gives. Shadow rays end before the light, so that nobody asks for
/// its alpha, as paths that find it are asked: it shines as much less as it lets rays through.
fn area(program: &Program, source: &ColorNode) -> LightNode {
    let attributes = source.attributes().intersection(program.attributes);
    match &program.alpha_test {
        None => LightNode::Area {
            emission: source.clone(),
            attributes,
        },
        Some(test) => LightNode::Area {
            emission: ColorNode::Product(
                Box::new(source.clone()),
                Box::new(ColorNode::Gray(Box::new(test.coverage()))),
            ),
            attributes: attributes.union(test.given_attributes()),
        },
    }
}

/// Mean luminance of an emission, texture included.
fn mean_emission(scene: &SceneDesc, input: &ColorInput) -> f64 {
    let Some(texture) = &input.texture else {
        return luminance(input.factor);
    };
    let image = &scene.images[scene.textures[texture.texture].image];
    let [r, g, b] = input.factor;
    let sum: f64 = match &image.texels {
        Texels::Rgba8(texels) => {
            let table = srgb_table();
            let decode = |code: u8| table[usize::from(code)];
            let texel =
                |t: &[u8; 4]| luminance([r * decode(t[0]), g * decode(t[1]), b * decode(t[2])]);
            texels.iter().map(texel).sum()
        }
        Texels::Rgba16(texels) => texels
            .iter()
            .map(|&t| sixteen_bits::decoded_texel(t))
            .map(|t| luminance([r * t[0], g * t[1], b * t[2]]))
            .sum(),
        Texels::RgbaF32(texels) => texels
            .iter()
            .map(|t| luminance([r * t[0], g * t[1], b * t[2]]))
            .sum(),
    };
    let mean = sum / (f64::from(image.width) * f64::from(image.height));
    // How much is around the image is not known.
    match scene.textures[texture.texture]
        .wrap
        .contains(&Wrap::WhiteBorder)
    {
        true => 0.5 * (mean + luminance(input.factor)),
        false => mean,
    }
}

impl PlannedLights {
    fn kind(&mut self, node: LightNode) -> usize {
        let found = self.kinds.iter().position(|kind| *kind == node);
        found.unwrap_or_else(|| {
            self.kinds.push(node);
            self.uses.push(LightKindUse::default());
            self.kinds.len() - 1
        })
    }

    /// Notes a light whose record was added to the data.
    fn count(&mut self, kind: usize, source: &str, power: f64, reach: Reach) {
        self.powers.push((power, kind));
        self.reaches.push(reach);
        let of_kind = &mut self.uses[kind];
        of_kind.count += 1;
        if !of_kind.sources.iter().any(|other| other == source) {
            of_kind.sources.push(source.to_owned());
        }
    }

    fn add_emitting_triangles(
        &mut self,
        scene: &SceneDesc,
        materials: &Materials,
        geometry: &Geometry,
        data: &mut SceneData,
    ) {
        let positions = data.positions();
        for object in &geometry.objects {
            let material = object.material;
            let planned = materials.of(material);
            let program = &materials.programs[planned.program as usize];
            let Some(emission) = program.emission else {
                continue;
            };
            // Of these there may be a scene full, none brighter than white: rays find them well enough.
            if scene.materials[material].surface == SurfaceDesc::Unlit {
                continue;
            }
            let SourceNode::Color(source) = &program.inputs[emission.radiance.0].source else {
                unreachable!("emission is a colour")
            };
            let node = area(program, source);
            let radiance = mean_emission(scene, &scene.materials[material].emission);
            let sides = if emission.double_sided { 2.0 } else { 1.0 };
            let source = format!("material {:?}", scene.materials[material].name);
            let mut kind = None;
            for prim in object.triangles.clone() {
                let corners = [0, 1, 2].map(|corner| {
                    DVec3::from_array(positions[3 * prim as usize + corner].map(f64::from))
                });
                let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
                let area = normal.length() * 0.5;
                let power = std::f64::consts::PI * sides * area * radiance;
                if power > 0.0 && power.is_finite() {
                    data.set_light(prim as usize, self.powers.len() as u32);
                    let kind = *kind.get_or_insert_with(|| self.kind(node.clone()));
                    let record = AreaRecord {
                        kind: kind as u32,
                        triangle: prim,
                        double_sided: u32::from(emission.double_sided),
                    };
                    push_light(data, record);
                    self.emitters.push(Emitter {
                        light: self.powers.len(),
                        corners,
                        radiance,
                        double_sided: emission.double_sided,
                    });
                    let reach = Reach::Bounded(LightBounds {
                        corners: [
                            corners[0].min(corners[1]).min(corners[2]),
                            corners[0].max(corners[1]).max(corners[2]),
                        ],
                        axis: normal.normalize_or(DVec3::Z),
                        half_angle: match emission.double_sided {
                            true => std::f64::consts::PI,
                            false => 0.0,
                        },
                        intensity: area * radiance,
                    });
                    self.count(kind, &source, power, reach);
                }
            }
        }
    }

    fn add_punctual(&mut self, light: &LightDesc, radius: f64, data: &mut SceneData) {
        let Some(punctual) = Punctual::new(light, luminance(light.intensity), radius) else {
            return;
        };
        let kind = self.kind(punctual.node);
        push_light(
            data,
            PunctualRecord {
                kind: kind as u32,
                ..punctual.record
            },
        );
        let source = format!("light {:?}", light.name);
        self.count(kind, &source, punctual.power, punctual.reach);
    }

    fn add_environment(
        &mut self,
        scene: &SceneDesc,
        environment: &EnvironmentDesc,
        images: &mut Images,
        radius: f64,
        is_found_otherwise: bool,
        data: &mut SceneData,
    ) {
        let image = &scene.images[environment.image];
        let weights = EnvironmentWeights::of(image);
        if weights.mean() <= 0.0 || environment.strength <= 0.0 {
            return;
        }
        let index = self.powers.len() as u32;
        // The weights' mean is the mean of luminance·sin θ; ∫L dω = 2π²·that.
        self.environment =
            2.0 * std::f64::consts::PI.powi(2) * weights.mean() * f64::from(environment.strength);
        self.push_environment(scene, radius, data);

        let texels = images.environment(scene, environment.image);
        let (sin, cos) = environment.rotation.sin_cos();
        let header = EnvironmentHeader {
            width: texels.width,
            height: texels.height,
            first_texel: texels.first,
            strength: environment.strength,
            cos,
            sin,
            light: index,
        };
        let weights = match is_found_otherwise {
            true => weights.compensated(),
            false => weights,
        };
        light::set_environment(data, header, weights.alias_entries());
    }

    fn push_environment(&mut self, scene: &SceneDesc, radius: f64, data: &mut SceneData) {
        let kind = self.kind(LightNode::Environment);
        push_light(data, LightRecord { kind: kind as u32 });
        let image = scene.environment.as_ref().map(|sky| sky.image);
        let name = image.map_or("", |image| &scene.images[image].name);
        self.count(
            kind,
            &format!("environment {name:?}"),
            std::f64::consts::PI * radius * radius * self.environment,
            Reach::Everywhere,
        );
    }

    /// Mixed picks go by power, and evenly to emitting triangles, points, spots, … as far as there are any. How many *programs* for emission there are must
    /// not matter: it differs between binding policies, whose images are the same.
    fn set_picks(&mut self, picks: LightPicks, data: &mut SceneData) {
        let variant = |kind: usize| std::mem::discriminant(&self.kinds[kind]);
        let total: f64 = self.powers.iter().map(|(power, _)| power).sum();
        let of_variant = |kind: usize| -> f64 {
            let alike = self
                .powers
                .iter()
                .filter(|(_, other)| variant(*other) == variant(kind));
            alike.map(|(power, _)| power).sum()
        };
        let sums: Vec<f64> = (0..self.kinds.len()).map(of_variant).collect();
        // Of some kinds there may be lights at other moments only.
        let variants: HashSet<_> = self.powers.iter().map(|(_, kind)| variant(*kind)).collect();
        let probability = |&(power, kind): &(f64, usize)| match picks {
            LightPicks::Auto | LightPicks::Mixed | LightPicks::Tree => {
                0.5 * power / total + 0.5 * power / sums[kind] / variants.len() as f64
            }
            LightPicks::Power => power / total,
            LightPicks::Uniform => 1.0 / self.powers.len() as f64,
        };
        let probabilities: Vec<f64> = self.powers.iter().map(probability).collect();
        self.probabilities.clone_from(&probabilities);
        self.picks = picks;
        if let LightPicks::Auto | LightPicks::Tree = picks {
            let reaches = self.reaches.iter().copied();
            let lights: Vec<_> = reaches.zip(probabilities.iter().copied()).collect();
            self.tree = tree(&lights, picks, data);
            self.picks = match self.tree {
                Some(_) => LightPicks::Tree,
                None => LightPicks::Mixed,
            };
        }
        if self.tree.is_some() {
            return;
        }
        set_picks(data, alias_entries(&probabilities, 1.0));
    }

    /// Where samples lie on triangles.
    fn set_places(&mut self, places: LightPlaces, data: &mut SceneData) {
        let buffers = data.buffers();
        let d = Scalar::new(&buffers);
        let pick = |at: DVec3, light: usize| match self.tree {
            Some(tree) => {
                let at = at.as_vec3().to_array().into();
                tree.probability(d, at, Uint(light as u32)).into()
            }
            None => self.probabilities[light],
        };
        if light_places::by_solid_angle(places, &self.emitters, pick, data) {
            light_places::set_by_solid_angle(&self.emitters, &mut self.kinds, data);
        }
    }
}
