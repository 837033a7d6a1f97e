//! The interpreter with any number of lanes.

use fearless_simd::{Level, Simd, dispatch};
use residual_device_cpu::lanes::native;
use residual_device_cpu::{Interpreter, LaneCount, SceneView, TileJob, TileRenderer};
use residual_render::domain::{Lanes4, Lanes8, Lanes16, Scalar};
use residual_render::layer::Layers;
use residual_render::passes::Counters;
use residual_render::program::Structure;

/// An [`Interpreter`] with a number of lanes.
#[derive(Clone, Debug)]
pub struct AnyLanes {
    interpreter: Interpreter,
    lanes: LaneCount,
}

impl AnyLanes {
    /// An interpreter of this structure.
    pub fn new(structure: Structure, lanes: LaneCount) -> Self {
        Self {
            interpreter: Interpreter::new(structure),
            lanes,
        }
    }

    /// Lanes that suit the instruction set are those of the interpreter, which has them compiled.
    #[inline(always)]
    fn render<S: Simd>(
        &self,
        simd: S,
        scene: &SceneView<'_>,
        job: &TileJob<'_>,
        samples: &mut [f32],
    ) -> Counters {
        let (interpreter, buffers) = (&self.interpreter, &scene.buffers);
        match self.lanes {
            LaneCount::One => {
                interpreter.render_tiles_in(Scalar::new(buffers), scene, job, samples)
            }
            LaneCount::Four if const { native::<S>() != 4 } => {
                interpreter.render_tiles_in(Lanes4::new(simd, buffers), scene, job, samples)
            }
            LaneCount::Eight if const { native::<S>() != 8 } => {
                interpreter.render_tiles_in(Lanes8::new(simd, buffers), scene, job, samples)
            }
            LaneCount::Sixteen if const { native::<S>() != 16 } => {
                interpreter.render_tiles_in(Lanes16::new(simd, buffers), scene, job, samples)
            }
            LaneCount::Four | LaneCount::Eight | LaneCount::Sixteen => {
                interpreter.render_tiles(scene, job, samples)
            }
        }
    }
}

impl TileRenderer for AnyLanes {
    fn layers(&self) -> Layers {
        self.interpreter.layers()
    }

    fn has_light_paths(&self) -> bool {
        self.interpreter.has_light_paths()
    }

    fn render_tiles(
        &self,
        scene: &SceneView<'_>,
        job: &TileJob<'_>,
        samples: &mut [f32],
    ) -> Counters {
        dispatch!(Level::new(), simd => self.render(simd, scene, job, samples))
    }
}
