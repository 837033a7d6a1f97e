//! The scene's files.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail, ensure};
use glam::Vec3;
use residual_render::camera::CameraRecord;
use residual_render::program::{CameraNode, LightNode};
use residual_render::tracer::Between;
use residual_scenegen::desc::{LightDesc, PunctualKind, SceneDesc};
use residual_scenegen::plan::{Binding, Plan, PlanOptions, plan};

use super::bsdf::{bsdf, emission};
use super::environment::environment;
use super::raster::Rasters;
use super::shapes::{Shape, shapes};
use super::textures::Textures;
use super::xml::Element;

/// The scene without its sensor, in the folder that [`export`] fills.
pub const SCENE_FILE: &str = "scene.xml";
/// The sensor, whose sampler is the parameter `sampler`.
pub const SENSOR_FILE: &str = "sensor.xml";

/// What was exported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exported {
    /// Meshes, one for each material that is seen.
    pub shapes: usize,
    /// Meshes that emit, and other lights.
    pub lights: usize,
}

/// Writes a scene into a folder that exists: what we render with these options and paths of at most `max_depth` vertices.
///
/// # Errors
/// If a material, a light or the camera has no counterpart, or a file cannot be written.
pub fn export(
    scene: &SceneDesc,
    options: &PlanOptions,
    max_depth: u32,
    folder: &Path,
) -> Result<Exported> {
    let options = PlanOptions {
        binding: Binding::Constants,
        ..options.clone()
    };
    let plan = plan(scene, &options)?;
    anyhow::ensure!(
        plan.structure.between == Between::default(),
        "the scene has bodies that absorb, scatter, disperse or lie within each other, which are not exported to Mitsuba"
    );
    let shapes = shapes(&plan);
    let buffers = plan.data.buffers();
    let mut rasters = Rasters::default();
    let mut elements = Vec::new();
    for (index, shape) in shapes.iter().enumerate() {
        let file = format!("{index}.ply");
        let path = folder.join(&file);
        fs::write(&path, shape.mesh.bytes()).with_context(|| path.display().to_string())?;
        let name = &scene.materials[shape.material].name;
        let mut textures = Textures::new(&plan.data, &buffers, shape.triangle, &mut rasters);
        let element = shape_element(shape, &file, &mut textures).map_err(|lacking| {
            anyhow::anyhow!("material {name:?} has {lacking}, which is not exported to Mitsuba")
        })?;
        elements.push(element);
    }
    let emitters = emitters(scene, &plan, &mut rasters)?;
    rasters.write(folder)?;
    let emits = |shape: &&Shape<'_>| shape.program.emission.is_some();
    let exported = Exported {
        shapes: shapes.len(),
        lights: shapes.iter().filter(emits).count() + emitters.len(),
    };
    // Both count the camera's own vertex out, the light's in. Roulette begins where Mitsuba has it by itself: from the second vertex on, as ours,
    // it would lose efficiency, since it ends paths that are worth less than what they began with.
    let integrator = Element::plugin("integrator", "path")
        .integer("max_depth", max_depth)
        .integer("rr_depth", 5);
    let root = Element::new("scene")
        .attribute("version", "3.0.0")
        .child(integrator)
        .children(elements)
        .children(emitters);
    write_xml(&folder.join(SCENE_FILE), &root)?;
    write_xml(&folder.join(SENSOR_FILE), &sensor(&plan, options.size)?)?;
    Ok(exported)
}

fn write_xml(path: &Path, root: &Element) -> Result<()> {
    fs::write(path, root.to_string()).with_context(|| path.display().to_string())
}

fn shape_element(
    shape: &Shape<'_>,
    file: &str,
    textures: &mut Textures<'_>,
) -> Result<Element, String> {
    let mut element = Element::plugin("shape", "ply").string("filename", file);
    if !shape.program.attributes.normals {
        element = element.enabled("face_normals");
    }
    element = element.child(bsdf(shape.program, textures)?);
    let emission = emission(shape.program)?;
    let area = |radiance| Element::plugin("emitter", "area").rgb("radiance", radiance);
    Ok(element.children(emission.map(area)))
}

/// The lights that are no surfaces.
fn emitters(scene: &SceneDesc, plan: &Plan, rasters: &mut Rasters) -> Result<Vec<Element>> {
    let mut emitters = scene
        .lights
        .iter()
        .map(punctual)
        .collect::<Result<Vec<_>>>()?;
    if plan.structure.lights.contains(&LightNode::Environment) {
        emitters.push(environment(&plan.data, rasters));
    }
    Ok(emitters)
}

fn punctual(light: &LightDesc) -> Result<Element> {
    ensure!(
        light.size == 0.0,
        "light {:?} has a size, and Mitsuba would show it; it is not exported",
        light.name
    );
    Ok(match light.kind {
        PunctualKind::Point { position } => Element::plugin("emitter", "point")
            .triple("point", "position", position.to_array())
            .rgb("intensity", light.intensity),
        PunctualKind::Directional { direction } => Element::plugin("emitter", "directional")
            .triple("vector", "direction", direction.to_array())
            .rgb("irradiance", light.intensity),
        PunctualKind::Spot { .. } => bail!(
            "light {:?} is a spot, whose edge Mitsuba shades in another way; it is not exported",
            light.name
        ),
    })
}

fn sensor(plan: &Plan, [width, height]: [u32; 2]) -> Result<Element> {
    ensure!(
        plan.structure.camera == CameraNode::Perspective,
        "camera {:?} is not a perspective one, and not exported to Mitsuba",
        plan.camera_name
    );
    let camera: CameraRecord = plan.data.record(0);
    let [eye, up, forward] =
        [camera.eye, camera.up, camera.forward].map(|v| Vec3::from(v.to_array()));
    let half_height = up.as_dvec3().length() / forward.as_dvec3().length();
    let list = |v: Vec3| format!("{}, {}, {}", v.x, v.y, v.z);
    let look = Element::new("lookat")
        .attribute("origin", list(eye))
        .attribute("target", list(eye + forward))
        .attribute("up", list(up));
    let transform = Element::new("transform")
        .attribute("name", "to_world")
        .child(look);
    // A box filter, so that pixels share no sample, as ours do not.
    let film = Element::plugin("film", "hdrfilm")
        .integer("width", width)
        .integer("height", height)
        .string("pixel_format", "rgb")
        .string("component_format", "float32")
        .child(Element::plugin("rfilter", "box"));
    Ok(Element::plugin("sensor", "perspective")
        .attribute("version", "3.0.0")
        .string("fov_axis", "y")
        .float("fov", 2.0 * half_height.atan().to_degrees())
        .float("near_clip", 1e-4)
        .float("far_clip", 1e6)
        .child(transform)
        .child(Element::plugin("sampler", "$sampler"))
        .child(film))
}
