//! Owen-scrambled Sobol points, padded: every dimension pair is its own randomisation of the first two Sobol
//! dimensions, a (0, 2)-sequence (Burley 2020, "Practical Hash-based Owen Scrambling").

use super::hash::{hash, unit};
use super::key::{SampleKey, Sampler};
use crate::domain::Domain;

/// The padded, scrambled, shuffled two-dimensional Sobol sequence.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sobol;

impl<D: Domain> Sampler<D> for Sobol {
    /// Never inlined: all vertices and programs of a scene share one copy, of which there would be five in each program, and which is
    /// long enough not to notice the call.
    #[inline(never)]
    fn pair(&self, d: D, key: SampleKey<D::U>, dimension: D::U) -> [D::F; 2] {
        d.vectorize(
            #[inline(always)]
            || {
                let seed = hash(d, key.pixel ^ hash(d, dimension));
                let reversed = d.reverse_bits(key.index);
                let shuffled = d.reverse_bits(owen(d, reversed, seed));
                // Scrambling works on reversed bits and Sobol's first dimension is the index with its bits reversed:
                // two of the reversals cancel, in both dimensions.
                let x = d.reverse_bits(owen(d, shuffled, hash(d, seed + d.uint(1))));
                let y = d.reverse_bits(owen(d, pascal(d, shuffled), hash(d, seed + d.uint(2))));
                [unit(d, x), unit(d, y)]
            },
        )
    }
}

/// Sobol's second generator matrix, Pascal's triangle modulo 2, as its Kronecker factors.
#[inline(always)]
fn pascal<D: Domain>(d: D, x: D::U) -> D::U {
    let x = x ^ ((x >> 1) & d.uint(0x5555_5555));
    let x = x ^ ((x >> 2) & d.uint(0x3333_3333));
    let x = x ^ ((x >> 4) & d.uint(0x0f0f_0f0f));
    let x = x ^ ((x >> 8) & d.uint(0x00ff_00ff));
    x ^ (x >> 16)
}

/// Owen scrambling of bit-reversed numbers: Laine and Karras 2011 with Vegdahl's constants.
#[inline(always)]
fn owen<D: Domain>(d: D, x: D::U, seed: D::U) -> D::U {
    let x = x ^ (x * d.uint(0x3d20_adea));
    let x = x + seed;
    let x = x * ((seed >> 16) | d.uint(1));
    let x = x ^ (x * d.uint(0x0552_6c56));
    x ^ (x * d.uint(0x53a2_2864))
}
