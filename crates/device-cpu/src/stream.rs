//! Streams: paths, their hits and shadow rays, as records of whole rows of four words.
//!
//! Records move to and from lanes by transposition in registers: a path is one cache line to read and to write, in
//! whatever order, so that sorting moves numbers only, compaction is a store, and traversal finds its rays as it wants
//! them. (Columns would be read one gather a component.)

use std::ops::Range;

use residual_bvh::{Hit, Ray};
use residual_render::domain::{Buffers, Lanes, MAX_LANES};
use residual_render::math::vec3::vec3;
use residual_render::sampler::SampleKey;
use residual_render::surface::{PathRay, SurfaceHit};
use residual_render::tracer::{Path, PathState, Shadow};
use residual_render::triangle::program_in;

use crate::ahead;
use crate::samples::Samples;

type Row = [u32; 4];

/// No ray: what streams are filled with.
const NOWHERE: Ray = Ray {
    org: [0.0; 3],
    tmin: 0.0,
    dir: [0.0; 3],
    tmax: 0.0,
};

/// The rays' two rows. The first distance is 0: rays start beyond the error of their origin.
#[inline(always)]
fn ray_rows<D: Lanes>(d: D, ray: &PathRay<D>) -> [[Row; MAX_LANES]; 2] {
    let bits = |x: D::F| d.to_bits(x);
    let (o, v) = (&ray.org, &ray.dir);
    [
        d.rows([bits(o.x), bits(o.y), bits(o.z), d.uint(0)]),
        d.rows([bits(v.x), bits(v.y), bits(v.z), bits(ray.tmax)]),
    ]
}

#[inline(always)]
fn ray_of_rows([ox, oy, oz, tmin]: Row, [dx, dy, dz, tmax]: Row) -> Ray {
    let real = f32::from_bits;
    Ray {
        org: [real(ox), real(oy), real(oz)],
        tmin: real(tmin),
        dir: [real(dx), real(dy), real(dz)],
        tmax: real(tmax),
    }
}

/// Appends the lanes whose bit is set to records that have room for all: `put(place, lane)` for each lane, the next one
/// in the same place if the bit is not set. Returns the new length.
#[inline(always)]
fn compact<D: Lanes>(bits: u32, mut len: usize, mut put: impl FnMut(usize, usize)) -> usize {
    if bits == 0 {
        return len;
    }
    for lane in 0..D::LANES {
        put(len, lane);
        len += (bits >> lane & 1) as usize;
    }
    len
}

/// What a path carries beside its ray.
#[derive(Clone, Copy)]
struct State {
    /// Throughput and density.
    weight: Row,
    /// Sample key, the index of its sample among those of the job, and what it remembers.
    origin: Row,
}

/// Paths between two hits.
pub(crate) struct PathStream {
    rays: Vec<Ray>,
    states: Vec<State>,
    /// [`Path::rivals`] of each; empty where the tracer has none.
    rivals: Vec<f32>,
    len: usize,
}

impl PathStream {
    /// An empty stream of at most this many paths.
    pub(crate) fn with_capacity(capacity: usize, has_rivals: bool) -> Self {
        let nothing = State {
            weight: [0; 4],
            origin: [0; 4],
        };
        Self {
            rays: vec![NOWHERE; capacity + MAX_LANES],
            states: vec![nothing; capacity + MAX_LANES],
            rivals: match has_rivals {
                true => vec![0.0; capacity + MAX_LANES],
                false => Vec::new(),
            },
            len: 0,
        }
    }

    #[inline(always)]
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// Whether the paths of all lanes can be added.
    #[inline(always)]
    pub(crate) fn has_room(&self) -> bool {
        self.len + 2 * MAX_LANES <= self.rays.len()
    }

    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        self.len = 0;
    }

    /// The paths' rays.
    pub(crate) fn rays(&self) -> &[Ray] {
        &self.rays[..self.len]
    }

    /// The index of the sample that a path belongs to.
    pub(crate) fn sample(&self, path: usize) -> u32 {
        self.states[path].origin[2]
    }

    /// The paths with these `LANES` indices, and the samples that they belong to.
    #[inline(always)]
    pub(crate) fn load<D: Lanes>(&self, d: D, members: &[usize; MAX_LANES]) -> (Path<D>, D::U) {
        let real = |x: D::U| d.from_bits(x);
        let [ox, oy, oz, _] = d.columns(|lane| {
            let Ray { org: [x, y, z], .. } = self.rays[members[lane]];
            [x.to_bits(), y.to_bits(), z.to_bits(), 0]
        });
        let [dx, dy, dz, tmax] = d.columns(|lane| {
            let ray = &self.rays[members[lane]];
            let [x, y, z] = ray.dir;
            [x.to_bits(), y.to_bits(), z.to_bits(), ray.tmax.to_bits()]
        });
        let [r, g, b, pdf] = d.columns(|lane| self.states[members[lane]].weight);
        let [pixel, index, sample, state] = d.columns(|lane| self.states[members[lane]].origin);
        let path = Path {
            ray: PathRay {
                org: vec3(real(ox), real(oy), real(oz)),
                dir: vec3(real(dx), real(dy), real(dz)),
                tmax: real(tmax),
            },
            throughput: vec3(real(r), real(g), real(b)),
            pdf: real(pdf),
            rivals: self.rivals(d, members),
            key: SampleKey { pixel, index },
            state: PathState(state),
        };
        (path, sample)
    }

    #[inline(always)]
    fn rivals<D: Lanes>(&self, d: D, members: &[usize; MAX_LANES]) -> D::F {
        if self.rivals.is_empty() {
            return d.lit(0.0);
        }
        let values = members.map(|member| self.rivals[member].to_bits());
        d.from_bits(d.word(&values[..D::LANES]))
    }

    /// Appends the paths whose bit is set, which belong to these samples.
    #[inline(always)]
    pub(crate) fn push<D: Lanes>(&mut self, d: D, bits: u32, path: &Path<D>, sample: D::U) {
        let [orgs, dirs] = ray_rows(d, &path.ray);
        let [r, g, b] = [path.throughput.x, path.throughput.y, path.throughput.z];
        let weights = d.rows([
            d.to_bits(r),
            d.to_bits(g),
            d.to_bits(b),
            d.to_bits(path.pdf),
        ]);
        let origins = d.rows([path.key.pixel, path.key.index, sample, path.state.0]);
        if !self.rivals.is_empty() {
            let mut values = [0; MAX_LANES];
            d.store_word(d.to_bits(path.rivals), &mut values[..D::LANES]);
            compact::<D>(bits, self.len, |at, lane| {
                self.rivals[at] = f32::from_bits(values[lane]);
            });
        }
        self.len = compact::<D>(bits, self.len, |at, lane| {
            self.rays[at] = ray_of_rows(orgs[lane], dirs[lane]);
            self.states[at] = State {
                weight: weights[lane],
                origin: origins[lane],
            };
        });
    }
}

/// Shadow rays with what they are worth.
pub(crate) struct ShadowStream {
    rays: Vec<Ray>,
    /// Contribution, and the index of the sample it belongs to.
    worth: Vec<Row>,
    occluded: Vec<bool>,
    len: usize,
}

impl ShadowStream {
    /// An empty stream of at most this many rays.
    pub(crate) fn with_capacity(capacity: usize) -> Self {
        Self {
            rays: vec![NOWHERE; capacity + MAX_LANES],
            worth: vec![[0; 4]; capacity + MAX_LANES],
            occluded: vec![false; capacity],
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

    /// The rays, and where it is said whether they are occluded.
    pub(crate) fn rays_and_answers(&mut self) -> (&[Ray], &mut [bool]) {
        (&self.rays[..self.len], &mut self.occluded[..self.len])
    }

    /// Adds what the rays that are not occluded are worth to their samples.
    pub(crate) fn add_to(&self, samples: &mut Samples<'_>) {
        for (&row, &occluded) in self.worth.iter().zip(&self.occluded[..self.len]) {
            if !occluded {
                samples.add_row(row);
            }
        }
    }

    /// Appends the rays whose bit is set.
    #[inline(always)]
    pub(crate) fn push<D: Lanes>(&mut self, d: D, bits: u32, shadow: &Shadow<D>, sample: D::U) {
        let [orgs, dirs] = ray_rows(d, &shadow.ray);
        let worth = &shadow.contribution;
        let [r, g, b] = [worth.x, worth.y, worth.z];
        let worth = d.rows([d.to_bits(r), d.to_bits(g), d.to_bits(b), sample]);
        self.len = compact::<D>(bits, self.len, |at, lane| {
            self.rays[at] = ray_of_rows(orgs[lane], dirs[lane]);
            self.worth[at] = worth[lane];
        });
    }
}

/// Hits of a path stream, and the order that puts paths with the same program side by side.
pub(crate) struct SortedHits {
    hits: Vec<Hit>,
    /// Program of each path; the number of programs for a miss.
    programs: Vec<u32>,
    /// Path that belongs at each place.
    order: Vec<u32>,
    /// First place of each program, of the misses, and the end.
    starts: Vec<usize>,
}

impl SortedHits {
    /// For at most this many paths.
    pub(crate) fn with_capacity(capacity: usize, programs: usize) -> Self {
        Self {
            hits: vec![Hit::miss(0.0); capacity],
            programs: vec![0; capacity],
            order: vec![0; capacity],
            starts: vec![0; programs + 2],
        }
    }

    /// Where the hits of these paths belong.
    pub(crate) fn answers(&mut self, paths: Range<usize>) -> &mut [Hit] {
        &mut self.hits[paths]
    }

    /// Sorts the first `len` paths by program: a counting sort, stable.
    #[inline(always)]
    pub(crate) fn sort(&mut self, len: usize, buffers: &Buffers<'_>) {
        let miss = self.starts.len() as u32 - 2;
        self.starts.fill(0);
        let hits = &self.hits[..len];
        for (path, (hit, program)) in hits.iter().zip(&mut self.programs).enumerate() {
            if let Some(later) = hits.get(path + ahead::PROGRAMS_AHEAD) {
                ahead::triangle(buffers, later.prim);
            }
            *program = if hit.is_hit() {
                program_in(buffers, hit.prim)
            } else {
                miss
            };
            self.starts[*program as usize + 1] += 1;
        }
        for k in 1..self.starts.len() {
            self.starts[k] += self.starts[k - 1];
        }
        // The starts serve as cursors, and are shifted back afterwards.
        for (path, &program) in self.programs[..len].iter().enumerate() {
            let cursor = &mut self.starts[program as usize];
            self.order[*cursor] = path as u32;
            *cursor += 1;
        }
        self.starts.rotate_right(1);
        self.starts[0] = 0;
    }

    /// The triangles hit by the paths at `LANES` places from one on; beyond the last path, some others.
    #[inline(always)]
    pub(crate) fn triangles<D: Lanes>(&self, first: usize) -> impl Iterator<Item = u32> {
        let places = self.order.get(first..).unwrap_or_default();
        let paths = places.iter().take(D::LANES);
        paths.map(|&path| self.hits[path as usize].prim)
    }

    /// Places of the paths that hit a program; of the misses, for the number of programs.
    pub(crate) fn range(&self, program: usize) -> Range<usize> {
        self.starts[program]..self.starts[program + 1]
    }

    /// The path at each of `LANES` places from the first of `range` on; beyond its end, the last again.
    #[inline(always)]
    pub(crate) fn members(&self, range: Range<usize>) -> [usize; MAX_LANES] {
        let order = &self.order[range];
        let mut members = [0; MAX_LANES];
        for (lane, member) in members.iter_mut().enumerate() {
            *member = order[lane.min(order.len() - 1)] as usize;
        }
        members
    }

    /// The hits of `LANES` paths of these numbers.
    #[inline(always)]
    pub(crate) fn load<D: Lanes>(&self, d: D, members: &[usize; MAX_LANES]) -> SurfaceHit<D> {
        let [_, u, v, prim] = d.columns(|lane| {
            let hit = &self.hits[members[lane]];
            [hit.t.to_bits(), hit.u.to_bits(), hit.v.to_bits(), hit.prim]
        });
        SurfaceHit {
            u: d.from_bits(u),
            v: d.from_bits(v),
            prim,
        }
    }
}
