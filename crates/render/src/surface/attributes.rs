//! Vertex attributes: which ones a material reads, how they are stored, and their interpolation.

use crate::domain::Domain;
use crate::math::Vec3;
use crate::math::vec3::vec3;
use crate::record::record;

/// Vertex attributes that a material reads. What is not read is not loaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Attributes {
    /// Interpolated normals; without them the surface is flat.
    pub normals: bool,
    /// Tangents.
    pub tangents: bool,
    /// First set of texture coordinates.
    pub uv0: bool,
    /// Second set of texture coordinates.
    pub uv1: bool,
    /// Vertex colours.
    pub colors: bool,
}

impl Attributes {
    /// None at all.
    pub const NONE: Self = Self {
        normals: false,
        tangents: false,
        uv0: false,
        uv1: false,
        colors: false,
    };

    /// What either reads.
    pub fn union(self, other: Self) -> Self {
        Self {
            normals: self.normals | other.normals,
            tangents: self.tangents | other.tangents,
            uv0: self.uv0 | other.uv0,
            uv1: self.uv1 | other.uv1,
            colors: self.colors | other.colors,
        }
    }

    /// What both read.
    pub fn intersection(self, other: Self) -> Self {
        Self {
            normals: self.normals & other.normals,
            tangents: self.tangents & other.tangents,
            uv0: self.uv0 & other.uv0,
            uv1: self.uv1 & other.uv1,
            colors: self.colors & other.colors,
        }
    }
}

record! {
    /// A vertex's normal.
    pub struct NormalRecord in Normals {
        row {
            /// Of any length, world space.
            normal: vector,
        }
    }
}

record! {
    /// A vertex's tangent.
    pub struct TangentRecord in Tangents {
        row {
            /// Of any length, world space; 0 where there is none.
            tangent: vector,
            /// Sign of the bitangent: 1 or −1.
            sign: real,
        }
    }
}

record! {
    /// A vertex's texture coordinates.
    pub struct UvRecord in Uvs {
        row {
            /// u of the first set.
            u0: real,
            /// v of the first set.
            v0: real,
            /// u of the second set.
            u1: real,
            /// v of the second set.
            v1: real,
        }
    }
}

record! {
    /// A vertex's colour.
    pub struct ColorRecord in Colors {
        row {
            /// Linear Rec. 709.
            color: vector,
            /// Alpha.
            alpha: real,
        }
    }
}

/// The records of a triangle's corners.
pub(super) struct Corners<'a, D: Domain, R> {
    pub(super) records: [R; 3],
    weights: &'a [D::F; 3],
}

impl<'a, D: Domain, R> Corners<'a, D, R> {
    #[inline(always)]
    pub(super) fn new(records: [R; 3], weights: &'a [D::F; 3]) -> Self {
        Self { records, weights }
    }

    /// A real number of the records, interpolated.
    #[inline(always)]
    pub(super) fn real(&self, d: D, of: impl Fn(&R) -> D::F) -> D::F {
        let ([a, b, c], w) = (&self.records, self.weights);
        d.fma(of(a), w[0], d.fma(of(b), w[1], of(c) * w[2]))
    }

    /// A vector of the records, interpolated.
    #[inline(always)]
    pub(super) fn vector(&self, d: D, of: impl Fn(&R) -> Vec3<D::F>) -> Vec3<D::F> {
        vec3(
            self.real(d, |record| of(record).x),
            self.real(d, |record| of(record).y),
            self.real(d, |record| of(record).z),
        )
    }
}
