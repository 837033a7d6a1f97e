//! From arguments to a plan.

use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};
use residual_frontend::cryptomatte::Manifest;
use residual_frontend::note;
use residual_frontend::options::{RenderArgs, SceneDefaults};
use residual_frontend::session::Subject;
use residual_frontend::stats::SceneSummary;
use residual_render::sampler::AnySampler;
use residual_scenegen::desc::{NOTHING_MOVES, SceneDesc, Warning, WarningKind};
use residual_scenegen::effects::Effects;
use residual_scenegen::import::{EnvironmentOptions, ImportOptions, import};
use residual_scenegen::plan::{
    Binding, BodyRule, CameraChoice, CullingRule, LightPicks, LightPlaces, Plan, PlanOptions,
    TextureResolution, View, plan,
};

use crate::args::SceneArgs;
use crate::choices::{
    CullingArg, LightPlacesArg, LightsArg, SamplerArg, SpecializeArg, StudioArg, TexturesArg,
};
use crate::time::Exposure;

/// What statistics say about a planned scene.
pub(crate) fn summary(plan: &Plan) -> SceneSummary {
    SceneSummary {
        name: plan.name.clone(),
        triangles: plan.data.triangle_count(),
        programs: plan.structure.programs.len(),
        effects: Effects::of(plan).iter().map(|e| e.to_string()).collect(),
        bytes: plan.memory_bytes(),
        is_bounded: plan.structure.tracer.is_bounded(),
    }
}

/// The names behind the ids of a plan's Cryptomatte layers.
pub(crate) fn manifests(plan: &Plan) -> Vec<Manifest> {
    let layers = plan.structure.layers.iter();
    let manifests = layers.filter_map(|layer| {
        let names = plan.names(layer)?.into_iter().map(str::to_owned).collect();
        Some(Manifest { layer, names })
    });
    manifests.collect()
}

/// What a session renders of a plan.
pub(crate) fn subject<'a>(plan: &'a Plan, manifests: &'a [Manifest]) -> Subject<'a> {
    Subject {
        name: &plan.name,
        layers: plan.structure.layers,
        manifests,
    }
}

/// Reads the scene, and says how it is to be planned.
fn read(args: &SceneArgs, exposure: Exposure) -> Result<(SceneDesc, PlanOptions)> {
    args.check_tracer()?;
    let environment = args.env.as_ref().map(|path| EnvironmentOptions {
        path: path.clone(),
        strength: args.env_strength,
        rotation_degrees: args.env_rotate,
    });
    let mut scene = import(
        &args.scene,
        &ImportOptions {
            environment,
            variant: args.variant.clone(),
            animation: args.time.animation.clone(),
            time_code: args.time.moment(),
            moments: args.time.moments(exposure),
            strict: args.strict,
        },
    )?;
    set_light_sizes(args, &mut scene);
    let tracer = args.tracer();
    let needs_light = tracer.needs_light() && !scene.instances.is_empty();
    match args.studio {
        StudioArg::Auto if needs_light && scene.is_unlit() => {
            scene.add_studio();
            scene.warnings.push(Warning {
                kind: WarningKind::NoLight,
                place: "lights".to_owned(),
                message: "the scene has no light; it stands in a studio (--env FILE for a sky, --studio never for a white one)"
                    .to_owned(),
            });
        }
        StudioArg::Always => scene.add_studio(),
        StudioArg::Auto | StudioArg::Never => {}
    }
    if args.ground {
        scene.add_ground();
    }
    let view = View {
        eye: args.eye.map(|v| v.0),
        dir: args.dir.map(|v| v.0),
        up: args.up.map(|v| v.0),
        fov: args.fov,
    };
    let camera = match &args.camera {
        Some(name) => CameraChoice::Named(name.clone()),
        None if view == View::default() => CameraChoice::Default,
        None => CameraChoice::View(view),
    };
    let options = PlanOptions {
        binding: match args.specialize {
            SpecializeArg::Structure | SpecializeArg::None => Binding::Structure,
            SpecializeArg::Constants => Binding::Constants,
        },
        camera,
        optics: args.optics(),
        size: args.size.0,
        culling: match args.culling {
            CullingArg::Gltf => CullingRule::Gltf,
            CullingArg::None => CullingRule::None,
        },
        light_picks: match args.lights {
            LightsArg::Auto => LightPicks::Auto,
            LightsArg::Mixed => LightPicks::Mixed,
            LightsArg::Power => LightPicks::Power,
            LightsArg::Uniform => LightPicks::Uniform,
            LightsArg::Tree => LightPicks::Tree,
        },
        light_places: match args.light_places {
            LightPlacesArg::Auto => LightPlaces::Auto,
            LightPlacesArg::Area => LightPlaces::Area,
            LightPlacesArg::SolidAngle => LightPlaces::SolidAngle,
        },
        textures: match args.textures {
            TexturesArg::Full => TextureResolution::Full,
            TexturesArg::Filtered => TextureResolution::Filtered,
        },
        sampler: match args.sampler {
            SamplerArg::Sobol => AnySampler::Sobol,
            SamplerArg::Independent => AnySampler::Independent,
        },
        tracer,
        layers: args.layers(),
        bodies: BodyRule::default(),
        flat_normals: false,
    };
    Ok((scene, options))
}

/// Gives the scene's lights the sizes that are asked for, and warns where there are no such lights.
fn set_light_sizes(args: &SceneArgs, scene: &mut SceneDesc) {
    let has = |scene: &SceneDesc, directional: bool| {
        let mut lights = scene.lights.iter();
        lights.any(|light| light.is_directional() == directional)
    };
    let unused = |option: &str, lights: &str| Warning {
        kind: WarningKind::Unused,
        place: option.to_owned(),
        message: format!("the scene has no {lights}"),
    };
    if let Some(degrees) = args.sun_angle {
        if !has(scene, true) {
            let warning = unused("--sun-angle", "directional light");
            scene.warnings.push(warning);
        }
        scene.set_sun_angle(degrees.to_radians());
    }
    if let Some(radius) = args.light_radius {
        if !has(scene, false) {
            let warning = unused("--light-radius", "point or spot light");
            scene.warnings.push(warning);
        }
        scene.set_light_radius(radius);
    }
}

/// Reads and plans the scene; warnings go to standard error. Without moments to choose, the exposure is the default.
pub(crate) fn load(args: &SceneArgs, exposure: Exposure) -> Result<(Plan, Duration)> {
    let start = Instant::now();
    let (plan, ..) = load_with_description(args, exposure)?;
    Ok((plan, start.elapsed()))
}

/// [`load`] with what the plan was made from.
pub(crate) fn load_with_description(
    args: &SceneArgs,
    exposure: Exposure,
) -> Result<(Plan, SceneDesc, PlanOptions)> {
    let (scene, options) = read(args, exposure)?;
    let mut plan = plan(&scene, &options).with_context(|| args.scene.display().to_string())?;
    if args.time.open_for() > 0.0 && plan.motion.is_none() {
        plan.warnings.push(Warning {
            kind: WarningKind::Unused,
            place: "--shutter".to_owned(),
            message: NOTHING_MOVES.to_owned(),
        });
    }
    for warning in scene.warnings.iter().chain(&plan.warnings) {
        note!(
            "warning: {}: {}: {}",
            args.scene.display(),
            warning.place,
            warning.message
        );
    }
    if args.strict
        && plan
            .warnings
            .iter()
            .any(|warning| warning.kind == WarningKind::Unfaithful)
    {
        bail!(
            "{}: --strict: the warnings above say what is not rendered faithfully",
            args.scene.display()
        );
    }
    Ok((plan, scene, options))
}

/// Says what the stated error is of where a shutter was open.
pub(crate) fn note_motion(plan: &Plan, args: &RenderArgs) {
    if !args.quiet
        && let Some(motion) = &plan.motion
    {
        note!(
            "motion blur: the error is that of the mean over {} moments, whatever there is between them",
            motion.moments.len()
        );
    }
}

/// What a scene suggests where the user asks for nothing.
pub(crate) fn defaults(plan: &Plan) -> SceneDefaults {
    SceneDefaults {
        max_depth: plan.default_max_depth(),
        reach: plan.default_reach(),
    }
}
