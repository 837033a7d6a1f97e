//! How many paths are shaded at once, and how wide the hierarchy is that they are traced through.

use std::fmt;
use std::str::FromStr;

use fearless_simd::Level;
use residual_bvh::{BuildQuality, Bvh, BvhView, build};
use residual_render::scene_data::SceneData;

/// Lanes of `f32`. Images do not depend on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LaneCount {
    /// Scalar code, hierarchy of width 4.
    One,
    /// SSE, NEON.
    Four,
    /// AVX2.
    Eight,
    /// AVX-512.
    Sixteen,
}

impl LaneCount {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::One, Self::Four, Self::Eight, Self::Sixteen];

    /// The count that suits the machine at hand.
    pub fn native() -> Self {
        let level = Level::new();
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        match level {
            Level::Avx512(_) => return Self::Sixteen,
            Level::Avx2(_) => return Self::Eight,
            _ => {}
        }
        let _ = level;
        Self::Four
    }

    /// As a number.
    pub const fn count(self) -> u32 {
        match self {
            Self::One => 1,
            Self::Four => 4,
            Self::Eight => 8,
            Self::Sixteen => 16,
        }
    }
}

impl fmt::Display for LaneCount {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.count().fmt(f)
    }
}

impl FromStr for LaneCount {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let found = Self::ALL
            .into_iter()
            .find(|lanes| lanes.count().to_string() == text);
        found.ok_or_else(|| format!("{text:?} is not a lane count; use 1, 4, 8 or 16"))
    }
}

/// A hierarchy of the width that goes with a lane count.
#[derive(Clone, Copy, Debug)]
pub enum AnyBvh<'a> {
    /// For 1 and 4 lanes.
    Four(BvhView<'a, 4>),
    /// For 8 lanes.
    Eight(BvhView<'a, 8>),
    /// For 16 lanes.
    Sixteen(BvhView<'a, 16>),
}

/// An owned [`AnyBvh`].
#[derive(Debug)]
pub enum OwnedBvh {
    /// For 1 and 4 lanes.
    Four(Bvh<4>),
    /// For 8 lanes.
    Eight(Bvh<8>),
    /// For 16 lanes.
    Sixteen(Bvh<16>),
}

impl OwnedBvh {
    /// Builds the hierarchy over a scene's triangles.
    pub fn build(data: &SceneData, lanes: LaneCount, quality: BuildQuality) -> Self {
        let (positions, triangles) = (data.positions(), data.triangles());
        let sides = (!data.single_sided.is_empty()).then_some(data.single_sided.as_slice());
        match lanes {
            LaneCount::One | LaneCount::Four => {
                Self::Four(build(&positions, &triangles, sides, quality))
            }
            LaneCount::Eight => Self::Eight(build(&positions, &triangles, sides, quality)),
            LaneCount::Sixteen => Self::Sixteen(build(&positions, &triangles, sides, quality)),
        }
    }

    /// A view.
    pub fn view(&self) -> AnyBvh<'_> {
        match self {
            Self::Four(bvh) => AnyBvh::Four(bvh.view()),
            Self::Eight(bvh) => AnyBvh::Eight(bvh.view()),
            Self::Sixteen(bvh) => AnyBvh::Sixteen(bvh.view()),
        }
    }
}

/// Calls [`render_tile`](crate::tile::render_tile) in the domain of one lane count, named by its variant of
/// [`LaneCount`], on the machine's instruction set, with the scene that `|buffers| scene` makes.
///
/// # Panics
/// If the hierarchy is not of the width that goes with the lane count.
#[macro_export]
macro_rules! render_lanes {
    (One, $($rest:tt)*) => { $crate::render_lanes!(@ Four, Scalar, $($rest)*) };
    (Four, $($rest:tt)*) => { $crate::render_lanes!(@ Four, Lanes4, $($rest)*) };
    (Eight, $($rest:tt)*) => { $crate::render_lanes!(@ Eight, Lanes8, $($rest)*) };
    (Sixteen, $($rest:tt)*) => { $crate::render_lanes!(@ Sixteen, Lanes16, $($rest)*) };
    (@ $width:ident, $domain:ident, $view:expr, $job:expr, $radiance:expr, |$buffers:ident| $scene:expr) => {{
        use $crate::generated::fearless_simd::{Level, dispatch};
        let view: &$crate::SceneView<'_> = $view;
        let $buffers = &view.buffers;
        let $crate::AnyBvh::$width(bvh) = view.bvh else {
            panic!("the hierarchy does not have the width that goes with the lane count")
        };
        dispatch!(Level::new(), simd => {
            let d = $crate::render_lanes!(# $domain, simd, $buffers);
            $crate::tile::render_tile(simd, d, &$scene, ($buffers, bvh), $job, $radiance)
        })
    }};
    (# Scalar, $simd:ident, $buffers:ident) => {
        $crate::generated::render::domain::Scalar::new($buffers)
    };
    (# $domain:ident, $simd:ident, $buffers:ident) => {
        $crate::generated::render::domain::$domain::new($simd, $buffers)
    };
}
