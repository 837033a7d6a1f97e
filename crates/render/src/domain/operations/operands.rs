//! Operands that are hard: at the ends of ranges, between two roundings, and such that their results cancel.

use crate::domain::tape::Kind;

/// With the two NaNs a prime number of them, so that every so-many-th combination has every value in every place.
const REALS: [f32; 35] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    -0.5,
    2.5,
    3.0,
    0.1,
    -1.0 / 3.0,
    // The neighbours of 1, half its ulp, and a little more: ties and what is no tie any more.
    1.0 + f32::EPSILON,
    -1.0 - f32::EPSILON,
    1.0 - f32::EPSILON / 2.0,
    f32::EPSILON / 2.0,
    -f32::EPSILON / 2.0,
    f32::EPSILON / 2.0 * (1.0 + f32::EPSILON),
    // Where fractions end, and where odd numbers do.
    8_388_607.5,
    8_388_609.0,
    16_777_215.0,
    16_777_216.0,
    16_777_218.0,
    // Where signed and unsigned integers end.
    2_147_483_648.0,
    4_294_967_040.0,
    4_294_967_296.0,
    // The smallest denormal, the largest, and the smallest normal numbers; what has one of them for its square.
    f32::from_bits(1),
    -f32::from_bits(1),
    f32::from_bits(0x007f_ffff),
    f32::MIN_POSITIVE,
    -f32::MIN_POSITIVE,
    f32::from_bits(0x0080_0001),
    f32::from_bits(0x2000_0000),
    f32::MAX,
    f32::MIN,
    f32::INFINITY,
    f32::NEG_INFINITY,
];

const NANS: [u32; 2] = [0x7fc0_0000, 0xffc1_2345];

const WORDS: [u32; 20] = [
    0,
    1,
    2,
    3,
    31,
    0xffff,
    0x1_0000,
    // What a real number still holds, halves between two of them, and the last that is not rounded up.
    0x00ff_ffff,
    0x0100_0000,
    0x0100_0001,
    0x0100_0003,
    0xffff_ff7f,
    0xffff_ff80,
    0x7fff_ffff,
    0x8000_0000,
    u32::MAX,
    0x5555_5555,
    0xaaaa_aaaa,
    0x1234_5678,
    // The bits of a real number.
    0x3f80_0000,
];

const TRUTHS: [u32; 2] = [0, 1];

const SIGN: u32 = 0x8000_0000;

/// How many pseudo-random operands there are, of each of two sorts.
const RANDOM: usize = 2048;

/// Operands of these kinds, up to three.
pub(super) fn of_kinds(kinds: &[Kind]) -> Vec<[u32; 3]> {
    let mut random = SplitMix(kinds.len() as u64);
    let mut operands = combinations(kinds);
    operands.extend((0..RANDOM).map(|_| any(kinds, &mut random)));
    operands.extend((0..RANDOM).map(|_| alike(kinds, &mut random)));
    operands
}

fn special(kind: Kind) -> Vec<u32> {
    match kind {
        Kind::Real => REALS.map(f32::to_bits).into_iter().chain(NANS).collect(),
        Kind::Word => WORDS.to_vec(),
        Kind::Truth => TRUTHS.to_vec(),
    }
}

/// Special values, each with each; where there are many thousands, every so-many-th.
fn combinations(kinds: &[Kind]) -> Vec<[u32; 3]> {
    let special: Vec<_> = kinds.iter().map(|&kind| special(kind)).collect();
    let count: usize = special.iter().map(Vec::len).product();
    let combination = |mut place: usize| {
        let mut operands = [0; 3];
        for (operand, special) in operands.iter_mut().zip(&special) {
            *operand = special[place % special.len()];
            place /= special.len();
        }
        operands
    };
    (0..count)
        .step_by(1 + count / 4096)
        .map(combination)
        .collect()
}

/// Any bits.
fn any(kinds: &[Kind], random: &mut SplitMix) -> [u32; 3] {
    let mut operands = [0; 3];
    for (operand, kind) in operands.iter_mut().zip(kinds) {
        *operand = match kind {
            Kind::Real | Kind::Word => random.bits(),
            Kind::Truth => random.bits() & 1,
        };
    }
    operands
}

/// Numbers of like size, whose sums cancel: the last one often with the first, or with the product of the first two.
fn alike(kinds: &[Kind], random: &mut SplitMix) -> [u32; 3] {
    let mut operands = any(kinds, random);
    let exponent = 107 + random.bits() % 60;
    for (operand, _) in operands
        .iter_mut()
        .zip(kinds)
        .filter(|(_, k)| **k == Kind::Real)
    {
        let exponent = exponent + random.bits() % 3;
        *operand = (*operand & (SIGN | 0x007f_ffff)) | (exponent << 23);
    }
    let change = random.bits();
    let [a, b] = [operands[0], operands[1]];
    match (kinds, change & 0x30) {
        ([Kind::Real, Kind::Real], 0) => operands[1] = a ^ (change & (SIGN | 7)),
        ([Kind::Real, Kind::Real, Kind::Real], 0) => operands[2] = a ^ (change & (SIGN | 7)),
        ([Kind::Real, Kind::Real, Kind::Real], 0x10) => {
            let product = f32::from_bits(a) * f32::from_bits(b);
            operands[2] = product.to_bits() ^ (change & SIGN);
        }
        _ => {}
    }
    operands
}

/// SplitMix64 (Steele, Lea, Flood 2014).
struct SplitMix(u64);

impl SplitMix {
    fn bits(&mut self) -> u32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 32) as u32
    }
}
