//! What a renderer of tiles is asked for, and what it reports.

use residual_render::domain::Buffers;
use residual_render::film::{SampleSet, TileRect};
use residual_render::layer::Layers;
use residual_render::passes::{Counters, Pass};
use residual_render::tracer::TracerOptions;

use crate::traversal::Traversal;

/// What is to be rendered.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct TileJob {
    /// x, y, width and height of the tile.
    pub tile: [u32; 4],
    /// Index of the first sample, and how many.
    pub samples: [u32; 2],
    /// What the tracer is told.
    pub tracer: TracerOptions,
    /// Pixels along the side of the blocks of which each has one of the tile's pixels; 1 if the tile is of the image.
    pub block: u32,
}

const _: () = assert!(size_of::<TileJob>() == 52);

impl TileJob {
    /// The job of a tile of a set of samples.
    pub fn new(rect: TileRect, set: SampleSet, pass: Pass, tracer: TracerOptions) -> Self {
        Self {
            tile: [rect.x, rect.y, rect.width, rect.height],
            samples: [pass.first, pass.count],
            tracer,
            block: match set {
                SampleSet::First => 1,
                SampleSet::Second { block } => block,
            },
        }
    }

    /// The set of samples that the tile is of.
    pub fn set(&self) -> SampleSet {
        match self.block {
            1 => SampleSet::First,
            block => SampleSet::Second { block },
        }
    }

    /// The tile as a rectangle.
    pub fn rect(&self) -> TileRect {
        let [x, y, width, height] = self.tile;
        TileRect {
            x,
            y,
            width,
            height,
        }
    }
}

/// A scene's data, ready to be rendered.
#[derive(Clone, Copy)]
pub struct SceneView<'a> {
    /// Its buffers.
    pub buffers: Buffers<'a>,
    /// What traces rays against its triangles.
    pub traversal: &'a (dyn Traversal + Sync),
}

/// Renders tiles of one scene structure: interpreted, compiled in, or loaded.
pub trait TileRenderer: Sync {
    /// The layers that it fills beside radiance.
    fn layers(&self) -> Layers;

    /// Renders the job into `samples[sample][row][column][channel]`, which is overwritten: as many channels as
    /// [`Layers::stride`] says.
    fn render_tile(&self, scene: &SceneView<'_>, job: &TileJob, samples: &mut [f32]) -> Counters;
}
