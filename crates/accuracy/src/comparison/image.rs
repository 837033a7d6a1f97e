//! An image to be compared.

/// Pixels and what is known of their noise.
#[derive(Clone, Copy, Debug)]
pub struct Image<'a> {
    pixels: &'a [[f32; 3]],
    width: usize,
    standard_errors: Option<&'a [[f32; 3]]>,
}

impl<'a> Image<'a> {
    /// Linear red, green and blue, row by row, `width` pixels a row.
    ///
    /// # Panics
    /// If the last row is not full.
    pub fn new(pixels: &'a [[f32; 3]], width: usize) -> Self {
        assert!(pixels.is_empty() || pixels.len().is_multiple_of(width));
        Self {
            pixels,
            width,
            standard_errors: None,
        }
    }

    /// The same image with the standard error of each of its numbers: the standard deviation of the pixel's mean, in the unit
    /// of the pixels.
    ///
    /// # Panics
    /// If there are not as many as pixels.
    #[must_use]
    pub fn with_standard_errors(self, standard_errors: &'a [[f32; 3]]) -> Self {
        assert_eq!(self.pixels.len(), standard_errors.len());
        Self {
            standard_errors: Some(standard_errors),
            ..self
        }
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.pixels.len() / self.width.max(1)]
    }

    /// The pixels, row by row.
    pub fn pixels(&self) -> &'a [[f32; 3]] {
        self.pixels
    }

    /// The standard errors, row by row, where they are known.
    pub fn standard_errors(&self) -> Option<&'a [[f32; 3]]> {
        self.standard_errors
    }

    /// All numbers, channel after channel of pixel after pixel.
    pub(crate) fn values(&self) -> impl Iterator<Item = f64> + Clone + use<'a> {
        self.pixels.as_flattened().iter().map(|&c| f64::from(c))
    }

    /// The variances of all numbers, where they are known.
    pub(crate) fn variances(&self) -> Option<impl Iterator<Item = f64> + Clone + use<'a>> {
        let errors = self.standard_errors?.as_flattened();
        Some(errors.iter().map(|&error| f64::from(error).powi(2)))
    }
}
