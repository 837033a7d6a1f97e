//! What the materials of a scene amount to.

use residual_render::program::Program;
use residual_render::tracer::MediaNode;

use super::planned::MaterialUse;
use crate::desc::{Dismissed, Warning};

/// What a triangle's material amounts to.
#[derive(Debug, Clone)]
pub(super) struct PlannedMaterial {
    /// Index of its program.
    pub(super) program: u32,
    /// First word of its parameters.
    pub(super) params: u32,
    /// Its surfaces are not seen from behind.
    pub(super) culled: bool,
    /// It has an alpha test.
    pub(super) alpha_tested: bool,
    /// Index of the medium behind its surfaces, where they are those of bodies.
    pub(super) interior: Option<u32>,
}

/// All materials, planned. Those that no instance uses, or whose surfaces are never there, are not.
#[derive(Debug, Clone, Default)]
pub(super) struct Materials {
    pub(super) programs: Vec<Program>,
    pub(super) uses: Vec<Vec<MaterialUse>>,
    pub(super) params: Vec<u32>,
    /// The media that paths meet.
    pub(super) media: Option<MediaNode>,
    /// What [`Buffer::Media`](residual_render::domain::Buffer::Media) holds; nothing where paths meet none.
    pub(super) media_words: Vec<u32>,
    pub(super) warnings: Vec<Warning>,
    /// By the material's index in the description.
    pub(super) planned: Vec<Option<PlannedMaterial>>,
    pub(super) dismissed: Vec<Dismissed>,
}

impl Materials {
    /// Whether any program reads textures at a resolution that depends on the camera.
    pub(super) fn filter(&self) -> bool {
        self.programs.iter().any(Program::filters)
    }

    pub(super) fn of(&self, material: usize) -> &PlannedMaterial {
        self.planned[material]
            .as_ref()
            .expect("materials of visible meshes are planned")
    }
}
