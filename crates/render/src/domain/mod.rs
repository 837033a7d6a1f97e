//! The arithmetic domain: what every formula of the renderer is written over.
//!
//! A [`Domain`] is a small `Copy` context that travels by value. Its associated types stand for real numbers,
//! unsigned integers and truth values; how many there are at once, how precise they are, and whether they are
//! computed or written down is the domain's affair:
//!
//! | domain | numbers | for |
//! |---|---|---|
//! | [`Scalar`] | `f32` | alpha tests inside traversal; one lane |
//! | [`Lanes4`], [`Lanes8`], [`Lanes16`] | `f32` in SIMD lanes | rendering |
//! | [`Precise`] | `f64` | the reference for numerical error |
//! | [`tape::Record`] | expressions | WGSL |
//!
//! All `f32` domains give the same bits for the same operations, whatever the lane count: each operation is
//! one correctly rounded IEEE 754 operation per lane. [`Domain::fma`] is fused where the instruction set fuses,
//! and everywhere or nowhere on one instruction set. [`operations`] says it of each operation, and has the cases that hold
//! every domain to it.
//!
//! Formulas obey three rules so that they can be recorded as well as run: no Rust `if` on values (use
//! [`Domain::branch`] or a select), no loops whose length depends on values, no state.

mod lanes;
pub mod operations;
mod single;
pub mod tape;

use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Shl, Shr, Sub};

pub use lanes::{Lanes, Lanes4, Lanes8, Lanes16, MAX_LANES};
pub use single::{FUSES, Precise, Scalar, Uint};

/// A real number of a domain.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
}
impl<T> Real for T where
    T: Copy
        + Add<Output = T>
        + Sub<Output = T>
        + Mul<Output = T>
        + Div<Output = T>
        + Neg<Output = T>
{
}

/// A 32-bit unsigned integer of a domain; addition, subtraction and multiplication wrap.
pub trait Unsigned:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + BitAnd<Output = Self>
    + BitOr<Output = Self>
    + BitXor<Output = Self>
    + Shl<u32, Output = Self>
    + Shr<u32, Output = Self>
{
}
impl<T> Unsigned for T where
    T: Copy
        + Add<Output = T>
        + Sub<Output = T>
        + Mul<Output = T>
        + BitAnd<Output = T>
        + BitOr<Output = T>
        + BitXor<Output = T>
        + Shl<u32, Output = T>
        + Shr<u32, Output = T>
{
}

/// A truth value of a domain.
pub trait Mask: Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {}
impl<T> Mask for T where T: Copy + BitAnd<Output = T> + BitOr<Output = T> + Not<Output = T> {}

/// The buffers a formula can read. Each is an array of 32-bit words; four consecutive ones make a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(usize)]
pub enum Buffer {
    /// A [`TriangleRecord`](crate::triangle::TriangleRecord) for each triangle.
    Triangles,
    /// A [`NormalRecord`](crate::surface::NormalRecord) for each vertex.
    Normals,
    /// A [`TangentRecord`](crate::surface::TangentRecord) for each vertex.
    Tangents,
    /// A [`UvRecord`](crate::surface::UvRecord) for each vertex.
    Uvs,
    /// A [`ColorRecord`](crate::surface::ColorRecord) for each vertex.
    Colors,
    /// Parameter blocks of the materials: numbers, a word each, and the records
    /// [`ColorParam`](crate::texture::ColorParam), [`ImageParam`](crate::texture::ImageParam) and
    /// [`TransformParam`](crate::texture::TransformParam), at the offsets that the materials' programs name.
    Params,
    /// Texels of all images, each as its [`TexelFormat`](crate::texture::TexelFormat) stores it.
    Texels,
    /// The record of its kind for each light: [`AreaRecord`](crate::light::AreaRecord),
    /// [`AreaBySolidAngleRecord`](crate::light::AreaBySolidAngleRecord), [`PunctualRecord`](crate::light::PunctualRecord), or [`LightRecord`](crate::light::LightRecord) for the
    /// environment. They lie [`LIGHT_WORDS`](crate::light::LIGHT_WORDS) apart.
    Lights,
    /// A [`PickHeader`](crate::light::PickHeader), and an [`AliasEntry`](crate::alias_table::AliasEntry) for each light. Only
    /// where lights are picked from a table.
    LightAlias,
    /// A [`LightTreeHeader`](crate::light::LightTreeHeader), a word for each light, the turns on the way to it, and pairs of
    /// [`ClusterRecord`](crate::light::ClusterRecord). Only where lights are picked from a tree: there is no table then.
    LightTree,
    /// An [`EnvironmentHeader`](crate::light::EnvironmentHeader), and an
    /// [`AliasEntry`](crate::alias_table::AliasEntry) for each texel.
    Environment,
    /// A [`CameraRecord`](crate::camera::CameraRecord).
    Camera,
    /// An [`ObjectRecord`](crate::triangle::ObjectRecord) for each object. Only where layers read it.
    Objects,
    /// A [`MediumRecord`](crate::tracer::MediumRecord) for each medium. Only where there are any.
    Media,
}

impl Buffer {
    /// How many there are.
    pub const COUNT: usize = Self::Media as usize + 1;

    /// All of them, in order.
    pub const ALL: [Self; Self::COUNT] = [
        Self::Triangles,
        Self::Normals,
        Self::Tangents,
        Self::Uvs,
        Self::Colors,
        Self::Params,
        Self::Texels,
        Self::Lights,
        Self::LightAlias,
        Self::LightTree,
        Self::Environment,
        Self::Camera,
        Self::Objects,
        Self::Media,
    ];
}

/// What the buffers hold, for domains that compute.
#[derive(Clone, Copy, Debug)]
pub struct Buffers<'a> {
    words: [&'a [u32]; Buffer::COUNT],
}

impl<'a> Buffers<'a> {
    /// Buffers in the order of [`Buffer::ALL`].
    pub fn new(words: [&'a [u32]; Buffer::COUNT]) -> Self {
        Self { words }
    }

    /// No data at all: every read gives 0. For formulas that read nothing.
    pub const EMPTY: Buffers<'static> = Buffers {
        words: [&[]; Buffer::COUNT],
    };

    /// The words of one buffer.
    #[inline(always)]
    pub fn get(&self, buffer: Buffer) -> &'a [u32] {
        self.words[buffer as usize]
    }

    /// One word; 0 outside the buffer, where only switched-off lanes read.
    #[inline(always)]
    pub fn word(&self, buffer: Buffer, index: u32) -> u32 {
        // A choice of addresses, not of paths: lanes read without branches.
        *self.get(buffer).get(index as usize).unwrap_or(&0)
    }

    /// `N` rows of four words each from word `first` on; 0 where they do not all lie within the buffer.
    #[inline(always)]
    pub fn rows<const N: usize>(&self, buffer: Buffer, first: u32) -> &'a [[u32; 4]; N] {
        let first = first as usize;
        let words = self.get(buffer).get(first..first.saturating_add(4 * N));
        let rows = words.and_then(|words| words.as_chunks().0.first_chunk());
        rows.unwrap_or(const { &[[0; 4]; N] })
    }
}

/// An arithmetic domain. See the module's documentation.
pub trait Domain: Copy {
    /// Real numbers.
    type F: Real;
    /// 32-bit unsigned integers.
    type U: Unsigned;
    /// Truth values.
    type M: Mask;

    /// A real constant, rounded to the domain's precision.
    fn lit(self, value: f64) -> Self::F;
    /// An integer constant.
    fn uint(self, value: u32) -> Self::U;
    /// A constant truth value.
    fn truth(self, value: bool) -> Self::M;

    /// √a, correctly rounded.
    fn sqrt(self, a: Self::F) -> Self::F;
    /// The smaller; `b` where either is NaN.
    fn min(self, a: Self::F, b: Self::F) -> Self::F;
    /// The larger; `b` where either is NaN.
    fn max(self, a: Self::F, b: Self::F) -> Self::F;
    /// |a|.
    fn abs(self, a: Self::F) -> Self::F;
    /// Largest integer not above `a`.
    fn floor(self, a: Self::F) -> Self::F;
    /// a·b + c, fused where the instruction set fuses.
    fn fma(self, a: Self::F, b: Self::F, c: Self::F) -> Self::F;
    /// The magnitude of `a` with the sign of `b`.
    fn copysign(self, a: Self::F, b: Self::F) -> Self::F;

    /// a < b.
    fn lt(self, a: Self::F, b: Self::F) -> Self::M;
    /// a ≤ b.
    fn le(self, a: Self::F, b: Self::F) -> Self::M;
    /// a = b.
    fn eq(self, a: Self::F, b: Self::F) -> Self::M;
    /// a = b, integers.
    fn eq_u(self, a: Self::U, b: Self::U) -> Self::M;
    /// a < b, integers.
    fn lt_u(self, a: Self::U, b: Self::U) -> Self::M;

    /// `a` where the mask holds, else `b`.
    fn select(self, mask: Self::M, a: Self::F, b: Self::F) -> Self::F;
    /// `a` where the mask holds, else `b`.
    fn select_u(self, mask: Self::M, a: Self::U, b: Self::U) -> Self::U;
    /// `a` where the mask holds, else `b`.
    #[inline(always)]
    fn select_mask(self, mask: Self::M, a: Self::M, b: Self::M) -> Self::M {
        (mask & a) | (!mask & b)
    }

    /// Truncation towards zero, for 0 ≤ a < 2³²; anything else is unspecified.
    fn to_uint(self, a: Self::F) -> Self::U;
    /// Conversion; exact below 2²⁴.
    fn to_real(self, a: Self::U) -> Self::F;
    /// The bits of the number as an `f32`.
    fn to_bits(self, a: Self::F) -> Self::U;
    /// The number whose bits as an `f32` these are.
    #[expect(
        clippy::wrong_self_convention,
        reason = "`self` is the domain, not the number"
    )]
    fn from_bits(self, a: Self::U) -> Self::F;

    /// The bits in the opposite order.
    fn reverse_bits(self, a: Self::U) -> Self::U;

    /// One word of a buffer.
    fn load(self, buffer: Buffer, index: Self::U) -> Self::U;
    /// One word of a buffer as a real number.
    #[inline(always)]
    fn load_real(self, buffer: Buffer, index: Self::U) -> Self::F {
        self.from_bits(self.load(buffer, index))
    }
    /// `N` rows of four consecutive words each from word `first` on. The rows of one lane lie within the buffer, all
    /// of them, or outside it, all of them: then they are 0, and only switched-off lanes read there.
    #[inline(always)]
    fn load_rows<const N: usize>(self, buffer: Buffer, first: Self::U) -> [[Self::U; 4]; N] {
        let mut rows = [[first; 4]; N];
        for (r, row) in rows.iter_mut().enumerate() {
            for (k, word) in row.iter_mut().enumerate() {
                *word = self.load(buffer, first + self.uint((4 * r + k) as u32));
            }
        }
        rows
    }
    /// The same word for all lanes.
    fn uniform(self, buffer: Buffer, index: u32) -> Self::U;
    /// The same word for all lanes as a real number.
    #[inline(always)]
    fn uniform_real(self, buffer: Buffer, index: u32) -> Self::F {
        self.from_bits(self.uniform(buffer, index))
    }

    /// `a()` where the mask holds, else `b()`. Only what some lane needs is computed.
    fn branch<T: Bundle<Self>>(
        self,
        mask: Self::M,
        a: impl FnOnce() -> T,
        b: impl FnOnce() -> T,
    ) -> T;

    /// The mask holds in no lane, for sure, so that what it guards may be left out. Domains that only write down cannot
    /// know, and say no.
    #[inline(always)]
    fn holds_nowhere(self, _mask: Self::M) -> bool {
        false
    }

    /// Runs `f` with the instruction set that the domain's numbers need. Boxed nodes are entered through it,
    /// since a call through a vtable leaves the caller's instruction set behind.
    #[inline(always)]
    fn vectorize<R>(self, f: impl FnOnce() -> R) -> R {
        f()
    }
}

/// A value made of a domain's numbers, so that it can be chosen lane by lane.
pub trait Bundle<D: Domain>: Copy {
    /// `a` where the mask holds, else `b`.
    fn choose(d: D, mask: D::M, a: Self, b: Self) -> Self;
}

impl<D: Domain, A: Bundle<D>, B: Bundle<D>> Bundle<D> for (A, B) {
    #[inline(always)]
    fn choose(d: D, mask: D::M, a: Self, b: Self) -> Self {
        (A::choose(d, mask, a.0, b.0), B::choose(d, mask, a.1, b.1))
    }
}

/// A real number as a [`Bundle`]. (A blanket implementation over `D::F` would not be coherent.)
#[derive(Clone, Copy, Debug)]
pub struct One<F>(pub F);

impl<D: Domain> Bundle<D> for One<D::F> {
    #[inline(always)]
    fn choose(d: D, mask: D::M, a: Self, b: Self) -> Self {
        One(d.select(mask, a.0, b.0))
    }
}
