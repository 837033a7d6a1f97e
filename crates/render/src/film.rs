//! The film: per-pixel sums and variances, in `f64`, so that neither saturates nor cancels (hard cases S-01, S-02).

/// What is kept of a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Pixel {
    /// Sum of the samples.
    sum: [f64; 3],
    /// Running mean of the samples' luminance (Welford 1962).
    mean: f64,
    /// Sum of squared deviations from it.
    deviations: f64,
}

/// An image being accumulated.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    width: u32,
    height: u32,
    samples: u64,
    pixels: Vec<Pixel>,
    invalid: u64,
}

/// How far an image is from its limit, from its own variance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorEstimate {
    /// Relative mean squared error, averaged over pixels: var/n ÷ (mean² + 1e-2·(scene mean)²).
    pub relmse: f64,
    /// Half the width of the 95 % confidence interval of `relmse`.
    pub ci95: f64,
}

impl Film {
    /// A black film.
    pub fn new(width: u32, height: u32) -> Self {
        let pixels = vec![Pixel::default(); width as usize * height as usize];
        Self { width, height, samples: 0, pixels, invalid: 0 }
    }

    /// Pixels a row.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Samples a pixel so far.
    pub fn samples(&self) -> u64 {
        self.samples
    }

    /// Samples that were NaN, infinite or negative. They count as black; a healthy render has none.
    pub fn invalid_samples(&self) -> u64 {
        self.invalid
    }

    /// Adds `count` samples to every pixel of the rectangle at (x, y); `radiance[sample][row][column][channel]`.
    ///
    /// Tiles of one pass may come in any order; the samples of a pixel are always added in theirs, so the film
    /// does not depend on tiles or threads. Call [`Film::finish_pass`] when all pixels have theirs.
    pub fn add_tile(&mut self, [x, y]: [u32; 2], [width, height]: [u32; 2], radiance: &[f32]) {
        let area = width as usize * height as usize;
        for (pass, samples) in radiance.chunks_exact(area * 3).enumerate() {
            let n = (self.samples + pass as u64 + 1) as f64;
            for (place, sample) in samples.chunks_exact(3).enumerate() {
                let column = x as usize + place % width as usize;
                let row = y as usize + place / width as usize;
                let rgb = [sample[0], sample[1], sample[2]];
                let valid = rgb.iter().all(|c| c.is_finite() && *c >= 0.0);
                self.invalid += u64::from(!valid);
                let rgb = if valid { rgb.map(f64::from) } else { [0.0; 3] };
                self.pixels[row * self.width as usize + column].add(rgb, n);
            }
        }
    }

    /// `count` more samples are in every pixel.
    pub fn finish_pass(&mut self, count: u64) {
        self.samples += count;
    }

    /// The image: mean linear red, green, blue, row by row from the top.
    pub fn image(&self) -> Vec<[f32; 3]> {
        let scale = 1.0 / self.samples.max(1) as f64;
        self.pixels.iter().map(|p| p.sum.map(|c| (c * scale) as f32)).collect()
    }

    /// Mean of the whole image.
    pub fn mean(&self) -> [f64; 3] {
        let scale = 1.0 / (self.samples.max(1) as f64 * self.pixels.len() as f64);
        let sum = self.pixels.iter().fold([0.0; 3], |sum, p| [0, 1, 2].map(|k| sum[k] + p.sum[k]));
        sum.map(|c| c * scale)
    }

    /// The estimated error; `None` below two samples a pixel.
    pub fn error(&self) -> Option<ErrorEstimate> {
        if self.samples < 2 || self.pixels.is_empty() {
            return None;
        }
        let n = self.samples as f64;
        let count = self.pixels.len() as f64;
        let scene = self.pixels.iter().map(|p| p.mean).sum::<f64>() / count;
        let floor = 1e-2 * scene * scene;
        let relative = |p: &Pixel| {
            let variance = p.deviations / (n - 1.0) / n;
            let denominator = p.mean * p.mean + floor;
            if denominator > 0.0 { variance / denominator } else { 0.0 }
        };
        let relmse = self.pixels.iter().map(relative).sum::<f64>() / count;
        let spread = self.pixels.iter().map(|p| (relative(p) - relmse).powi(2)).sum::<f64>();
        let ci95 = 1.96 * (spread / (count - 1.0).max(1.0) / count).sqrt();
        Some(ErrorEstimate { relmse, ci95 })
    }
}

impl Pixel {
    fn add(&mut self, rgb: [f64; 3], n: f64) {
        for (sum, c) in self.sum.iter_mut().zip(rgb) {
            *sum += c;
        }
        let luminance = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
        let delta = luminance - self.mean;
        self.mean += delta / n;
        self.deviations += delta * (luminance - self.mean);
    }
}
