//! What the user chooses of a plan.

use residual_render::layer::Layers;
use residual_render::sampler::AnySampler;
use residual_render::tracer::{AnyMis, TracerNode};

use super::camera_choice::CameraChoice;
use super::optics::Optics;

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

/// How bodies that transmit lie to each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum BodyRule {
    /// Within each other, where their boxes overlap.
    #[default]
    Nested,
    /// Beside each other: whoever leaves one is outside.
    Beside,
}

/// How often each light is picked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LightPicks {
    /// From a tree where there are many lights at finite places among which it pays, mixed elsewhere.
    #[default]
    Auto,
    /// Half of the picks by power, half evenly by kind, so that a bright sky outside does not starve the lamps inside.
    Mixed,
    /// By power.
    Power,
    /// Each light as often as any other.
    Uniform,
    /// From a tree, by what may arrive at the point; those infinitely far away as often as mixed picks have them.
    Tree,
}

/// Where on emitting triangles light samples lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LightPlaces {
    /// Evenly by solid angle where triangles are so near to surfaces that it pays, evenly by area elsewhere.
    #[default]
    Auto,
    /// Evenly by area.
    Area,
    /// Evenly by solid angle, as the point sees the triangle.
    SolidAngle,
}

/// At which resolution textures are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum TextureResolution {
    /// At that of their images.
    #[default]
    Full,
    /// Colours of surfaces, where their samplers ask for mipmaps, at that of what a ray stands for.
    Filtered,
}

/// The user's choices.
#[derive(Debug, Clone)]
pub struct PlanOptions {
    /// Binding times.
    pub binding: Binding,
    /// Which camera.
    pub camera: CameraChoice,
    /// What is put before its eye.
    pub optics: Optics,
    /// Width and height of the image in pixels.
    pub size: [u32; 2],
    /// Culling.
    pub culling: CullingRule,
    /// How bodies lie to each other.
    pub bodies: BodyRule,
    /// All triangles are flat, whatever normals they have.
    pub flat_normals: bool,
    /// How often each light is picked.
    pub light_picks: LightPicks,
    /// Where on emitting triangles light samples lie.
    pub light_places: LightPlaces,
    /// At which resolution textures are read.
    pub textures: TextureResolution,
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
            optics: Optics::default(),
            size: [640, 480],
            culling: CullingRule::default(),
            bodies: BodyRule::default(),
            flat_normals: false,
            light_picks: LightPicks::default(),
            light_places: LightPlaces::default(),
            textures: TextureResolution::default(),
            sampler: AnySampler::Sobol,
            tracer: TracerNode::default(),
            layers: Layers::NONE,
        }
    }
}

impl PlanOptions {
    /// Whether single-sided surfaces are seen from their front only. Light paths would have to be stopped by other surfaces than
    /// paths from the camera: what a ray passes from behind, its reverse does not.
    pub(super) fn culls(&self) -> bool {
        self.culling == CullingRule::Gltf && !self.tracer.has_light_paths()
    }

    /// How often each light is picked by the tracer. Paths that begin at lights know no point to pick them for.
    pub(super) fn light_picks_of_tracer(&self) -> LightPicks {
        match self.light_picks {
            LightPicks::Auto | LightPicks::Tree if self.tracer.has_light_paths() => {
                LightPicks::Mixed
            }
            picks => picks,
        }
    }

    /// Whether what light samples miss is found by BSDF samples at full weight: in paths from the camera that weigh the two against each other.
    pub(super) fn bsdf_samples_find_lights(&self) -> bool {
        matches!(
            self.tracer,
            TracerNode::Path(AnyMis::PowerHeuristic | AnyMis::BalanceHeuristic)
        )
    }

    /// Where light samples of the tracer lie on emitting triangles. Light leaves them evenly by area, which is what light paths are
    /// weighed against. What moves may come near, or be a light: places by area need nothing of the triangles' planes.
    pub(super) fn light_places_of_tracer(&self, moves: bool) -> LightPlaces {
        match moves || self.tracer.has_light_paths() {
            true => LightPlaces::Area,
            false => self.light_places,
        }
    }
}
