//! Thirty-two lanes, wider than any register: two times sixteen. While one half waits for an operation's result, the other goes on.

use fearless_simd::{Simd, f32x16, mask32x16};

use crate::inlined::each;
use crate::look_up::{high_bits, look_up};
use crate::reduce::{greatest, least};
use crate::simd::Width;

const HALF: usize = 16;

/// An operation on both halves.
macro_rules! halves {
    ($simd:ident.$operation:ident($($a:ident),+)) => {
        [
            Width::<HALF>::$operation($simd, $($a[0]),+),
            Width::<HALF>::$operation($simd, $($a[1]),+),
        ]
    };
}

#[inline(always)]
fn split<T>(array: &[T; 32]) -> [&[T; HALF]; 2] {
    let (halves, _) = array.as_chunks();
    [&halves[0], &halves[1]]
}

impl<S: Simd> Width<32> for S {
    type Float = [f32x16<S>; 2];
    type Mask = [mask32x16<S>; 2];

    #[inline(always)]
    fn splat(self, x: f32) -> Self::Float {
        [Width::<HALF>::splat(self, x); 2]
    }
    #[inline(always)]
    fn load(self, array: &[f32; 32]) -> Self::Float {
        let array = split(array);
        halves!(self.load(array))
    }
    #[inline(always)]
    fn load_bytes(self, array: &[u8; 32]) -> Self::Float {
        let array = split(array);
        halves!(self.load_bytes(array))
    }
    #[inline(always)]
    fn store(self, a: Self::Float, array: &mut [f32; 32]) {
        let (halves, _) = array.as_chunks_mut::<HALF>();
        Width::<HALF>::store(self, a[0], &mut halves[0]);
        Width::<HALF>::store(self, a[1], &mut halves[1]);
    }
    #[inline(always)]
    fn add(self, a: Self::Float, b: Self::Float) -> Self::Float {
        halves!(self.add(a, b))
    }
    #[inline(always)]
    fn sub(self, a: Self::Float, b: Self::Float) -> Self::Float {
        halves!(self.sub(a, b))
    }
    #[inline(always)]
    fn mul(self, a: Self::Float, b: Self::Float) -> Self::Float {
        halves!(self.mul(a, b))
    }
    #[inline(always)]
    fn mul_add(self, a: Self::Float, b: Self::Float, c: Self::Float) -> Self::Float {
        halves!(self.mul_add(a, b, c))
    }
    #[inline(always)]
    fn mul_sub(self, a: Self::Float, b: Self::Float, c: Self::Float) -> Self::Float {
        halves!(self.mul_sub(a, b, c))
    }
    #[inline(always)]
    fn div(self, a: Self::Float, b: Self::Float) -> Self::Float {
        halves!(self.div(a, b))
    }
    #[inline(always)]
    fn abs(self, a: Self::Float) -> Self::Float {
        halves!(self.abs(a))
    }
    #[inline(always)]
    fn min_number(self, a: Self::Float, number: Self::Float) -> Self::Float {
        halves!(self.min_number(a, number))
    }
    #[inline(always)]
    fn max_number(self, a: Self::Float, number: Self::Float) -> Self::Float {
        halves!(self.max_number(a, number))
    }
    #[inline(always)]
    fn le(self, a: Self::Float, b: Self::Float) -> Self::Mask {
        halves!(self.le(a, b))
    }
    #[inline(always)]
    fn lt(self, a: Self::Float, b: Self::Float) -> Self::Mask {
        halves!(self.lt(a, b))
    }
    #[inline(always)]
    fn and(self, a: Self::Mask, b: Self::Mask) -> Self::Mask {
        halves!(self.and(a, b))
    }
    #[inline(always)]
    fn select(self, bits: u32, a: Self::Float, b: Self::Float) -> Self::Float {
        let bits = [bits & 0xffff, bits >> HALF];
        halves!(self.select(bits, a, b))
    }
    #[inline(always)]
    fn least(self, a: Self::Float) -> f32 {
        Width::<HALF>::least(self, Width::<HALF>::min_number(self, a[0], a[1]))
    }
    #[inline(always)]
    fn greatest(self, a: Self::Float) -> f32 {
        Width::<HALF>::greatest(self, Width::<HALF>::max_number(self, a[0], a[1]))
    }
    #[inline(always)]
    fn least_of(self, four: [Self::Float; 4]) -> [f32; 4] {
        let less = each(
            four,
            #[inline(always)]
            |[a, b]| Width::<HALF>::min_number(self, a, b),
        );
        least::of_16(self, less)
    }
    #[inline(always)]
    fn greatest_of(self, four: [Self::Float; 4]) -> [f32; 4] {
        let greater = each(
            four,
            #[inline(always)]
            |[a, b]| Width::<HALF>::max_number(self, a, b),
        );
        greatest::of_16(self, greater)
    }
    #[inline(always)]
    fn bits(self, mask: Self::Mask) -> u32 {
        let [low, high] = halves!(self.bits(mask));
        low | high << HALF
    }
    /// No packet of triangles is as wide, so it need not be fast.
    #[inline(always)]
    fn look_up(self, tables: [Self::Float; 3], indices: &[u16; 32]) -> [[Self::Float; 3]; 3] {
        let tables = tables.map(|table| {
            let mut array = [0.0; 32];
            Width::<32>::store(self, table, &mut array);
            array
        });
        let corners = look_up(tables, indices);
        corners.map(|corner| corner.map(|array| Width::<32>::load(self, &array)))
    }
    #[inline(always)]
    fn high_bits(self, words: &[u16; 32]) -> u32 {
        high_bits(words)
    }
}

#[cfg(test)]
mod tests {
    use fearless_simd::{Level, dispatch};

    use super::Width;

    /// Four vectors of numbers that are all different, whose least and greatest lanes lie anywhere.
    fn check<S: Width<N>, const N: usize>(simd: S) {
        for seed in 0..32 {
            let lane = |vector: usize, lane: usize| {
                let place = (lane * 5 + seed * (vector + 1)) % N;
                (place * 4 + vector) as f32 - 2.5 * N as f32
            };
            let four: [[f32; N]; 4] =
                std::array::from_fn(|vector| std::array::from_fn(|i| lane(vector, i)));
            let vectors = four.each_ref().map(|array| simd.load(array));
            let pick = |better: fn(f32, f32) -> f32| {
                four.map(|array| array.into_iter().reduce(better).expect("lanes"))
            };
            assert_eq!(simd.least_of(vectors), pick(f32::min), "{N} lanes");
            assert_eq!(simd.greatest_of(vectors), pick(f32::max), "{N} lanes");
        }
    }

    #[test]
    fn each_vector_has_its_own_ends() {
        dispatch!(Level::new(), simd => {
            check::<_, 1>(simd);
            check::<_, 2>(simd);
            check::<_, 4>(simd);
            check::<_, 8>(simd);
            check::<_, 16>(simd);
            check::<_, 32>(simd);
        });
    }
}
