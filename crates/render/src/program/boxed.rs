//! Nodes behind vtables: what the interpreted renderer is made of.

use crate::alpha::AlphaTest;
use crate::bsdf::ggx::Ggx;
use crate::bsdf::{
    AnyInterface, Bsdf, BsdfKind, BsdfProposal, BsdfSample, BsdfValue, Fresnel, LayerFrame,
    Roughness, SchlickCurve,
};
use crate::camera::{Camera, Sight};
use crate::domain::Domain;
use crate::light::{Background, Emission, EmissionNumbers, LightKind, LightSample};
use crate::math::{Color, Frame, Vec3};
use crate::surface::{Attributes, PathRay, Surface, SurfaceHit};
use crate::texture::{
    AnyFilter, AnyFormat, AnyWrap, ColorSource, Image, Input, ScalarSource, UvMap,
};

/// What a node, or a field of one, is in the interpreted renderer.
pub(super) trait Boxing<'a, D> {
    /// Its type.
    type Boxed;
    /// Its value.
    fn boxed(&self) -> Self::Boxed;
}

impl<'a, D, N: Boxing<'a, D>> Boxing<'a, D> for Box<N> {
    type Boxed = N::Boxed;
    fn boxed(&self) -> N::Boxed {
        (**self).boxed()
    }
}

/// Fields that are the same when interpreted.
macro_rules! as_they_are {
    ($($Type:ty),*) => {$(
        impl<D> Boxing<'_, D> for $Type {
            type Boxed = Self;
            fn boxed(&self) -> Self {
                *self
            }
        }
    )*};
}
as_they_are!(
    Input,
    AnyInterface,
    f32,
    [f32; 3],
    u32,
    UvMap,
    Attributes,
    Image<AnyWrap, AnyWrap, AnyFilter, AnyFormat>
);

/// A node that is entered through a vtable, which leaves the caller's instruction set behind: the domain's is established
/// again.
pub(super) struct Entered<T>(pub(super) T);

/// Implements a trait for nodes that are entered, and for boxes and references to them.
macro_rules! entered {
    ($Trait:ident {
        $(fn $method:ident($d:ident $(, $argument:ident: $Type:ty)*) -> $Result:ty;)*
        $(const fn $constant:ident() -> $Constant:ty;)*
    }) => {
        impl<D: Domain, T: $Trait<D>> $Trait<D> for Entered<T> {
            $(fn $method(&self, $d: D $(, $argument: $Type)*) -> $Result {
                $d.vectorize(
                    #[inline(always)]
                    || self.0.$method($d $(, $argument)*),
                )
            })*
            $(fn $constant(&self) -> $Constant {
                self.0.$constant()
            })*
        }
        entered!(@behind Box<dyn $Trait<D> + Send + Sync + '_>, $Trait {
            $(fn $method($d $(, $argument: $Type)*) -> $Result;)*
            $(const fn $constant() -> $Constant;)*
        });
        entered!(@behind &(dyn $Trait<D> + Send + Sync + '_), $Trait {
            $(fn $method($d $(, $argument: $Type)*) -> $Result;)*
            $(const fn $constant() -> $Constant;)*
        });
    };
    (@behind $Pointer:ty, $Trait:ident {
        $(fn $method:ident($d:ident $(, $argument:ident: $Type:ty)*) -> $Result:ty;)*
        $(const fn $constant:ident() -> $Constant:ty;)*
    }) => {
        impl<D: Domain> $Trait<D> for $Pointer {
            $(#[inline(always)]
            fn $method(&self, $d: D $(, $argument: $Type)*) -> $Result {
                (**self).$method($d $(, $argument)*)
            })*
            $(#[inline(always)]
            fn $constant(&self) -> $Constant {
                (**self).$constant()
            })*
        }
    };
}

entered!(Bsdf {
    fn eval(d, surface: &Surface<D>, wo: Vec3<D::F>, wi: Vec3<D::F>) -> BsdfValue<D>;
    fn propose(d, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfProposal<D>;
    fn sample(d, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfSample<D>;
    fn albedo(d, surface: &Surface<D>, wo: Vec3<D::F>) -> Color<D::F>;
    fn radiance_scale(d, surface: &Surface<D>, wi: Vec3<D::F>) -> Option<D::F>;
    const fn kind() -> BsdfKind;
});
entered!(Fresnel {
    fn reflectance(d, surface: &Surface<D>, cos: D::F) -> Color<D::F>;
    fn curve(d, surface: &Surface<D>, cos: D::F) -> SchlickCurve<D>;
});
entered!(LayerFrame {
    fn frame(d, surface: &Surface<D>, wo: Vec3<D::F>) -> Frame<D::F>;
});
entered!(Roughness {
    fn microfacets(d, surface: &Surface<D>) -> Ggx<D::F>;
});
entered!(ColorSource {
    fn color(d, surface: &Surface<D>) -> Color<D::F>;
});
entered!(ScalarSource {
    fn scalar(d, surface: &Surface<D>) -> D::F;
});
entered!(LightKind {
    fn sample(d, record: D::U, from: Vec3<D::F>, u: [D::F; 3]) -> LightSample<D>;
    fn emit(d, record: D::U, u: EmissionNumbers<D::F>) -> Emission<D>;
    fn background(d, dir: Vec3<D::F>) -> Option<Background<D>>;
    fn density(d, record: D::U, ray: &PathRay<D>, seen: &Surface<D>) -> Option<D::F>;
    fn spread(d, record: D::U, seen: &Surface<D>) -> Option<D::F>;
    const fn takes_three() -> bool;
});
entered!(Camera {
    fn ray(d, film: [D::F; 2], lens: [D::F; 2]) -> PathRay<D>;
    fn sight(d, point: Vec3<D::F>, lens: [D::F; 2]) -> Sight<D>;
    fn density(d, dir: Vec3<D::F>, distance: D::F) -> D::F;
    const fn has_lens() -> bool;
});
entered!(AlphaTest {
    fn passes(d, ray: [Vec3<D::F>; 2], hit: &SurfaceHit<D>) -> D::M;
});
