//! Numbers looked up in registers: each lane's of three tables, as a compact packet's corners are of its vertices.

use crate::inlined::inlined;
use fearless_simd::prelude::*;
#[cfg(target_arch = "x86_64")]
use fearless_simd::{Avx512, u16x16};
use fearless_simd::{Simd, f32x4, f32x8, f32x16, i16x16};

/// See [`Width::look_up`](crate::Width::look_up): through memory.
#[inline(always)]
pub(crate) fn look_up<const N: usize>(
    tables: [[f32; N]; 3],
    indices: &[u16; N],
) -> [[[f32; N]; 3]; 3] {
    [0, 4, 8].map(|shift| {
        tables
            .each_ref()
            .map(|table| indices.map(|index| table[usize::from(index >> shift & 15) % N]))
    })
}

/// See [`Width::high_bits`](crate::Width::high_bits).
#[inline(always)]
pub(crate) fn high_bits<const N: usize>(words: &[u16; N]) -> u32 {
    let bits = words.iter().rev();
    bits.fold(0, |bits, word| bits << 1 | u32::from(word >> 15))
}

/// With registers too narrow for an instruction.
macro_rules! through_memory {
    ($n:literal, $float:ident, $look_up:ident, $high_bits:ident) => {
        #[inline(always)]
        pub(crate) fn $look_up<S: Simd>(
            simd: S,
            tables: [$float<S>; 3],
            indices: &[u16; $n],
        ) -> [[$float<S>; 3]; 3] {
            let [x, y, z] = tables;
            let corner = inlined(
                #[inline(always)]
                |[x, y, z]: [[f32; $n]; 3]| {
                    [
                        $float::load_array(simd, x),
                        $float::load_array(simd, y),
                        $float::load_array(simd, z),
                    ]
                },
            );
            let [a, b, c] = look_up([x.into(), y.into(), z.into()], indices);
            [corner(a), corner(b), corner(c)]
        }

        #[inline(always)]
        pub(crate) fn $high_bits<S: Simd>(_: S, words: &[u16; $n]) -> u32 {
            high_bits(words)
        }
    };
}
through_memory!(4, f32x4, look_up_4, high_bits_4);
through_memory!(8, f32x8, look_up_8, high_bits_8);

#[inline(always)]
pub(crate) fn high_bits_16<S: Simd>(simd: S, words: &[u16; 16]) -> u32 {
    let words = i16x16::load_array(simd, words.map(u16::cast_signed));
    words.simd_lt(0i16).to_bitmask() as u32
}

#[inline(always)]
pub(crate) fn look_up_16<S: Simd>(
    simd: S,
    [x, y, z]: [f32x16<S>; 3],
    indices: &[u16; 16],
) -> [[f32x16<S>; 3]; 3] {
    #[cfg(target_arch = "x86_64")]
    if let Some(avx512) = simd.level().as_avx512() {
        let number = inlined(
            #[inline(always)]
            |table: f32x16<S>| f32x16::load_array(avx512, table.into()),
        );
        let indices = u16x16::load_array(avx512, *indices);
        let [a, b, c] = permute(avx512, number(x), number(y), number(z), indices);
        let number = inlined(
            #[inline(always)]
            |found: f32x16<Avx512>| f32x16::load_array(simd, found.into()),
        );
        let corner = inlined(
            #[inline(always)]
            |[x, y, z]: [f32x16<Avx512>; 3]| [number(x), number(y), number(z)],
        );
        return [corner(a), corner(b), corner(c)];
    }
    let corner = inlined(
        #[inline(always)]
        |[x, y, z]: [[f32; 16]; 3]| {
            [
                f32x16::load_array(simd, x),
                f32x16::load_array(simd, y),
                f32x16::load_array(simd, z),
            ]
        },
    );
    let [a, b, c] = look_up([x.into(), y.into(), z.into()], indices);
    [corner(a), corner(b), corner(c)]
}

// Written out, since calls of closures would be calls.
#[cfg(target_arch = "x86_64")]
fearless_simd::kernel!(
    #[inline(always)]
    fn permute(
        avx512: Avx512,
        x: f32x16<Avx512>,
        y: f32x16<Avx512>,
        z: f32x16<Avx512>,
        indices: u16x16<Avx512>,
    ) -> [[f32x16<Avx512>; 3]; 3] {
        use std::arch::x86_64::{_mm512_cvtepu16_epi32, _mm512_permutexvar_ps, _mm512_srli_epi32};
        // Of each index the instruction uses the four lowest bits.
        let first = _mm512_cvtepu16_epi32(indices.into());
        let second = _mm512_srli_epi32::<4>(first);
        let third = _mm512_srli_epi32::<8>(first);
        let (x, y, z) = (x.into(), y.into(), z.into());
        [
            [
                _mm512_permutexvar_ps(first, x).simd_into(avx512),
                _mm512_permutexvar_ps(first, y).simd_into(avx512),
                _mm512_permutexvar_ps(first, z).simd_into(avx512),
            ],
            [
                _mm512_permutexvar_ps(second, x).simd_into(avx512),
                _mm512_permutexvar_ps(second, y).simd_into(avx512),
                _mm512_permutexvar_ps(second, z).simd_into(avx512),
            ],
            [
                _mm512_permutexvar_ps(third, x).simd_into(avx512),
                _mm512_permutexvar_ps(third, y).simd_into(avx512),
                _mm512_permutexvar_ps(third, z).simd_into(avx512),
            ],
        ]
    }
);
