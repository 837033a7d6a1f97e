//! Which of the triangles that a ray meets count as hits.

use crate::layout::triangle_packet::SINGLE_SIDED;
use crate::ray::{Hit, Ray};

/// Which sides of a triangle can be hit. The front is the side from which the vertices appear
/// counter-clockwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Culling {
    /// Both sides of every triangle.
    None,
    /// Only the front of every triangle.
    Back,
    /// Both sides, except of the triangles built as single-sided: only their front.
    PerTriangle,
}

/// Decides which intersections are hits. The constants fold away at compile time.
pub trait HitFilter {
    /// Which sides can be hit.
    const CULLING: Culling;
    /// Whether [`accept`](HitFilter::accept) is called at all.
    const REJECTS: bool;

    /// Whether the intersection is a hit (alpha masks, self-intersection). It sees intersections
    /// inside the ray's interval in no particular order and not all of them, so it must be a pure
    /// function of its arguments.
    #[inline(always)]
    fn accept(&self, ray: &Ray, hit: &Hit) -> bool {
        let _ = (ray, hit);
        true
    }
}

/// Every intersection is a hit.
#[derive(Clone, Copy, Debug, Default)]
pub struct AllHits;

/// Fronts are hits, backs are not.
#[derive(Clone, Copy, Debug, Default)]
pub struct FrontHits;

/// Every intersection is a hit, except with the back of a triangle marked as single-sided.
#[derive(Clone, Copy, Debug, Default)]
pub struct MarkedHits;

impl HitFilter for AllHits {
    const CULLING: Culling = Culling::None;
    const REJECTS: bool = false;
}

impl HitFilter for FrontHits {
    const CULLING: Culling = Culling::Back;
    const REJECTS: bool = false;
}

impl HitFilter for MarkedHits {
    const CULLING: Culling = Culling::PerTriangle;
    const REJECTS: bool = false;
}

/// Replaces `best` by a nearer hit, or an equal one on a triangle of smaller index, that counts.
/// `hit.prim` still has its mark; `back` says whether it was hit from behind. Returns whether it
/// did.
#[inline(always)]
pub(crate) fn improve<F: HitFilter>(
    best: &mut Hit,
    mut hit: Hit,
    back: bool,
    ray: &Ray,
    filter: &F,
) -> bool {
    let marked = hit.prim & SINGLE_SIDED != 0;
    hit.prim &= !SINGLE_SIDED;
    let culled = matches!(F::CULLING, Culling::PerTriangle) && marked && back;
    let nearer = hit.t < best.t || (hit.t == best.t && hit.prim < best.prim);
    let improves = nearer && !culled && (!F::REJECTS || filter.accept(ray, &hit));
    if improves {
        *best = hit;
    }
    improves
}
