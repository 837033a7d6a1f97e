//! Errors pixel by pixel.

/// ꟻLIP of each pixel, row by row: 0 where nothing differs, 1 between green and blue.
#[derive(Clone, Debug, PartialEq)]
pub struct FlipMap {
    values: Vec<f64>,
}

impl FlipMap {
    pub(super) fn new(values: Vec<f64>) -> Self {
        Self { values }
    }

    /// The values in [0, 1], row by row.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Their mean, by which the papers compare images; 0 of an empty image.
    pub fn mean(&self) -> f64 {
        self.values.iter().sum::<f64>() / self.values.len().max(1) as f64
    }

    /// Keeps the larger error of each pixel.
    pub(super) fn raise_to(&mut self, other: &Self) {
        for (value, other) in self.values.iter_mut().zip(&other.values) {
            *value = value.max(*other);
        }
    }
}
