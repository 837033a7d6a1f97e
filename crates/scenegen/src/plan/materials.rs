//! Materials to programs: which materials are seen, and which share a program.

use std::collections::BTreeMap;

use residual_render::surface::Attributes;
use residual_render::tracer::{DebugView, TracerNode};

use super::closed::Closed;
use super::geometry::is_smooth;
use super::images::Images;
use super::media::Media;
use super::opacity::Opacity;
use super::options::PlanOptions;
use super::planned::MaterialUse;
use super::planned_materials::{Materials, PlannedMaterial};
use super::program::Builder;
use super::rough_dielectrics::RoughDielectrics;
use super::sources::Sources;
use crate::desc::SceneDesc;

/// Plans the materials of all instanced meshes that are seen.
pub(super) fn plan_materials(
    scene: &SceneDesc,
    options: &PlanOptions,
    images: &mut Images,
) -> Materials {
    let mut materials = Materials {
        planned: vec![None; scene.materials.len()],
        ..Materials::default()
    };
    let mut indices = BTreeMap::new();
    let available = available_attributes(scene);
    let seen: Vec<_> = available.iter().map(Option::is_some).collect();
    let closed = Closed::of(scene);
    let media = Media::of(scene, &seen, &closed, options.bodies);
    let mut rough_dielectrics = RoughDielectrics::default();
    for (material, available) in available.into_iter().enumerate() {
        let Some(available) = available else { continue };
        let desc = &scene.materials[material];
        let place = format!("material {:?}", desc.name);
        let sources = Sources::new(scene, options, available, images, place);
        let mut builder = Builder {
            sources,
            inputs: Vec::new(),
            // Rays are then refracted even where the file has no KHR_materials_volume: the specification's thin walls are meant
            // for sheets, and other offline renderers (Cycles, Mitsuba) refract as well.
            encloses: closed.materials[material],
            nesting: media.nesting(),
            rough_dielectrics: &mut rough_dielectrics,
        };
        let opacity = builder.opacity(desc);
        if opacity == Opacity::Transparent {
            materials
                .dismissed
                .extend(builder.sources.collected().dismissed);
            continue;
        }
        let available = Attributes {
            normals: available.normals && !options.flat_normals,
            ..available
        };
        let mut program = builder.program(desc, available, opacity);
        if options.tracer == TracerNode::Debug(DebugView::TextureCoordinates) {
            program.attributes.uv0 |= available.uv0;
        }
        let interior = media
            .interior(material)
            .filter(|_| program.bsdf.transmits());
        program.interior = interior.map(|medium| builder.sources.index(medium));
        let has_interior = interior.is_some();
        let collected = builder.sources.collected();
        let transmits = program.bsdf.transmits();
        let culled = options.culls() && !desc.double_sided && !transmits;
        let alpha_tested = program.alpha_test.is_some();
        // Programs are the same if they print the same: floats print exactly, so this neither merges nor splits
        // what must not be.
        let key = format!("{program:?}");
        let index = *indices.entry(key).or_insert_with(|| {
            materials.programs.push(program);
            materials.uses.push(Vec::new());
            materials.programs.len() as u32 - 1
        });
        materials.uses[index as usize].push(MaterialUse {
            name: desc.name.clone(),
            images: collected.images,
            culled,
            absorbs: has_interior && media.absorbs(material),
            scatters: has_interior && media.scatters(material),
            body: has_interior,
        });
        materials.planned[material] = Some(PlannedMaterial {
            program: index,
            params: materials.params.len() as u32,
            culled,
            alpha_tested,
            interior,
        });
        materials.params.extend(collected.params);
        materials.dismissed.extend(collected.dismissed);
    }
    if materials
        .programs
        .iter()
        .any(|program| program.interior.is_some())
    {
        materials.media = media.node;
        materials.media_words = media.words();
    }
    materials.warnings = media.warnings;
    materials
}

/// For each material that some instance uses, the attributes that any of its meshes has, at any moment.
fn available_attributes(scene: &SceneDesc) -> Vec<Option<Attributes>> {
    let mut available = vec![None; scene.materials.len()];
    let mut seen = vec![false; scene.meshes.len()];
    for instance in scene.poses().flat_map(|pose| pose.instances) {
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
