//! Where a job's paths begin: tile after tile, the samples of its pixels, one after the other, in blocks of 4×4 pixels, whose camera
//! rays stay together.

use residual_render::domain::{Lanes, MAX_LANES};
use residual_render::film::TileSamples;
use residual_render::renderer::Renderer;
use residual_render::tracer::{PathOrigin, Tracer};

use crate::job::TileJob;
use crate::stream::PathStream;

/// Pixels along the side of a block.
const SIDE: usize = 4;

/// The first rays of a job's paths that are yet to be made.
pub(crate) struct FirstRays<'j> {
    job: &'j TileJob<'j>,
    /// The tile whose turn it is, and the index of its first sample among those of the job.
    tile: usize,
    first: usize,
    /// The next of its rays, those of blocks at its edges counted in full.
    next: usize,
}

impl<'j> FirstRays<'j> {
    pub(crate) fn new(job: &'j TileJob<'j>) -> Self {
        Self {
            job,
            tile: 0,
            first: 0,
            next: 0,
        }
    }

    /// Makes rays until the stream is full or none are left.
    #[inline(always)]
    pub(crate) fn fill<D: Lanes, Sc: Renderer<D>>(
        &mut self,
        d: D,
        scene: &Sc,
        tracer: &Sc::Tracer,
        paths: &mut PathStream,
    ) {
        while paths.has_room()
            && let Some(tile) = self.job.tiles.get(self.tile)
        {
            self.fill_from(d, tile, scene, tracer, paths);
        }
    }

    /// Makes rays until the stream is full or the tile has no more.
    #[inline(always)]
    fn fill_from<D: Lanes, Sc: Renderer<D>>(
        &mut self,
        d: D,
        tile: &TileSamples,
        scene: &Sc,
        tracer: &Sc::Tracer,
        paths: &mut PathStream,
    ) {
        let (job, rect, pass) = (self.job, tile.rect, tile.pass);
        let (width, height) = (rect.width as usize, rect.height as usize);
        let blocks = (width.div_ceil(SIDE), height.div_ceil(SIDE));
        let places = blocks.0 * blocks.1 * SIDE * SIDE;
        let end = places * pass.count as usize;
        let [image_width, image_height] = job.tracer.image;
        let image = image_width * image_height;
        let mut columns = [0; MAX_LANES];
        let mut rows = [0; MAX_LANES];
        let mut samples = [0; MAX_LANES];
        while self.next < end && paths.has_room() {
            // Lane counts divide the pixels of a block, so all lanes have the same sample.
            let (sample, first) = (self.next / places, self.next % places);
            let mut inside = 0;
            for lane in 0..D::LANES {
                let (block, within) = (
                    (first + lane) / (SIDE * SIDE),
                    (first + lane) % (SIDE * SIDE),
                );
                let column = block % blocks.0 * SIDE + within % SIDE;
                let row = block / blocks.0 * SIDE + within / SIDE;
                inside |= u32::from(column < width && row < height) << lane;
                let place = [rect.x + column as u32, rect.y + row as u32];
                [columns[lane], rows[lane]] = job.set.pixel(job.tracer.seed, place);
                samples[lane] = (self.first + (sample * height + row) * width + column) as u32;
            }
            let pixel = [&columns, &rows].map(|places| d.word(&places[..D::LANES]));
            let of_pixel = d.uint(pass.first + sample as u32);
            let path = tracer.on_emit(d, scene.camera(), scene.lights(), pixel, of_pixel);
            let samples = match job.tracer.origin {
                PathOrigin::Camera => d.word(&samples[..D::LANES]),
                // To this the pixel is added that a vertex is seen in.
                PathOrigin::Lights => d.uint(sample as u32 * image),
            };
            paths.push(d, inside, &path, samples);
            self.next += D::LANES;
        }
        if self.next >= end {
            self.tile += 1;
            self.first += tile.count();
            self.next = 0;
        }
    }
}
