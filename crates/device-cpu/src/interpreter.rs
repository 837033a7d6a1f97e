//! The interpreted tier: a structure's boxed nodes, built for whatever instruction set and lane count is at hand.

use residual_render::layer::Layers;
use residual_render::passes::Counters;
use residual_render::program::{Interpreted, Structure};

use crate::job::{SceneView, TileJob, TileRenderer};
use crate::lanes::LaneCount;
use crate::render_lanes;

/// Renders a structure without compiling it.
#[derive(Clone, Debug)]
pub struct Interpreter {
    structure: Structure,
    lanes: LaneCount,
}

impl Interpreter {
    /// An interpreter of this structure.
    pub fn new(structure: Structure, lanes: LaneCount) -> Self {
        Self { structure, lanes }
    }
}

impl TileRenderer for Interpreter {
    fn layers(&self) -> Layers {
        self.structure.layers
    }

    fn has_light_paths(&self) -> bool {
        self.structure.tracer.has_light_paths()
    }

    fn render_tiles(
        &self,
        scene: &SceneView<'_>,
        job: &TileJob<'_>,
        samples: &mut [f32],
    ) -> Counters {
        let scene_from = &self.structure;
        match self.lanes {
            LaneCount::One => {
                render_lanes!(One, scene, job, samples, |b| Interpreted::new(
                    scene_from, b
                ))
            }
            LaneCount::Four => {
                render_lanes!(Four, scene, job, samples, |b| Interpreted::new(
                    scene_from, b
                ))
            }
            LaneCount::Eight => {
                render_lanes!(Eight, scene, job, samples, |b| Interpreted::new(
                    scene_from, b
                ))
            }
            LaneCount::Sixteen => {
                render_lanes!(Sixteen, scene, job, samples, |b| Interpreted::new(
                    scene_from, b
                ))
            }
        }
    }
}
