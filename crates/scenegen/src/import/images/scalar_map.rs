//! Maps of numbers that are made of images of colours: their luminance, or a channel brought into another range.

use super::sixteen_bits::of_16_bits;
use crate::desc::Texels;

/// Which number a texel stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::import) enum ScalarSource {
    /// 0 red … 3 alpha.
    Channel(usize),
    /// What red, green and blue look like together, as they are stored.
    Luminance,
}

/// Numbers in [0, 1]: base + gain · source, clamped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::import) struct ScalarMap {
    /// What is read.
    pub(in crate::import) source: ScalarSource,
    /// Where it is 0.
    pub(in crate::import) base: f32,
    /// A factor.
    pub(in crate::import) gain: f32,
}

impl ScalarMap {
    /// The channel that needs no image of its own, as it holds the numbers already.
    pub(in crate::import) fn channel(self) -> Option<usize> {
        match self.source {
            ScalarSource::Channel(channel) if (self.base, self.gain) == (0.0, 1.0) => Some(channel),
            _ => None,
        }
    }

    /// Grey texels with the numbers.
    pub(super) fn derive(self, texels: Texels) -> Texels {
        let codes = |texels: Vec<[u16; 4]>| {
            let texels = texels.into_iter();
            let gray: Vec<_> = texels.map(|texel| self.code(texel)).collect();
            of_16_bits(&gray)
        };
        match texels {
            Texels::Rgba8(texels) => {
                let wide = |texel: [u8; 4]| texel.map(|code| 257 * u16::from(code));
                codes(texels.into_iter().map(wide).collect())
            }
            Texels::Rgba16(texels) => codes(texels),
            Texels::RgbaF32(texels) => {
                let texels = texels.into_iter();
                Texels::RgbaF32(texels.map(|texel| gray(self.value(texel), 1.0)).collect())
            }
        }
    }

    fn code(self, texel: [u16; 4]) -> [u16; 4] {
        let value = self.value(texel.map(|code| f32::from(code) / 65535.0));
        gray((65535.0 * value).round() as u16, u16::MAX)
    }

    fn value(self, [r, g, b, a]: [f32; 4]) -> f32 {
        let source = match self.source {
            ScalarSource::Channel(channel) => [r, g, b, a][channel],
            // To the bit, where an image is grey already.
            ScalarSource::Luminance if r == g && g == b => r,
            // Of Rec. 709.
            ScalarSource::Luminance => 0.2126 * r + 0.7152 * g + 0.0722 * b,
        };
        (self.base + self.gain * source).clamp(0.0, 1.0)
    }
}

fn gray<T: Copy>(value: T, alpha: T) -> [T; 4] {
    [value, value, value, alpha]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(source: ScalarSource, base: f32, gain: f32) -> ScalarMap {
        ScalarMap { source, base, gain }
    }

    #[test]
    fn numbers_are_made_of_texels_of_any_kind() {
        let luminance = map(ScalarSource::Luminance, 0.0, 1.0);
        let halved = map(ScalarSource::Channel(3), 0.25, 0.5);
        let bytes = Texels::Rgba8(vec![[255, 0, 0, 51], [7, 7, 7, 255]]);
        let Texels::Rgba16(found) = luminance.derive(bytes.clone()) else {
            panic!("16 bits")
        };
        let red = (65535.0_f32 * 0.2126).round() as u16;
        assert_eq!(found, [gray(red, 65535), gray(7 * 257, 65535)]);
        let Texels::Rgba16(found) = halved.derive(bytes) else {
            panic!("16 bits")
        };
        assert_eq!([found[0][0], found[1][0]], [22937, 49151]);
        let floats = Texels::RgbaF32(vec![[0.0, 1.0, 0.0, 3.0]]);
        for (map, expected) in [(luminance, 0.7152), (halved, 1.0)] {
            let Texels::RgbaF32(found) = map.derive(floats.clone()) else {
                panic!("floats")
            };
            assert_eq!(found, [gray(expected, 1.0)]);
        }
    }

    #[test]
    fn grey_bytes_stay_as_they_are() {
        let every: Vec<[u8; 4]> = (0..=255).map(|code| [code, code, code, 255]).collect();
        let luminance = map(ScalarSource::Luminance, 0.0, 1.0);
        match luminance.derive(Texels::Rgba8(every.clone())) {
            Texels::Rgba8(found) => assert_eq!(found, every),
            other => panic!("{other:?}"),
        }
        assert_eq!(luminance.channel(), None);
        assert_eq!(map(ScalarSource::Channel(2), 0.0, 1.0).channel(), Some(2));
        assert_eq!(map(ScalarSource::Channel(2), 0.0, 0.5).channel(), None);
    }
}
