//! The plan: what is static in a scene, and where its dynamic data lie.
//!
//! [`SceneDesc`] → `Plan`: a [`Structure`] (programs, kinds of lights, of the camera, of the sampler) that emitters
//! print and interpreters build, and the [`SceneData`] that it reads. Materials whose structure agrees share a
//! program; what distinguishes them are parameters.

mod alpha_test;
mod bsdfs;
mod camera;
mod camera_choice;
mod clip_distances;
mod closed;
mod coincident;
mod environment_weights;
mod equal_areas;
mod error;
mod explain;
mod geometry;
mod image_levels;
mod image_reading;
mod images;
mod light_places;
mod light_places_gain;
mod light_tree;
mod light_tree_gain;
#[cfg(test)]
mod light_tree_tests;
mod lights;
mod luminance;
mod materials;
mod media;
mod media_at_camera;
mod metallic_roughness;
mod motion;
mod opacity;
mod optics;
mod options;
mod planned;
mod planned_materials;
mod program;
mod punctual;
mod rough_dielectrics;
mod sources;

use glam::DVec3;
use residual_render::domain::Buffer;
use residual_render::layer::Layer;
use residual_render::program::{Program, Structure};
use residual_render::scene_data::SceneData;
use residual_render::tracer::{Between, TracerNode};

pub use camera_choice::{CameraChoice, View};
use clip_distances::Clipping;
pub use error::PlanError;
pub use explain::{BindingTimes, Decision};
use motion::First;
pub use optics::{Aperture, Focus, Optics};
pub use options::{
    Binding, BodyRule, CullingRule, LightPicks, LightPlaces, PlanOptions, TextureResolution,
};
pub use planned::{LightKindUse, MaterialUse, Motion, Plan, PlannedObject};

use crate::desc::{
    Dismissed, EnvironmentDesc, ImageDesc, NOTHING_MOVES, SceneDesc, Texels, Warning, WarningKind,
};
use crate::effect::Effect;

/// Plans a scene.
///
/// # Errors
/// If the camera asked for does not exist or cannot be focused, or the scene does not fit 32-bit indices.
pub fn plan(scene: &SceneDesc, options: &PlanOptions) -> Result<Plan, PlanError> {
    let mut warnings = Vec::new();
    let mut data = SceneData::default();
    let mut images = images::Images::default();

    let materials = materials::plan_materials(scene, options, &mut images);
    let mut geometry = geometry::pack(scene, scene.pose(0), &materials, &mut data, &mut warnings)?;
    motion::set_bounds(scene, &materials, &mut geometry.bounds);
    let hidden = coincident::hide(&mut data);
    // Only paths need lights.
    let mut lights = match options.tracer {
        TracerNode::Path(_) | TracerNode::Bidirectional(_) => lights::plan_lights(
            scene,
            &materials,
            &geometry,
            f64::from(geometry.bounds.sphere().1),
            &mut images,
            options,
            &mut data,
        ),
        TracerNode::AmbientOcclusion | TracerNode::Debug(_) => lights::PlannedLights::default(),
    };
    let needs_light = options.tracer.needs_light();
    // A black environment is darkness that was asked for.
    if needs_light && lights.kinds.is_empty() && scene.environment.is_none() {
        return plan_under_white_sky(scene, options);
    }
    let (camera, shot) = camera::choose(
        (scene, scene.pose(0)),
        options,
        &geometry.bounds,
        None,
        &mut data,
        &mut warnings,
    )?;
    camera::set_other_records(
        &camera,
        options,
        materials.filter(),
        &geometry.bounds,
        &mut data,
    );
    let mut dismissed = [&scene.dismissed[..], &materials.dismissed].concat();
    if hidden > 0 {
        dismissed.push(Dismissed {
            effect: None,
            place: "meshes".to_owned(),
            reason: format!("{hidden} triangles lie exactly on others, which hide them"),
        });
    }
    *data.buffer_mut(Buffer::Media) =
        media_at_camera::media_words(&materials, &data.record(0), &data, &geometry.objects);
    let chosen = &shot.camera;
    match chosen
        .clip
        .map(|clip| clip_distances::look(clip, chosen, &data.record(0), &data))
    {
        Some(Clipping::Something(warning)) => warnings.push(warning),
        Some(Clipping::Nothing(reason)) => dismissed.push(reason),
        None => {}
    }
    let mut depth = geometry.bounds.farthest(chosen.position);
    let first = First {
        scene,
        options,
        materials: &materials,
        geometry: &geometry,
        camera: (&camera, &shot),
        data: &data,
    };
    let motion = first.motion(&mut lights, &mut depth, &mut warnings)?;
    if motion.is_none() && !scene.later.is_empty() {
        return plan_with_closed_shutter(scene, options);
    }
    if needs_light && lights.is_dark && scene.environment.is_none() {
        return plan_under_white_sky(scene, options);
    }
    images.pack(scene, &mut data)?;
    *data.buffer_mut(Buffer::Params) = materials.params;
    let between = match options.tracer {
        TracerNode::Path(_) | TracerNode::Bidirectional(_) => Between {
            media: materials.media,
            dispersion: materials.programs.iter().any(Program::disperses),
        },
        TracerNode::AmbientOcclusion | TracerNode::Debug(_) => Between::default(),
    };
    warnings.extend(materials.warnings);

    let mut plan = Plan {
        name: scene.name.clone(),
        binding: options.binding,
        light_picks: lights.picks,
        structure: Structure {
            programs: materials.programs,
            lights: lights.kinds,
            light_tree: lights.tree,
            camera,
            sampler: options.sampler,
            tracer: options.tracer,
            between,
            layers: options.layers,
        },
        data,
        motion,
        materials: materials.uses,
        objects: geometry.objects,
        lights: lights.uses,
        depth,
        camera_name: shot.camera.name,
        diagonal: 2.0 * geometry.bounds.sphere().1,
        warnings,
        dismissed,
    };
    if options.layers.has(Layer::Position) && scene.origin != DVec3::ZERO {
        plan.warnings.push(Warning {
            kind: WarningKind::Unfaithful,
            place: "layer \"position\"".to_owned(),
            message: format!(
                "the scene is far from the origin: positions are relative to {}",
                scene.origin
            ),
        });
    }
    let of_objects = [
        Layer::MaterialIndex,
        Layer::CryptoObject,
        Layer::CryptoMaterial,
    ];
    if of_objects.iter().any(|&layer| options.layers.has(layer)) {
        plan.pack_objects();
    }
    Ok(plan)
}

/// Plans a scene in which nothing that is seen moves.
fn plan_with_closed_shutter(scene: &SceneDesc, options: &PlanOptions) -> Result<Plan, PlanError> {
    let mut scene = scene.clone();
    scene.close_shutter();
    let mut plan = plan(&scene, options)?;
    plan.dismissed.push(Dismissed {
        effect: Some(Effect::MotionBlur),
        place: "animations".to_owned(),
        reason: NOTHING_MOVES.to_owned(),
    });
    Ok(plan)
}

/// Plans a scene that has no light of its own.
fn plan_under_white_sky(scene: &SceneDesc, options: &PlanOptions) -> Result<Plan, PlanError> {
    let mut plan = plan(&scene.with_white_sky(), options)?;
    plan.warnings.push(Warning {
        kind: WarningKind::NoLight,
        place: "lights".to_owned(),
        message: "the scene has no light; using a white sky (--env FILE for another)".to_owned(),
    });
    Ok(plan)
}

impl SceneDesc {
    /// The scene under a sky of radiance 1.
    fn with_white_sky(&self) -> Self {
        let mut scene = self.clone();
        scene.images.push(ImageDesc {
            name: "white sky".to_owned(),
            width: 1,
            height: 1,
            texels: Texels::RgbaF32(vec![[1.0; 4]]),
        });
        let image = scene.images.len() - 1;
        scene.environment = Some(EnvironmentDesc {
            image,
            strength: 1.0,
            rotation: 0.0,
        });
        scene
    }
}
