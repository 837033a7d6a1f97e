//! Three real numbers: points, directions and linear Rec. 709 colours.

use std::ops::{Add, Mul, Neg, Sub};

use crate::domain::{Bundle, Domain, Real};

/// Three real numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vec3<F> {
    /// First component; red.
    pub x: F,
    /// Second component; green.
    pub y: F,
    /// Third component; blue.
    pub z: F,
}

/// A colour: linear Rec. 709 red, green, blue.
pub type Color<F> = Vec3<F>;

/// A vector of these components.
#[inline(always)]
pub fn vec3<F>(x: F, y: F, z: F) -> Vec3<F> {
    Vec3 { x, y, z }
}

impl<F> From<[F; 3]> for Vec3<F> {
    #[inline(always)]
    fn from([x, y, z]: [F; 3]) -> Self {
        vec3(x, y, z)
    }
}

impl<F> Vec3<F> {
    /// The components in order.
    #[inline(always)]
    pub fn to_array(self) -> [F; 3] {
        [self.x, self.y, self.z]
    }
}

impl<F: Real> Vec3<F> {
    /// All three components the same.
    #[inline(always)]
    pub fn splat(value: F) -> Self {
        vec3(value, value, value)
    }

    /// The first three words of a row of a buffer.
    #[inline(always)]
    pub fn from_row<D: Domain<F = F>>(d: D, [x, y, z, _]: [D::U; 4]) -> Self {
        vec3(d.from_bits(x), d.from_bits(y), d.from_bits(z))
    }

    /// The components, transformed one by one.
    #[inline(always)]
    pub fn map(self, f: impl Fn(F) -> F) -> Self {
        vec3(f(self.x), f(self.y), f(self.z))
    }

    /// Multiplied by a number.
    #[inline(always)]
    pub fn scale(self, by: F) -> Self {
        self.map(|c| c * by)
    }

    /// Scalar product.
    #[inline(always)]
    pub fn dot<D: Domain<F = F>>(self, d: D, other: Self) -> F {
        d.fma(self.x, other.x, d.fma(self.y, other.y, self.z * other.z))
    }

    /// Vector product. Each component is a difference of rounded products, so that parallel vectors give 0.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        vec3(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }

    /// Euclidean length.
    #[inline(always)]
    pub fn length<D: Domain<F = F>>(self, d: D) -> F {
        d.sqrt(self.dot(d, self))
    }

    /// The unit vector of the same direction, for vectors whose squares neither overflow nor vanish.
    #[inline(always)]
    pub fn normalize<D: Domain<F = F>>(self, d: D) -> Self {
        self.scale(d.lit(1.0) / self.length(d))
    }

    /// The unit vector of the same direction, for vectors of any length; (0, 0, 0) stays as it is.
    ///
    /// The vector is first scaled by its largest component (hard case S-12).
    #[inline(always)]
    pub fn normalize_any<D: Domain<F = F>>(self, d: D) -> Self {
        let largest = self.map(|c| d.abs(c)).max_component(d);
        let safe = d.max(largest, d.lit(1e-37));
        let scaled = self.map(|c| c / safe);
        let length = d.max(scaled.length(d), d.lit(1e-37));
        scaled.map(|c| c / length)
    }

    /// The largest component.
    #[inline(always)]
    pub fn max_component<D: Domain<F = F>>(self, d: D) -> F {
        d.max(d.max(self.x, self.y), self.z)
    }

    /// `self + (other − self)·t`.
    #[inline(always)]
    pub fn lerp(self, other: Self, t: F) -> Self {
        self + (other - self).scale(t)
    }

    /// `self` where the mask holds, else 0.
    #[inline(always)]
    pub fn only<D: Domain<F = F>>(self, d: D, mask: D::M) -> Self {
        self.map(|c| d.select(mask, c, d.lit(0.0)))
    }
}

/// Constants as vectors.
#[inline(always)]
pub fn lit3<D: Domain>(d: D, value: [f32; 3]) -> Vec3<D::F> {
    let [x, y, z] = value.map(|c| d.lit(f64::from(c)));
    vec3(x, y, z)
}

macro_rules! componentwise {
    ($($op:ident $method:ident),*) => {$(
        impl<F: Real> $op for Vec3<F> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                vec3(self.x.$method(other.x), self.y.$method(other.y), self.z.$method(other.z))
            }
        }
    )*};
}
componentwise!(Add add, Sub sub, Mul mul);

impl<F: Real> Neg for Vec3<F> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|c| -c)
    }
}

impl<D: Domain> Bundle<D> for Vec3<D::F> {
    #[inline(always)]
    fn choose(d: D, mask: D::M, a: Self, b: Self) -> Self {
        vec3(
            d.select(mask, a.x, b.x),
            d.select(mask, a.y, b.y),
            d.select(mask, a.z, b.z),
        )
    }
}
