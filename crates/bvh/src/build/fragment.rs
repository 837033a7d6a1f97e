//! What the top-down builder (`sbvh.rs`) sorts: boxes around triangles or parts of them.

use glam::{Vec3A, Vec4};

/// An axis-aligned box in vector registers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Box3 {
    pub(crate) lo: Vec3A,
    pub(crate) hi: Vec3A,
}

impl Box3 {
    pub(crate) const EMPTY: Box3 = Box3 {
        lo: Vec3A::INFINITY,
        hi: Vec3A::NEG_INFINITY,
    };

    #[inline(always)]
    pub(crate) fn grow(&mut self, lo: Vec3A, hi: Vec3A) {
        self.lo = self.lo.min(lo);
        self.hi = self.hi.max(hi);
    }

    #[inline(always)]
    pub(crate) fn union(&self, other: &Box3) -> Box3 {
        Box3 {
            lo: self.lo.min(other.lo),
            hi: self.hi.max(other.hi),
        }
    }

    #[inline(always)]
    pub(crate) fn intersection(&self, other: &Box3) -> Box3 {
        Box3 {
            lo: self.lo.max(other.lo),
            hi: self.hi.min(other.hi),
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.lo.cmpgt(self.hi).any()
    }

    pub(crate) fn size(&self) -> Vec3A {
        self.hi - self.lo
    }

    /// Half the surface area; infinite or NaN if the box is empty.
    #[inline(always)]
    pub(crate) fn half_area(&self) -> f32 {
        let [x, y, z] = self.size().to_array();
        x * (y + z) + y * z
    }
}

/// A triangle or a part of one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fragment {
    /// Least coordinates, and the triangle's index as bits.
    lo: Vec4,
    /// Greatest coordinates, and the number of times the fragment may be split as bits.
    hi: Vec4,
}

impl Fragment {
    pub(crate) fn new(prim: u32, bounds: &Box3, credits: u32) -> Fragment {
        Fragment {
            lo: bounds.lo.extend(f32::from_bits(prim)),
            hi: bounds.hi.extend(f32::from_bits(credits)),
        }
    }

    #[inline(always)]
    pub(crate) fn bounds(&self) -> Box3 {
        Box3 {
            lo: Vec3A::from_vec4(self.lo),
            hi: Vec3A::from_vec4(self.hi),
        }
    }

    /// Twice the centre of the box.
    #[inline(always)]
    pub(crate) fn center(&self) -> Vec3A {
        Vec3A::from_vec4(self.lo) + Vec3A::from_vec4(self.hi)
    }

    #[inline(always)]
    pub(crate) fn prim(&self) -> u32 {
        self.lo.w.to_bits()
    }

    #[inline(always)]
    pub(crate) fn credits(&self) -> u32 {
        self.hi.w.to_bits()
    }
}

/// What is known of the fragments of a node. Merging is exact and takes any order.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Summary {
    pub(crate) bounds: Box3,
    /// Box around twice the fragments' centres.
    pub(crate) centers: Box3,
    pub(crate) count: usize,
    pub(crate) credits: usize,
}

impl Summary {
    pub(crate) const EMPTY: Summary = Summary {
        bounds: Box3::EMPTY,
        centers: Box3::EMPTY,
        count: 0,
        credits: 0,
    };

    pub(crate) fn of(fragments: &[Fragment]) -> Summary {
        let mut summary = Summary::EMPTY;
        fragments.iter().for_each(|fragment| summary.add(fragment));
        summary
    }

    #[inline(always)]
    pub(crate) fn add(&mut self, fragment: &Fragment) {
        let (bounds, center) = (fragment.bounds(), fragment.center());
        self.bounds.grow(bounds.lo, bounds.hi);
        self.centers.grow(center, center);
        self.count += 1;
        self.credits += fragment.credits() as usize;
    }

    pub(crate) fn merge(&self, other: &Summary) -> Summary {
        Summary {
            bounds: self.bounds.union(&other.bounds),
            centers: self.centers.union(&other.centers),
            count: self.count + other.count,
            credits: self.credits + other.credits,
        }
    }

    /// Slots that the fragments and everything that they may be split into need.
    pub(crate) fn slots(&self) -> usize {
        self.count + self.credits
    }
}
