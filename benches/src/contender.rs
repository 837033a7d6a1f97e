//! What is measured: something that traces sets of rays.

use residual_bvh::{Hit, HitPacket, Ray, RayPacket};

/// What is asked about rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Query {
    /// The nearest hit.
    Closest,
    /// Whether there is one.
    Any,
}

/// A tracer with its hierarchy.
pub trait Contender {
    /// Makes room for rays and hits.
    fn prepare(&self, query: Query) -> Box<dyn Prepared + '_>;
}

/// A tracer with a batch of rays and room for the hits.
pub trait Prepared {
    /// Takes a batch of rays, laid out as the tracer likes them; not measured.
    fn load(&mut self, rays: &[Ray]);
    /// Traces the batch, once after each [`load`](Prepared::load); measured.
    fn run(&mut self);
    /// How many rays of the batch hit something.
    fn hits(&self) -> usize;
}

/// A contender that streams rays in and hits out.
pub struct Stream {
    closest: Box<dyn Fn(&[Ray], &mut [Hit])>,
    any: Box<dyn Fn(&[Ray], &mut [bool])>,
}

impl Stream {
    /// From a function for nearest hits and one for occlusion.
    pub fn new(
        closest: impl Fn(&[Ray], &mut [Hit]) + 'static,
        any: impl Fn(&[Ray], &mut [bool]) + 'static,
    ) -> Stream {
        Stream {
            closest: Box::new(closest),
            any: Box::new(any),
        }
    }
}

impl Contender for Stream {
    fn prepare(&self, query: Query) -> Box<dyn Prepared + '_> {
        match query {
            Query::Closest => Box::new(Batch {
                trace: &*self.closest,
                rays: Vec::new(),
                answers: Vec::new(),
                before: Hit::miss(0.0),
                is_hit: Hit::is_hit,
            }),
            Query::Any => Box::new(Batch {
                trace: &*self.any,
                rays: Vec::new(),
                answers: Vec::new(),
                before: false,
                is_hit: |&occluded| occluded,
            }),
        }
    }
}

struct Batch<'a, T> {
    trace: &'a dyn Fn(&[Ray], &mut [T]),
    rays: Vec<Ray>,
    answers: Vec<T>,
    before: T,
    is_hit: fn(&T) -> bool,
}

impl<T: Copy> Prepared for Batch<'_, T> {
    fn load(&mut self, rays: &[Ray]) {
        self.rays.clear();
        self.rays.extend_from_slice(rays);
        self.answers.clear();
        self.answers.resize(rays.len(), self.before);
    }
    fn run(&mut self) {
        (self.trace)(&self.rays, &mut self.answers);
    }
    fn hits(&self) -> usize {
        let is_hit = |answer: &&T| (self.is_hit)(answer);
        self.answers.iter().filter(is_hit).count()
    }
}

/// A contender that is given packets of `R` rays in columns, and answers in columns.
pub struct Columns<const R: usize> {
    closest: Box<dyn Fn(&[RayPacket<R>], &mut [HitPacket<R>])>,
    any: Box<dyn Fn(&[RayPacket<R>], &mut [u32])>,
}

impl<const R: usize> Columns<R> {
    /// From a function for nearest hits and one for occlusion.
    pub fn new(
        closest: impl Fn(&[RayPacket<R>], &mut [HitPacket<R>]) + 'static,
        any: impl Fn(&[RayPacket<R>], &mut [u32]) + 'static,
    ) -> Self {
        Columns {
            closest: Box::new(closest),
            any: Box::new(any),
        }
    }
}

impl<const R: usize> Contender for Columns<R> {
    fn prepare(&self, query: Query) -> Box<dyn Prepared + '_> {
        match query {
            Query::Closest => Box::new(PacketBatch {
                trace: &*self.closest,
                rays: Vec::new(),
                answers: Vec::new(),
                before: HitPacket::misses(&RayPacket::NONE),
                hits: HitPacket::hits,
            }),
            Query::Any => Box::new(PacketBatch {
                trace: &*self.any,
                rays: Vec::new(),
                answers: Vec::new(),
                before: 0,
                hits: |&bits| bits,
            }),
        }
    }
}

struct PacketBatch<'a, T, const R: usize> {
    trace: &'a dyn Fn(&[RayPacket<R>], &mut [T]),
    rays: Vec<RayPacket<R>>,
    answers: Vec<T>,
    before: T,
    hits: fn(&T) -> u32,
}

impl<T: Copy, const R: usize> Prepared for PacketBatch<'_, T, R> {
    fn load(&mut self, rays: &[Ray]) {
        self.rays.clear();
        self.rays.extend(rays.chunks(R).map(RayPacket::of_rays));
        self.answers.clear();
        self.answers.resize(self.rays.len(), self.before);
    }
    fn run(&mut self) {
        (self.trace)(&self.rays, &mut self.answers);
    }
    fn hits(&self) -> usize {
        let hits = |answer| (self.hits)(answer).count_ones() as usize;
        self.answers.iter().map(hits).sum()
    }
}
