//! Random numbers of a fixed seed, apart from the renderer's own samplers.

/// SplitMix64 (Steele, Lea, Flood 2014).
#[derive(Clone, Debug)]
pub(crate) struct Rng(u64);

impl Rng {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub(crate) fn word(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// 32 random bits.
    pub(crate) fn bits(&mut self) -> u32 {
        (self.word() >> 32) as u32
    }

    /// Uniform in [0, 1), with the 24 bits that samplers give.
    pub(crate) fn unit(&mut self) -> f32 {
        (self.bits() >> 8) as f32 / 16_777_216.0
    }

    /// Three of them.
    pub(crate) fn unit3(&mut self) -> [f32; 3] {
        [self.unit(), self.unit(), self.unit()]
    }

    /// Uniform in [low, high), with 53 bits.
    pub(crate) fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.word() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// ± 2^e with e uniform in [low, high).
    pub(crate) fn signed_power(&mut self, low: f64, high: f64) -> f32 {
        let size = self.range(low, high).exp2() as f32;
        if self.word() & 1 == 0 { size } else { -size }
    }

    /// A unit vector, uniform on the sphere.
    pub(crate) fn direction(&mut self) -> [f64; 3] {
        let z = self.range(-1.0, 1.0);
        let (sin, cos) = self.range(0.0, std::f64::consts::TAU).sin_cos();
        let r = (1.0 - z * z).sqrt();
        [r * cos, r * sin, z]
    }
}
