//! Instruction sets: what this program was compiled for, what the machine has, what is asked for.

use std::fmt;

use clap::ValueEnum;
use fearless_simd::Level;

/// An instruction set that kernels are measured on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Isa {
    /// AVX-512 as of Ice Lake.
    Avx512,
    /// AVX2 with FMA (build with RUSTFLAGS="-C target-cpu=x86-64-v3").
    Avx2,
    /// The best that is neither of these: SSE, NEON, or plain arrays.
    #[value(skip)]
    Other,
}

impl Isa {
    /// The machine's best.
    pub fn native() -> Isa {
        Isa::of(Level::new())
    }

    /// What the compiler was allowed to use everywhere (`-C target-cpu`). An [`Isa::Avx2`] measurement says little in a
    /// program compiled for more, since the compiler then uses the rest on its own.
    pub fn compiled_for() -> Isa {
        Isa::of(Level::baseline())
    }

    /// What is measured unless something else is asked for: what the program was compiled for, or where that is only a
    /// baseline, what run-time dispatch finds.
    pub fn preferred() -> Isa {
        match Isa::compiled_for() {
            Isa::Other => Isa::native(),
            isa => isa,
        }
    }

    /// Whether the machine has it.
    pub fn is_available(self) -> bool {
        match (self, Isa::native()) {
            (Isa::Avx2, Isa::Avx512) => true,
            (wanted, native) => wanted == native,
        }
    }

    /// Embree's `isa=` for the same instructions; `None` leaves it to Embree.
    pub fn embree_name(self) -> Option<&'static str> {
        match self {
            Isa::Avx512 => Some("avx512"),
            Isa::Avx2 => Some("avx2"),
            Isa::Other => None,
        }
    }

    #[cfg(target_arch = "x86_64")]
    fn of(level: Level) -> Isa {
        if level.as_avx512().is_some() {
            Isa::Avx512
        } else if level.as_avx2().is_some() {
            Isa::Avx2
        } else {
            Isa::Other
        }
    }

    #[cfg(not(target_arch = "x86_64"))]
    fn of(_: Level) -> Isa {
        Isa::Other
    }
}

impl fmt::Display for Isa {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Isa::Avx512 => "avx512",
            Isa::Avx2 => "avx2",
            Isa::Other if cfg!(target_arch = "aarch64") => "neon",
            Isa::Other => "sse",
        })
    }
}

/// Evaluates an expression with the token of an [`Isa`], compiled for it: `on_isa!(isa, simd => expression)`.
#[macro_export]
macro_rules! on_isa {
    ($isa:expr, $simd:ident => $expression:expr) => {
        match $isa {
            #[cfg(target_arch = "x86_64")]
            $crate::isa::Isa::Avx2 => {
                let $simd = fearless_simd::Level::new()
                    .as_avx2()
                    .expect("the instruction set is available");
                fearless_simd::Simd::vectorize(
                    $simd,
                    #[inline(always)]
                    || $expression,
                )
            }
            _ => fearless_simd::dispatch!(fearless_simd::Level::new(), $simd => $expression),
        }
    };
}
