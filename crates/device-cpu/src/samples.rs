//! The samples of a job while they are summed up.

use residual_render::domain::{Lanes, MAX_LANES};
use residual_render::layer::Layers;
use residual_render::math::Color;

/// What paths bring: to samples of their own, or anywhere in the image.
pub(crate) enum Samples<'a> {
    /// `values[sample][row][column][channel]`: radiance, then the channels of the layers.
    Sums {
        values: &'a mut [f32],
        /// Numbers of a sample.
        stride: usize,
    },
    /// Rows of red, green, blue and the bits of a sample's index, one after the other.
    Splats {
        rows: &'a mut [[f32; 4]],
        /// How many there are.
        len: usize,
    },
}

impl<'a> Samples<'a> {
    /// All zero.
    pub(crate) fn sums(values: &'a mut [f32], layers: Layers) -> Self {
        values.fill(0.0);
        let stride = layers.stride();
        Self::Sums { values, stride }
    }

    /// None yet, with room for as many as there are rows of four.
    pub(crate) fn splats(values: &'a mut [f32]) -> Self {
        let (rows, _) = values.as_chunks_mut();
        Self::Splats { rows, len: 0 }
    }

    /// How many splats there are.
    pub(crate) fn splatted(&self) -> usize {
        match self {
            Self::Sums { .. } => 0,
            Self::Splats { len, .. } => *len,
        }
    }

    /// Adds a row of red, green and blue to the sample of the index behind them.
    #[inline(always)]
    pub(crate) fn add_row(&mut self, [r, g, b, sample]: [u32; 4]) {
        match self {
            Self::Sums { values, stride } => {
                let first = sample as usize * *stride;
                let radiance = &mut values[first..first + Layers::RADIANCE];
                radiance[0] += f32::from_bits(r);
                radiance[1] += f32::from_bits(g);
                radiance[2] += f32::from_bits(b);
            }
            Self::Splats { rows, len } => {
                rows[*len] = [r, g, b, sample].map(f32::from_bits);
                *len += 1;
            }
        }
    }

    /// Adds radiance in the lanes whose bit is set.
    #[inline(always)]
    pub(crate) fn add<D: Lanes>(&mut self, d: D, bits: u32, sample: D::U, color: Color<D::F>) {
        let [r, g, b] = [d.to_bits(color.x), d.to_bits(color.y), d.to_bits(color.z)];
        let rows = d.rows([r, g, b, sample]);
        let mut bits = bits;
        while bits != 0 {
            self.add_row(rows[bits.trailing_zeros() as usize % MAX_LANES]);
            bits &= bits - 1;
        }
    }

    /// Sets the channels of layers in the lanes whose bit is set.
    #[inline(always)]
    pub(crate) fn set<D: Lanes>(&mut self, d: D, bits: u32, sample: D::U, channels: &[D::F]) {
        let Self::Sums {
            values: all,
            stride,
        } = self
        else {
            unreachable!("light paths fill no layers");
        };
        let mut indices = [0; MAX_LANES];
        d.store_word(sample, &mut indices[..D::LANES]);
        for (channel, &value) in channels.iter().enumerate() {
            let mut values = [0; MAX_LANES];
            d.store_word(d.to_bits(value), &mut values[..D::LANES]);
            for lane in (0..D::LANES).filter(|lane| bits >> lane & 1 == 1) {
                let first = indices[lane] as usize * *stride;
                all[first + Layers::RADIANCE + channel] = f32::from_bits(values[lane]);
            }
        }
    }
}
