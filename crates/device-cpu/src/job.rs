//! What a renderer of tiles is asked for, and what it reports.

use residual_render::domain::Buffers;
use residual_render::film::{SampleSet, TileSamples};
use residual_render::layer::Layers;
use residual_render::passes::Counters;
use residual_render::tracer::TracerOptions;

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

    /// Renders the job into `samples`, which is overwritten: tile after tile, `[sample][row][column][channel]` each, as many
    /// channels as [`Layers::stride`] says.
    fn render_tiles(
        &self,
        scene: &SceneView<'_>,
        job: &TileJob<'_>,
        samples: &mut [f32],
    ) -> Counters;
}
