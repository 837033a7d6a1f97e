//! What is measured: something that traces sets of rays.

use residual_bvh::{Hit, Ray};

use crate::rays::{Query, RaySet};

/// A tracer with its hierarchy.
pub trait Contender {
    /// Everything that may be done with a set of rays outside the clock.
    fn prepare<'a>(&'a self, set: &'a RaySet) -> Box<dyn Prepared + 'a>;
}

/// A tracer with rays and room for the hits.
pub trait Prepared {
    /// Undoes what the last run did to the rays; not measured.
    fn reset(&mut self);
    /// Traces all rays once; measured.
    fn run(&mut self);
    /// How many rays hit something in the last run.
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
    fn prepare<'a>(&'a self, set: &'a RaySet) -> Box<dyn Prepared + 'a> {
        match set.kind.query() {
            Query::Closest => Box::new(Closest {
                trace: &*self.closest,
                rays: &set.rays,
                hits: vec![Hit::miss(0.0); set.rays.len()],
            }),
            Query::Any => Box::new(Any {
                trace: &*self.any,
                rays: &set.rays,
                occluded: vec![false; set.rays.len()],
            }),
        }
    }
}

struct Closest<'a> {
    trace: &'a dyn Fn(&[Ray], &mut [Hit]),
    rays: &'a [Ray],
    hits: Vec<Hit>,
}

impl Prepared for Closest<'_> {
    fn reset(&mut self) {
        self.hits.fill(Hit::miss(0.0));
    }
    fn run(&mut self) {
        (self.trace)(self.rays, &mut self.hits);
    }
    fn hits(&self) -> usize {
        self.hits.iter().filter(|hit| hit.is_hit()).count()
    }
}

struct Any<'a> {
    trace: &'a dyn Fn(&[Ray], &mut [bool]),
    rays: &'a [Ray],
    occluded: Vec<bool>,
}

impl Prepared for Any<'_> {
    fn reset(&mut self) {
        self.occluded.fill(false);
    }
    fn run(&mut self) {
        (self.trace)(self.rays, &mut self.occluded);
    }
    fn hits(&self) -> usize {
        self.occluded.iter().filter(|&&occluded| occluded).count()
    }
}
