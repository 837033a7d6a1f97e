//! What a renderer of tiles is asked for, and what it reports.

use residual_render::domain::Buffers;
use residual_render::film::{SampleSet, TileSamples};
use residual_render::layer::Layers;
use residual_render::passes::Counters;
use residual_render::tracer::{MAX_DEPTH, TracerOptions};

use crate::traversal::Traversal;

/// What is to be rendered: samples of some tiles. Their paths share streams, so that small tiles cost no more than large ones.
#[derive(Clone, Copy, Debug)]
pub struct TileJob<'a> {
    /// Which samples of which pixels.
    pub tiles: &'a [TileSamples],
    /// The set of samples that the tiles are of.
    pub set: SampleSet,
    /// What the tracer is told.
    pub tracer: TracerOptions,
}

impl TileJob<'_> {
    /// How many samples there are in all.
    pub fn samples(&self) -> usize {
        self.tiles.iter().map(TileSamples::count).sum()
    }

    /// Most splats that paths from lights make: one at each vertex but the light.
    pub fn most_splats(&self) -> usize {
        let depth = self.tracer.max_depth.min(MAX_DEPTH);
        self.samples() * depth.saturating_sub(1) as usize
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

    /// Whether a sample of the image is also a path from a light for each pixel
    /// ([`PathOrigin::Lights`](residual_render::tracer::PathOrigin)).
    fn has_light_paths(&self) -> bool;

    /// Renders the job into `samples`, which is overwritten: tile after tile, `[sample][row][column][channel]` each, as many
    /// channels as [`Layers::stride`] says.
    ///
    /// Of a job whose paths begin at lights, `samples` becomes a list: red, green, blue, and the bits of the index in
    /// `[sample][row][column]` of the whole image, as many as [`Counters::splats`] says. It needs room for
    /// [`TileJob::most_splats`] of them.
    fn render_tiles(
        &self,
        scene: &SceneView<'_>,
        job: &TileJob<'_>,
        samples: &mut [f32],
    ) -> Counters;
}
