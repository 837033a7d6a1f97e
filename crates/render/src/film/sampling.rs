//! How samples are spread over an image.

use std::fmt;
use std::str::FromStr;

/// How samples are spread over the image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sampling {
    /// Every pixel gets as many.
    #[default]
    Uniform,
    /// Parts of the image get them by their noise, so that the relative mean squared error is least. The image is right on
    /// average all the same: no part's number depends on its own samples.
    Adaptive,
}

impl fmt::Display for Sampling {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Uniform => "uniform",
            Self::Adaptive => "adaptive",
        })
    }
}

impl FromStr for Sampling {
    type Err = String;
    fn from_str(name: &str) -> Result<Self, String> {
        let all = [Self::Uniform, Self::Adaptive];
        let named = all
            .into_iter()
            .find(|sampling| sampling.to_string() == name);
        named.ok_or_else(|| "there are uniform and adaptive".to_owned())
    }
}
