//! The plan: what is static in a scene, and where its dynamic data lie.
//!
//! [`SceneDesc`] → `Plan`: a [`Structure`] (programs, kinds of lights, of the camera, of the sampler) that emitters
//! print and interpreters build, and the [`SceneData`] that it reads. Materials whose structure agrees share a
//! program; what distinguishes them are parameters.

mod alpha_test;
mod bsdfs;
mod camera;
mod closed;
mod explain;
mod geometry;
mod images;
mod lights;
mod materials;
mod program;
mod sources;

use std::collections::BTreeMap;
use std::ops::Range;

use residual_render::domain::Buffer;
use residual_render::layer::{Layer, Layers};
use residual_render::program::{Program, Structure};
use residual_render::sampler::AnySampler;
use residual_render::scene_data::SceneData;
use residual_render::tracer::TracerNode;
use residual_render::triangle::ObjectRecord;

pub use camera::{CameraChoice, View};
pub use explain::{BindingTimes, Decision};

use crate::desc::{Dismissed, EnvironmentDesc, ImageDesc, SceneDesc, Texels, Warning, WarningKind};

/// When an input's value is known to the compiler.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Binding {
    /// 0 and 1, which remove code, are constants; other numbers are parameters, so that materials of the same
    /// structure share a program and an edited colour needs no compiler.
    #[default]
    Structure,
    /// Every number is a constant, as in the thesis.
    Constants,
}

/// Which triangles are seen from behind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CullingRule {
    /// Single-sided surfaces that transmit nothing are seen, block and emit from their front only.
    #[default]
    Gltf,
    /// Both sides of every surface block light.
    None,
}

/// The user's choices.
#[derive(Debug, Clone)]
pub struct PlanOptions {
    /// Binding times.
    pub binding: Binding,
    /// Which camera.
    pub camera: CameraChoice,
    /// Width and height of the image in pixels.
    pub size: [u32; 2],
    /// Culling.
    pub culling: CullingRule,
    /// All triangles are flat, whatever normals they have.
    pub flat_normals: bool,
    /// Sampler.
    pub sampler: AnySampler,
    /// What is computed along rays.
    pub tracer: TracerNode,
    /// What is kept of pixels beside radiance.
    pub layers: Layers,
}

impl Default for PlanOptions {
    fn default() -> Self {
        Self {
            binding: Binding::default(),
            camera: CameraChoice::default(),
            size: [640, 480],
            culling: CullingRule::default(),
            flat_normals: false,
            sampler: AnySampler::Sobol,
            tracer: TracerNode::default(),
            layers: Layers::NONE,
        }
    }
}

/// A scene, analysed.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The scene's name.
    pub name: String,
    /// When inputs are known.
    pub binding: Binding,
    /// The static half.
    pub structure: Structure,
    /// The dynamic half.
    pub data: SceneData,
    /// For each program, the materials that use it.
    pub materials: Vec<Vec<MaterialUse>>,
    /// What is seen, in the order of its triangles: a triangle's object is an index into this list.
    pub objects: Vec<PlannedObject>,
    /// For each kind of light, the lights of that kind.
    pub lights: Vec<LightKindUse>,
    /// The camera that was chosen.
    pub camera_name: String,
    /// Length of the diagonal of the box around everything.
    pub diagonal: f32,
    /// What was changed or left out.
    pub warnings: Vec<Warning>,
    /// What the scene has and the image does not need.
    pub dismissed: Vec<Dismissed>,
}

impl Plan {
    /// Fills [`Buffer::Objects`], which is empty unless a renderer asks for the materials of objects.
    fn pack_objects(&mut self) {
        self.data.buffer_mut(Buffer::Objects).clear();
        for object in &self.objects {
            let material = object.material as u32;
            self.data.push(ObjectRecord { material });
        }
    }
}

/// An instance of a mesh that is seen.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlannedObject {
    /// The instance's name.
    pub name: String,
    /// Index of its material in the description.
    pub material: usize,
    /// Its triangles.
    pub triangles: Range<u32>,
}

/// A material that uses a program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MaterialUse {
    /// Its name.
    pub name: String,
    /// Names of the images that it reads, by their slots among its parameters.
    pub images: BTreeMap<u32, String>,
    /// Its surfaces are not seen from behind.
    pub culled: bool,
}

/// The lights of a kind.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct LightKindUse {
    /// How many there are.
    pub count: usize,
    /// Where they come from, such as `light "Sun"`, each once.
    pub sources: Vec<String>,
}

/// What planning a scene can fail at.
#[derive(Debug, thiserror::Error)]
pub enum PlanError {
    /// The camera asked for is not there.
    #[error("there is no camera {wanted}; the scene has {available}")]
    NoSuchCamera {
        /// As the user wrote it.
        wanted: String,
        /// What there is.
        available: String,
    },
    /// The scene needs more than 2³² words of something.
    #[error(
        "the scene is too large: its {what} do not fit 32-bit indices; split it or simplify it"
    )]
    TooLarge {
        /// What is too large.
        what: &'static str,
    },
}

/// Plans a scene.
///
/// # Errors
/// If the camera asked for does not exist, or the scene does not fit 32-bit indices.
pub fn plan(scene: &SceneDesc, options: &PlanOptions) -> Result<Plan, PlanError> {
    let mut warnings = Vec::new();
    let mut data = SceneData::default();
    let mut images = images::Images::default();

    let materials = materials::plan_materials(scene, options, &mut images, &mut warnings);
    let geometry = geometry::pack(scene, &materials, &mut data, &mut warnings)?;
    // Only paths need lights.
    let lights = match options.tracer {
        TracerNode::Path => {
            lights::plan_lights(scene, &materials, &geometry, &mut images, &mut data)
        }
        TracerNode::AmbientOcclusion | TracerNode::Debug(_) => lights::PlannedLights::default(),
    };
    let needs_light = options.tracer == TracerNode::Path;
    // A black environment is darkness that was asked for.
    if needs_light && lights.kinds.is_empty() && scene.environment.is_none() {
        let mut plan = plan(&scene.with_white_sky(), options)?;
        plan.warnings.push(Warning {
            kind: WarningKind::NoLight,
            place: "lights".to_owned(),
            message: "the scene has no light; using a white sky (--env FILE for another)"
                .to_owned(),
        });
        return Ok(plan);
    }
    let (camera, camera_name) =
        camera::choose(scene, options, &geometry.bounds, &mut data, &mut warnings)?;
    images.pack(scene, &mut data)?;
    *data.buffer_mut(Buffer::Params) = materials.params;

    let mut plan = Plan {
        name: scene.name.clone(),
        binding: options.binding,
        structure: Structure {
            programs: materials.programs,
            lights: lights.kinds,
            camera,
            sampler: options.sampler,
            tracer: options.tracer,
            layers: options.layers,
        },
        data,
        materials: materials.uses,
        objects: geometry.objects,
        lights: lights.uses,
        camera_name,
        diagonal: 2.0 * geometry.bounds.sphere().1,
        warnings,
        dismissed: [&scene.dismissed[..], &materials.dismissed].concat(),
    };
    if options.layers.has(Layer::MaterialIndex) {
        plan.pack_objects();
    }
    Ok(plan)
}

/// What a triangle's material amounts to.
#[derive(Debug, Clone)]
struct PlannedMaterial {
    /// Index of its program.
    program: u32,
    /// First word of its parameters.
    params: u32,
    /// Its surfaces are not seen from behind.
    culled: bool,
    /// It has an alpha test.
    alpha_tested: bool,
}

/// All materials, planned. Those that no instance uses, or whose surfaces are never there, are not.
#[derive(Debug, Clone, Default)]
struct Materials {
    programs: Vec<Program>,
    uses: Vec<Vec<MaterialUse>>,
    params: Vec<u32>,
    /// By the material's index in the description.
    planned: Vec<Option<PlannedMaterial>>,
    dismissed: Vec<Dismissed>,
}

impl Materials {
    fn of(&self, material: usize) -> &PlannedMaterial {
        self.planned[material]
            .as_ref()
            .expect("materials of visible meshes are planned")
    }
}

impl Plan {
    /// How far a tracer reaches unless it is told: [`reach`](residual_render::tracer::TracerOptions::reach).
    pub fn default_reach(&self) -> f32 {
        match self.structure.tracer {
            TracerNode::AmbientOcclusion => 0.1 * self.diagonal,
            TracerNode::Path | TracerNode::Debug(_) => self.diagonal,
        }
    }
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
