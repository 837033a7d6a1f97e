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

/// What a contender is given: rays, laid out as it likes them.
pub trait Layout: Sized {
    /// A batch, in its order.
    fn lay_out(rays: &[Ray]) -> Vec<Self>;
}

impl Layout for Ray {
    fn lay_out(rays: &[Ray]) -> Vec<Ray> {
        rays.to_vec()
    }
}

impl<const R: usize> Layout for RayPacket<R> {
    fn lay_out(rays: &[Ray]) -> Vec<Self> {
        rays.chunks(R).map(RayPacket::of_rays).collect()
    }
}

/// What a contender answers.
pub trait Answer: Copy {
    /// That there are no hits.
    const NONE: Self;
    /// How many there are.
    fn hits(self) -> usize;
}

impl Answer for Hit {
    const NONE: Hit = Hit {
        t: 0.0,
        u: 0.0,
        v: 0.0,
        prim: Hit::NONE,
    };
    fn hits(self) -> usize {
        usize::from(self.is_hit())
    }
}

impl Answer for bool {
    const NONE: bool = false;
    fn hits(self) -> usize {
        usize::from(self)
    }
}

impl<const R: usize> Answer for HitPacket<R> {
    const NONE: Self = HitPacket {
        t: [0.0; R],
        u: [0.0; R],
        v: [0.0; R],
        prim: [Hit::NONE; R],
    };
    fn hits(self) -> usize {
        HitPacket::hits(&self).count_ones() as usize
    }
}

/// A bit for each ray of a packet.
impl Answer for u32 {
    const NONE: u32 = 0;
    fn hits(self) -> usize {
        self.count_ones() as usize
    }
}

/// A contender that streams rays in and answers out: of rays one by one, as it stands here, or of packets in columns.
pub struct Stream<R = Ray, H = Hit, O = bool> {
    closest: Box<dyn Fn(&[R], &mut [H])>,
    any: Box<dyn Fn(&[R], &mut [O])>,
}

impl<R, H, O> Stream<R, H, O> {
    /// From a function for nearest hits and one for occlusion.
    pub fn new(
        closest: impl Fn(&[R], &mut [H]) + 'static,
        any: impl Fn(&[R], &mut [O]) + 'static,
    ) -> Self {
        Stream {
            closest: Box::new(closest),
            any: Box::new(any),
        }
    }
}

impl<R: Layout, H: Answer, O: Answer> Contender for Stream<R, H, O> {
    fn prepare(&self, query: Query) -> Box<dyn Prepared + '_> {
        match query {
            Query::Closest => Box::new(Batch::new(&*self.closest)),
            Query::Any => Box::new(Batch::new(&*self.any)),
        }
    }
}

struct Batch<'a, R, A> {
    trace: &'a dyn Fn(&[R], &mut [A]),
    rays: Vec<R>,
    answers: Vec<A>,
}

impl<'a, R, A> Batch<'a, R, A> {
    fn new(trace: &'a dyn Fn(&[R], &mut [A])) -> Self {
        Batch {
            trace,
            rays: Vec::new(),
            answers: Vec::new(),
        }
    }
}

impl<R: Layout, A: Answer> Prepared for Batch<'_, R, A> {
    fn load(&mut self, rays: &[Ray]) {
        self.rays = R::lay_out(rays);
        self.answers.clear();
        self.answers.resize(self.rays.len(), A::NONE);
    }
    fn run(&mut self) {
        (self.trace)(&self.rays, &mut self.answers);
    }
    fn hits(&self) -> usize {
        self.answers.iter().map(|answer| answer.hits()).sum()
    }
}
