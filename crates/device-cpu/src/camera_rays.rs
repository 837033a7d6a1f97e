//! Where a tile's paths begin: the samples of its pixels, one after the other, in blocks of 4×4 pixels, whose rays stay
//! together.

use residual_render::domain::{Lanes, MAX_LANES};
use residual_render::renderer::Renderer;
use residual_render::tracer::Tracer;

use crate::job::TileJob;
use crate::stream::PathStream;

/// Pixels along the side of a block.
const SIDE: usize = 4;

/// The camera rays of a job that are yet to be made.
pub(crate) struct CameraRays<'j> {
    job: &'j TileJob,
    next: usize,
}

impl<'j> CameraRays<'j> {
    pub(crate) fn new(job: &'j TileJob) -> Self {
        Self { job, next: 0 }
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
        let job = self.job;
        let (rect, set) = (job.rect(), job.set());
        let (width, height) = (rect.width as usize, rect.height as usize);
        let blocks = (width.div_ceil(SIDE), height.div_ceil(SIDE));
        let places = blocks.0 * blocks.1 * SIDE * SIDE;
        let end = places * job.samples[1] as usize;
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
                [columns[lane], rows[lane]] = set.pixel(job.tracer.seed, place);
                samples[lane] = ((sample * height + row) * width + column) as u32;
            }
            let pixel = [&columns, &rows].map(|places| d.word(&places[..D::LANES]));
            let of_pixel = d.uint(job.samples[0] + sample as u32);
            let path = tracer.on_emit(d, scene.camera(), pixel, of_pixel);
            paths.push(d, inside, &path, d.word(&samples[..D::LANES]));
            self.next += D::LANES;
        }
    }
}
