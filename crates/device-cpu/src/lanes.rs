//! How many paths are shaded at once.

use std::fmt;
use std::str::FromStr;

use fearless_simd::{Level, Simd, SimdBase, dispatch};

/// Lanes of `f32`. Images do not depend on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LaneCount {
    /// Scalar code.
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
        dispatch!(Level::new(), simd => Self::of(simd))
    }

    fn of<S: Simd>(_: S) -> Self {
        match native::<S>() {
            16.. => Self::Sixteen,
            8.. => Self::Eight,
            _ => Self::Four,
        }
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

/// How many lanes suit an instruction set: a constant, so that what is for others is not compiled for it.
pub const fn native<S: Simd>() -> usize {
    <S::f32s as SimdBase<S>>::LEN
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
