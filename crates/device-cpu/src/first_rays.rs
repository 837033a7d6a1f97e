//! Where a job's paths begin: tile after tile, blocks of 4×4 pixels, and in these all samples of a pixel before those of the
//! next, so that rays that follow each other are as much alike as can be.

use residual_render::domain::{Lanes, MAX_LANES};
use residual_render::film::TileSamples;
use residual_render::renderer::Renderer;
use residual_render::tracer::{PathOrigin, Tracer};

use crate::job::TileJob;
use crate::stream::PathStream;

/// Pixels along the side of a block.
const SIDE: usize = 4;

/// Column and row of a block's pixels, neighbours near each other: Morton's order.
const PLACES: [[usize; 2]; SIDE * SIDE] = {
    let mut places = [[0; 2]; SIDE * SIDE];
    let mut i = 0;
    while i < places.len() {
        places[i] = [i & 1 | i >> 1 & 2, i >> 1 & 1 | i >> 2 & 2];
        i += 1;
    }
    places
};

/// The first rays of a job's paths that are yet to be made.
pub(crate) struct FirstRays<'j> {
    job: &'j TileJob<'j>,
    /// The tile whose turn it is, and the index of its first sample among those of the job.
    tile: usize,
    first: usize,
    /// The pixel whose turn it is, those of blocks at the tile's edges counted in full, and which of its samples.
    pixel: usize,
    sample: usize,
}

impl<'j> FirstRays<'j> {
    pub(crate) fn new(job: &'j TileJob<'j>) -> Self {
        Self {
            job,
            tile: 0,
            first: 0,
            pixel: 0,
            sample: 0,
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
        let count = pass.count as usize;
        let pixels = match count {
            0 => 0,
            _ => blocks.0 * blocks.1 * SIDE * SIDE,
        };
        let [image_width, image_height] = job.tracer.image;
        let image = image_width * image_height;
        let mut columns = [0; MAX_LANES];
        let mut rows = [0; MAX_LANES];
        let mut numbers = [0; MAX_LANES];
        let mut samples = [0; MAX_LANES];
        while self.pixel < pixels && paths.has_room() {
            let mut inside = 0;
            for lane in 0..D::LANES {
                let block = self.pixel / PLACES.len();
                let [x, y] = PLACES[self.pixel % PLACES.len()];
                let column = block % blocks.0 * SIDE + x;
                let row = block / blocks.0 * SIDE + y;
                let is_inside = column < width && row < height && self.pixel < pixels;
                inside |= u32::from(is_inside) << lane;
                let place = [rect.x + column as u32, rect.y + row as u32];
                [columns[lane], rows[lane]] = job.set.pixel(job.tracer.seed, place);
                numbers[lane] = pass.first + self.sample as u32;
                samples[lane] = match job.tracer.origin {
                    PathOrigin::Camera => {
                        self.first + (self.sample * height + row) * width + column
                    }
                    // To this the pixel is added that a vertex is seen in.
                    PathOrigin::Lights => self.sample * image as usize,
                } as u32;
                self.sample += 1;
                if self.sample == count {
                    (self.pixel, self.sample) = (self.pixel + 1, 0);
                }
            }
            let [columns, rows, numbers, samples] =
                [&columns, &rows, &numbers, &samples].map(|words| d.word(&words[..D::LANES]));
            let path = tracer.on_emit(d, scene.camera(), scene.lights(), [columns, rows], numbers);
            paths.push(d, inside, &path, samples);
        }
        if self.pixel >= pixels {
            self.tile += 1;
            self.first += tile.count();
            (self.pixel, self.sample) = (0, 0);
        }
    }
}
