//! Layers of an image: what is kept of a pixel beside its radiance, for compositing and denoising.
//!
//! A renderer is made for a set of [`Layers`]; what is not in the set is not computed, stored or compiled in. A sample is
//! then a row of [`Layers::stride`] numbers: radiance, and the channels of its layers in their order.

use std::fmt;
use std::str::FromStr;

use crate::cryptomatte::LEVELS;

/// How the samples of a pixel become its value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reduction {
    /// Their mean.
    Mean,
    /// The first sample as it is: means of indices and of places on two objects mean nothing.
    First,
    /// Which ids they have, and how many of them have each: the ids that cover most of the pixel, the largest first, each
    /// with the part that it covers.
    Coverage,
    /// What is known of all of them; no sample holds any of it.
    Statistic(Statistic),
}

/// What is known of a pixel's samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Statistic {
    /// How many there are.
    Count,
    /// Variance of one of them.
    Variance,
    /// Standard error of their mean.
    StandardError,
}

macro_rules! layers {
    ($($(#[doc = $doc:literal])* $layer:ident = $name:literal, $channels:expr, $reduction:expr;)*) => {
        /// A layer that samples fill, beside radiance.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Layer {
            $($(#[doc = $doc])* $layer,)*
        }

        impl Layer {
            /// All of them, in the order of their channels.
            pub const ALL: [Self; [$($name),*].len()] = [$(Self::$layer),*];

            /// Its name in files and on the command line.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$layer => $name,)* }
            }

            /// The names of its channels within it.
            pub const fn channels(self) -> &'static [&'static str] {
                match self { $(Self::$layer => &$channels,)* }
            }

            /// How its samples are combined.
            pub const fn reduction(self) -> Reduction {
                match self { $(Self::$layer => $reduction,)* }
            }

            /// How many numbers of a sample are its.
            pub const fn width(self) -> usize {
                match self.reduction() {
                    Reduction::Mean | Reduction::First => self.channels().len(),
                    Reduction::Coverage => 1,
                    Reduction::Statistic(_) => 0,
                }
            }
        }
    };
}

/// Ids and coverages by rank, two of each in every numbered layer of a file.
const CRYPTOMATTE: [&str; 2 * LEVELS] = [
    "00.R", "00.G", "00.B", "00.A", "01.R", "01.G", "01.B", "01.A", "02.R", "02.G", "02.B", "02.A",
];

layers! {
    /// How much light the surface seen first reflects, in [0, 1], as denoisers want it; 0 where nothing is seen.
    Albedo = "albedo", ["R", "G", "B"], Reduction::Mean;
    /// Its shading normal, world space, on the side of the eye; 0 where nothing is seen.
    Normal = "normal", ["X", "Y", "Z"], Reduction::Mean;
    /// Distance from the origin of the camera ray; [`FAR`] where nothing is seen.
    Depth = "depth", ["Z"], Reduction::First;
    /// The point seen, world space.
    Position = "position", ["X", "Y", "Z"], Reduction::First;
    /// Index of the object (an instance of a mesh), counted from 1; 0 where nothing is seen.
    ObjectIndex = "object_index", ["X"], Reduction::First;
    /// Index of the material in the file, counted from 1; 0 where nothing is seen.
    MaterialIndex = "material_index", ["X"], Reduction::First;
    /// How many samples the pixel has.
    SampleCount = "sample_count", ["X"], Reduction::Statistic(Statistic::Count);
    /// Variance of one sample of the pixel, of red, green, blue and luminance.
    Variance = "variance", ["R", "G", "B", "Y"], Reduction::Statistic(Statistic::Variance);
    /// Standard error of the pixel: the root of the mean squared difference to the true image that is to be expected.
    StandardError = "standard_error", ["R", "G", "B", "Y"], Reduction::Statistic(Statistic::StandardError);
    /// [Ids](crate::cryptomatte) of the objects' names.
    CryptoObject = "crypto_object", CRYPTOMATTE, Reduction::Coverage;
    /// [Ids](crate::cryptomatte) of the materials' names.
    CryptoMaterial = "crypto_material", CRYPTOMATTE, Reduction::Coverage;
}

/// The depth of nothing: compositors expect a large finite number.
pub const FAR: f32 = 1e10;

/// A set of layers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Layers(u32);

impl Layers {
    /// Radiance alone.
    pub const NONE: Self = Self(0);
    /// Channels of radiance, which come first.
    pub const RADIANCE: usize = 3;
    /// The most numbers that a sample can have.
    pub const MAX_STRIDE: usize = {
        let mut all = Self::NONE;
        let mut k = 0;
        while k < Layer::ALL.len() {
            all = all.with(Layer::ALL[k]);
            k += 1;
        }
        all.stride()
    };

    /// The set with one more layer.
    #[must_use]
    pub const fn with(self, layer: Layer) -> Self {
        Self(self.0 | 1 << layer as u32)
    }

    /// Whether the layer is in the set.
    #[inline(always)]
    pub const fn has(self, layer: Layer) -> bool {
        self.0 >> layer as u32 & 1 == 1
    }

    /// The layers of the set in order.
    pub fn iter(self) -> impl Iterator<Item = Layer> {
        Layer::ALL.into_iter().filter(move |&layer| self.has(layer))
    }

    /// Those of them that samples hold numbers of.
    pub fn of_samples(self) -> impl Iterator<Item = Layer> {
        self.iter().filter(|layer| layer.width() > 0)
    }

    /// How many numbers a sample has.
    #[inline(always)]
    pub const fn stride(self) -> usize {
        let (mut stride, mut k) = (Self::RADIANCE, 0);
        while k < Layer::ALL.len() {
            if self.has(Layer::ALL[k]) {
                stride += Layer::ALL[k].width();
            }
            k += 1;
        }
        stride
    }

    /// Where the numbers of a layer begin in a sample.
    #[inline(always)]
    pub const fn offset(self, layer: Layer) -> usize {
        let before = (1 << layer as u32) - 1;
        Self(self.0 & before).stride()
    }

    /// The set as a number, for the boundary to compiled renderers.
    pub const fn bits(self) -> u32 {
        self.0
    }

    /// The set of a number.
    pub const fn from_bits(bits: u32) -> Self {
        Self(bits & ((1 << Layer::ALL.len()) - 1))
    }
}

impl FromIterator<Layer> for Layers {
    fn from_iter<I: IntoIterator<Item = Layer>>(layers: I) -> Self {
        layers.into_iter().fold(Self::NONE, Self::with)
    }
}

impl Layer {
    /// The names of its channels in files.
    pub fn channel_names(self) -> impl Iterator<Item = String> {
        let between = match self.reduction() {
            Reduction::Coverage => "",
            Reduction::Mean | Reduction::First | Reduction::Statistic(_) => ".",
        };
        let channels = self.channels().iter();
        channels.map(move |channel| format!("{self}{between}{channel}"))
    }
}

impl fmt::Display for Layer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Layer {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|layer| layer.name() == text);
        found.ok_or_else(|| {
            let names = Self::ALL.map(Self::name);
            format!("{text:?} is no layer; there are {}", names.join(", "))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_set_of_layers_is_laid_out_without_gaps() {
        for bits in 0..1 << Layer::ALL.len() {
            let layers = Layers::from_bits(bits);
            assert_eq!(layers, layers.iter().collect());
            let mut next = Layers::RADIANCE;
            for layer in layers.iter() {
                assert_eq!(layers.offset(layer), next, "{layer} of {bits:b}");
                next += layer.width();
            }
            assert_eq!(layers.stride(), next, "{bits:b}");
        }
        assert_eq!(Layers::MAX_STRIDE, 17);
    }

    #[test]
    fn names_are_read_back() {
        for layer in Layer::ALL {
            assert_eq!(layer.name().parse(), Ok(layer));
        }
        assert!("beauty".parse::<Layer>().is_err());
    }
}
