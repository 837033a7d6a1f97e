//! Streams: paths, hits and shadow rays in structure-of-arrays form.
//!
//! Columns are `LANES` longer than their capacity, so that the last lanes of a stream can be loaded and stored
//! whole; what lies beyond the length is stale, and masked wherever it would count.

use std::ops::Range;

use residual_bvh::{Hit, Ray};
use residual_render::domain::Lanes;
use residual_render::math::Vec3;
use residual_render::math::vec3::vec3;
use residual_render::sampler::SampleKey;
use residual_render::surface::{self, Ray as LaneRay};
use residual_render::tracer::{Path, Shadow};

use crate::tile::ray;

/// Three columns: a vector or colour for each path.
type Columns3 = [Vec<f32>; 3];

fn columns3(length: usize) -> Columns3 {
    [(); 3].map(|()| vec![0.0; length])
}

#[inline(always)]
fn load3<D: Lanes>(d: D, columns: &Columns3, at: Range<usize>) -> Vec3<D::F> {
    let [x, y, z] = columns.each_ref().map(|column| d.real(&column[at.clone()]));
    vec3(x, y, z)
}

/// Appends the lanes whose bit is set; whole vectors where all are.
struct Compaction {
    bits: u32,
    at: usize,
    all: bool,
}

impl Compaction {
    #[inline(always)]
    fn new<D: Lanes>(bits: u32, at: usize) -> Self {
        Self {
            bits,
            at,
            all: bits == ((1_u64 << D::LANES) - 1) as u32,
        }
    }

    #[inline(always)]
    fn real<D: Lanes>(&self, d: D, value: D::F, column: &mut [f32]) {
        if self.all {
            d.store(value, &mut column[self.at..self.at + D::LANES]);
            return;
        }
        let mut lanes = [0.0; 16];
        d.store(value, &mut lanes[..D::LANES]);
        self.compact(&lanes, column);
    }

    #[inline(always)]
    fn real3<D: Lanes>(&self, d: D, value: Vec3<D::F>, columns: &mut Columns3) {
        for (column, value) in columns.iter_mut().zip([value.x, value.y, value.z]) {
            self.real(d, value, column);
        }
    }

    #[inline(always)]
    fn word<D: Lanes>(&self, d: D, value: D::U, column: &mut [u32]) {
        if self.all {
            d.store_word(value, &mut column[self.at..self.at + D::LANES]);
            return;
        }
        let mut lanes = [0; 16];
        d.store_word(value, &mut lanes[..D::LANES]);
        self.compact(&lanes, column);
    }

    #[inline(always)]
    fn compact<T: Copy>(&self, lanes: &[T; 16], column: &mut [T]) {
        let mut bits = self.bits;
        let to = &mut column[self.at..];
        for place in to.iter_mut().take(bits.count_ones() as usize) {
            *place = lanes[bits.trailing_zeros() as usize & 15];
            bits &= bits - 1;
        }
    }
}

/// Paths between two hits.
pub(crate) struct PathStream {
    org: Columns3,
    dir: Columns3,
    throughput: Columns3,
    pdf: Vec<f32>,
    pixel: Vec<u32>,
    index: Vec<u32>,
    id: Vec<u32>,
    len: usize,
}

impl PathStream {
    pub(crate) fn with_capacity(capacity: usize, lanes: usize) -> Self {
        let length = capacity + lanes;
        Self {
            org: columns3(length),
            dir: columns3(length),
            throughput: columns3(length),
            pdf: vec![0.0; length],
            pixel: vec![0; length],
            index: vec![0; length],
            id: vec![0; length],
            len: 0,
        }
    }

    #[inline(always)]
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        self.len = 0;
    }

    /// Ray number `i`, for traversal.
    #[inline(always)]
    pub(crate) fn ray(&self, i: usize) -> Ray {
        let at = |columns: &Columns3| columns.each_ref().map(|column| column[i]);
        ray(at(&self.org), at(&self.dir), f32::MAX)
    }

    /// `LANES` paths from number `i` on, with their places in the tile.
    #[inline(always)]
    pub(crate) fn load<D: Lanes>(&self, d: D, i: usize) -> (Path<D>, &[u32]) {
        let at = i..i + D::LANES;
        let path = Path {
            ray: LaneRay {
                org: load3(d, &self.org, at.clone()),
                dir: load3(d, &self.dir, at.clone()),
                tmax: d.lit(f64::from(f32::MAX)),
            },
            throughput: load3(d, &self.throughput, at.clone()),
            pdf: d.real(&self.pdf[at.clone()]),
            key: SampleKey {
                pixel: d.word(&self.pixel[at.clone()]),
                index: d.word(&self.index[at.clone()]),
            },
        };
        (path, &self.id[at])
    }

    /// Appends the paths whose bit is set.
    #[inline(always)]
    pub(crate) fn push<D: Lanes>(&mut self, d: D, bits: u32, path: &Path<D>, id: D::U) {
        let to = Compaction::new::<D>(bits, self.len);
        to.real3(d, path.ray.org, &mut self.org);
        to.real3(d, path.ray.dir, &mut self.dir);
        to.real3(d, path.throughput, &mut self.throughput);
        to.real(d, path.pdf, &mut self.pdf);
        to.word(d, path.key.pixel, &mut self.pixel);
        to.word(d, path.key.index, &mut self.index);
        to.word(d, id, &mut self.id);
        self.len += bits.count_ones() as usize;
    }

    fn reals(&mut self) -> impl Iterator<Item = &mut Vec<f32>> {
        let vectors = [&mut self.org, &mut self.dir, &mut self.throughput];
        vectors.into_iter().flatten().chain([&mut self.pdf])
    }
}

/// Shadow rays with what they are worth.
pub(crate) struct ShadowStream {
    org: Columns3,
    dir: Columns3,
    contribution: Columns3,
    tmax: Vec<f32>,
    id: Vec<u32>,
    len: usize,
}

impl ShadowStream {
    pub(crate) fn with_capacity(capacity: usize, lanes: usize) -> Self {
        let length = capacity + lanes;
        Self {
            org: columns3(length),
            dir: columns3(length),
            contribution: columns3(length),
            tmax: vec![0.0; length],
            id: vec![0; length],
            len: 0,
        }
    }

    #[inline(always)]
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        self.len = 0;
    }

    #[inline(always)]
    pub(crate) fn ray(&self, i: usize) -> Ray {
        let at = |columns: &Columns3| columns.each_ref().map(|column| column[i]);
        ray(at(&self.org), at(&self.dir), self.tmax[i])
    }

    /// Adds ray `i`'s contribution to its pixel.
    #[inline(always)]
    pub(crate) fn add_to(&self, i: usize, radiance: &mut [f32]) {
        let pixel = self.id[i] as usize * 3;
        for (channel, column) in self.contribution.iter().enumerate() {
            radiance[pixel + channel] += column[i];
        }
    }

    #[inline(always)]
    pub(crate) fn push<D: Lanes>(&mut self, d: D, bits: u32, shadow: &Shadow<D>, id: D::U) {
        let to = Compaction::new::<D>(bits, self.len);
        to.real3(d, shadow.ray.org, &mut self.org);
        to.real3(d, shadow.ray.dir, &mut self.dir);
        to.real3(d, shadow.contribution, &mut self.contribution);
        to.real(d, shadow.ray.tmax, &mut self.tmax);
        to.word(d, id, &mut self.id);
        self.len += bits.count_ones() as usize;
    }
}

/// Hits of a path stream, and the order that puts paths with the same program side by side.
pub(crate) struct SortedHits {
    u: Vec<f32>,
    v: Vec<f32>,
    prim: Vec<u32>,
    /// Program of each path; the number of programs for a miss.
    program: Vec<u32>,
    /// Path that belongs at each place.
    order: Vec<u32>,
    /// First place of each program, of the misses, and the end.
    starts: Vec<usize>,
    scratch_real: Vec<f32>,
    scratch_word: Vec<u32>,
}

impl SortedHits {
    pub(crate) fn with_capacity(capacity: usize, lanes: usize, programs: usize) -> Self {
        let length = capacity + lanes;
        Self {
            u: vec![0.0; length],
            v: vec![0.0; length],
            prim: vec![0; length],
            program: vec![0; capacity],
            order: vec![0; capacity],
            starts: vec![0; programs + 2],
            scratch_real: vec![0.0; length],
            scratch_word: vec![0; length],
        }
    }

    fn miss(&self) -> usize {
        self.starts.len() - 2
    }

    /// Records the hit of path `i`; `program` is `None` for a miss.
    #[inline(always)]
    pub(crate) fn set(&mut self, i: usize, hit: &Hit, program: Option<u32>) {
        self.u[i] = hit.u;
        self.v[i] = hit.v;
        self.prim[i] = hit.prim;
        self.program[i] = program.unwrap_or(self.miss() as u32);
    }

    /// Sorts hits and paths by program: a counting sort, stable.
    pub(crate) fn sort(&mut self, paths: &mut PathStream) {
        let len = paths.len;
        self.starts.fill(0);
        for &program in &self.program[..len] {
            self.starts[program as usize + 1] += 1;
        }
        for k in 1..self.starts.len() {
            self.starts[k] += self.starts[k - 1];
        }
        // The starts serve as cursors, and are shifted back afterwards.
        for (i, &program) in self.program[..len].iter().enumerate() {
            let cursor = &mut self.starts[program as usize];
            self.order[*cursor] = i as u32;
            *cursor += 1;
        }
        self.starts.rotate_right(1);
        self.starts[0] = 0;

        let order = &self.order[..len];
        for column in paths.reals().chain([&mut self.u, &mut self.v]) {
            permute(column, &mut self.scratch_real, order);
        }
        for column in [
            &mut paths.pixel,
            &mut paths.index,
            &mut paths.id,
            &mut self.prim,
        ] {
            permute(column, &mut self.scratch_word, order);
        }
    }

    /// Places of the paths that hit a program.
    pub(crate) fn range(&self, program: usize) -> Range<usize> {
        self.starts[program]..self.starts[program + 1]
    }

    /// Places of the paths that hit nothing.
    pub(crate) fn misses(&self) -> Range<usize> {
        self.range(self.miss())
    }

    /// `LANES` hits from place `i` on.
    #[inline(always)]
    pub(crate) fn load<D: Lanes>(&self, d: D, i: usize) -> surface::Hit<D> {
        let at = i..i + D::LANES;
        surface::Hit {
            u: d.real(&self.u[at.clone()]),
            v: d.real(&self.v[at.clone()]),
            prim: d.word(&self.prim[at]),
        }
    }
}

fn permute<T: Copy>(column: &mut Vec<T>, scratch: &mut Vec<T>, order: &[u32]) {
    for (place, &from) in scratch.iter_mut().zip(order) {
        *place = column[from as usize];
    }
    std::mem::swap(column, scratch);
}
