//! Two images that can be compared.

use std::fmt;

use super::image::Image;

/// A reference and a test of the same size, whose numbers are all finite.
#[derive(Clone, Copy, Debug)]
pub struct Pair<'a> {
    reference: Image<'a>,
    test: Image<'a>,
}

impl<'a> Pair<'a> {
    /// Nothing is left out of a comparison: what no metric is defined of is refused.
    ///
    /// # Errors
    /// If there are no pixels, sizes differ, pixels are not finite, or standard errors are not finite or below 0.
    pub fn new(reference: Image<'a>, test: Image<'a>) -> Result<Self, PairError> {
        if reference.size() != test.size() {
            return Err(PairError::Sizes {
                reference: reference.size(),
                test: test.size(),
            });
        }
        if reference.pixels().is_empty() {
            return Err(PairError::Empty);
        }
        for (role, image) in [(Role::Reference, &reference), (Role::Test, &test)] {
            let [width, _] = image.size();
            if let Some((count, first)) =
                offenders(image.pixels(), width, |number| !number.is_finite())
            {
                return Err(PairError::NotFinite { role, count, first });
            }
            let errors = image.standard_errors().unwrap_or_default();
            let refused = |number: f32| !(number.is_finite() && number >= 0.0);
            if let Some((count, first)) = offenders(errors, width, refused) {
                return Err(PairError::StandardErrors { role, count, first });
            }
        }
        Ok(Self { reference, test })
    }

    /// What is taken for the truth.
    pub fn reference(&self) -> Image<'a> {
        self.reference
    }

    /// What is compared with it.
    pub fn test(&self) -> Image<'a> {
        self.test
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [usize; 2] {
        self.reference.size()
    }

    /// Numbers of the reference and of the test, channel after channel of pixel after pixel.
    pub(crate) fn values(&self) -> impl Iterator<Item = (f64, f64)> + Clone + use<'a> {
        self.reference.values().zip(self.test.values())
    }

    /// How many numbers an image has.
    pub(crate) fn count(&self) -> usize {
        3 * self.reference.pixels().len()
    }
}

/// How many pixels have a refused number, and the first of them.
fn offenders(
    pixels: &[[f32; 3]],
    width: usize,
    refused: impl Fn(f32) -> bool,
) -> Option<(usize, [usize; 2])> {
    let mut offenders = (0..pixels.len()).filter(|&k| pixels[k].iter().any(|&c| refused(c)));
    let first = offenders.next()?;
    Some((1 + offenders.count(), [first % width, first / width]))
}

/// Which of the two images.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// What is taken for the truth.
    Reference,
    /// What is compared with it.
    Test,
}

impl fmt::Display for Role {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Reference => "reference",
            Self::Test => "test",
        })
    }
}

/// Why two images cannot be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PairError {
    /// They have different widths or heights.
    #[error(
        "the reference has {} × {} pixels, the test {} × {}",
        reference[0], reference[1], test[0], test[1]
    )]
    Sizes {
        /// Width and height.
        reference: [usize; 2],
        /// Width and height.
        test: [usize; 2],
    },
    /// They have no pixels.
    #[error("the images have no pixels")]
    Empty,
    /// Pixels are infinite or no numbers.
    #[error(
        "the {role} has pixels that are not finite: {count}, the first at {},{}; a comparison leaves none out",
        first[0], first[1]
    )]
    NotFinite {
        /// Of which image.
        role: Role,
        /// How many pixels.
        count: usize,
        /// Column and row, from the upper left.
        first: [usize; 2],
    },
    /// Standard errors are infinite, negative or no numbers.
    #[error(
        "the {role} has pixels whose standard error is no finite number from 0 on: {count}, the first at {},{}",
        first[0], first[1]
    )]
    StandardErrors {
        /// Of which image.
        role: Role,
        /// How many pixels.
        count: usize,
        /// Column and row, from the upper left.
        first: [usize; 2],
    },
}

/// What the noise of both images is needed for cannot be computed: an image comes without it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the {0} has no standard errors of its pixels")]
pub struct MissingStandardError(pub Role);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_compared_is_refused_by_name() {
        let good = [[1.0; 3]; 6];
        fn image(pixels: &[[f32; 3]]) -> Image<'_> {
            Image::new(pixels, 3)
        }
        assert!(Pair::new(image(&good), image(&good)).is_ok());
        fn message(reference: Image<'_>, test: Image<'_>) -> String {
            Pair::new(reference, test).unwrap_err().to_string()
        }
        assert_eq!(
            message(image(&good), Image::new(&good, 2)),
            "the reference has 3 × 2 pixels, the test 2 × 3"
        );
        assert!(message(image(&[]), image(&[])).contains("no pixels"));
        let mut bad = good;
        bad[4][1] = f32::NAN;
        bad[5] = [f32::INFINITY; 3];
        let text = message(image(&good), image(&bad));
        assert!(
            text.contains("the test has pixels that are not finite: 2") && text.contains("1,1")
        );
        let text = message(image(&bad), image(&good));
        assert!(text.contains("the reference has pixels"), "{text}");
        for error in [-1.0, f32::NAN, f32::INFINITY] {
            let mut errors = good;
            errors[2][2] = error;
            let text = message(image(&good).with_standard_errors(&errors), image(&good));
            assert!(text.contains("standard error") && text.contains("2,0"));
        }
    }
}
