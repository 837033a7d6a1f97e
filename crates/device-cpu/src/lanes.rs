//! How many paths are shaded at once.

use std::fmt;
use std::str::FromStr;

use fearless_simd::Level;

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
