//! The interpreted tier: a structure's boxed nodes, for the instruction set at hand, in as many lanes as suit it.

use fearless_simd::{Level, Simd, dispatch};
use residual_render::domain::{Lanes, Lanes4, Lanes8, Lanes16};
use residual_render::layer::Layers;
use residual_render::passes::Counters;
use residual_render::program::{Interpreted, Structure};

use crate::job::{SceneView, TileJob, TileRenderer};
use crate::lanes::native;
use crate::tile::render_tiles;

/// Renders a structure without compiling it.
#[derive(Clone, Debug)]
pub struct Interpreter {
    structure: Structure,
}

impl Interpreter {
    /// An interpreter of this structure.
    pub fn new(structure: Structure) -> Self {
        Self { structure }
    }

    /// Renders tiles in a domain, whatever its lanes: who calls it has it compiled for that domain.
    #[inline(always)]
    pub fn render_tiles_in<'a, D: Lanes + 'a>(
        &self,
        d: D,
        scene: &'a SceneView<'a>,
        job: &TileJob<'_>,
        samples: &mut [f32],
    ) -> Counters {
        let interpreted = Interpreted::<D>::new(&self.structure, &scene.buffers);
        render_tiles(d, &interpreted, scene, job, samples)
    }

    /// Renders tiles in as many lanes as suit the instruction set.
    #[inline(always)]
    fn render_natively<S: Simd>(
        &self,
        simd: S,
        scene: &SceneView<'_>,
        job: &TileJob<'_>,
        samples: &mut [f32],
    ) -> Counters {
        let buffers = &scene.buffers;
        if const { native::<S>() >= 16 } {
            self.render_tiles_in(Lanes16::new(simd, buffers), scene, job, samples)
        } else if const { native::<S>() >= 8 } {
            self.render_tiles_in(Lanes8::new(simd, buffers), scene, job, samples)
        } else {
            self.render_tiles_in(Lanes4::new(simd, buffers), scene, job, samples)
        }
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
        dispatch!(Level::new(), simd => self.render_natively(simd, scene, job, samples))
    }
}
