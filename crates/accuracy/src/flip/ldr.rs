//! ꟻLIP: how different two images look to somebody who flips between them (Andersson, Nilsson, Akenine-Möller, Oskarsson,
//! Åström, Fairchild 2020, *FLIP: A Difference Evaluator for Alternating Images*; the numbers in brackets are its equations).

use std::f64::consts::PI;

use super::map::FlipMap;

/// Pixels a degree: a monitor of 3840 pixels and 0.7 m, seen from 0.7 m.
const PIXELS_PER_DEGREE: f64 = 67.020_643;

type Color = [f64; 3];

/// Linear Rec. 709 to XYZ.
const TO_XYZ: [Color; 3] = [
    [
        10135552.0 / 24577794.0,
        8788810.0 / 24577794.0,
        4435075.0 / 24577794.0,
    ],
    [
        2613072.0 / 12288897.0,
        8788810.0 / 12288897.0,
        887015.0 / 12288897.0,
    ],
    [
        1425312.0 / 73733382.0,
        8788810.0 / 73733382.0,
        70074185.0 / 73733382.0,
    ],
];

/// Mean ꟻLIP of a picture against a reference, both linear, row by row, shown on a screen that clips at 1: 0 where nothing
/// differs, 1 between green and blue.
///
/// # Panics
/// If the images are not `width` wide and equally high.
pub fn flip(reference: &[[f32; 3]], test: &[[f32; 3]], width: usize) -> f64 {
    flip_map(reference, test, width).mean()
}

/// ꟻLIP of each pixel, of images as for [`flip()`].
///
/// # Panics
/// If the images are not `width` wide and equally high.
pub fn flip_map(reference: &[[f32; 3]], test: &[[f32; 3]], width: usize) -> FlipMap {
    assert!(reference.len() == test.len() && reference.len().is_multiple_of(width));
    if reference.is_empty() {
        return FlipMap::new(Vec::new());
    }
    let (a, b) = (Seen::new(reference, width), Seen::new(test, width));
    let most = hyab(hunt_lab([0.0, 1.0, 0.0]), hunt_lab([0.0, 0.0, 1.0])).powf(COLOR_POWER);
    let difference = |k: usize| {
        let color = redistribute(hyab(a.colors[k], b.colors[k]).powf(COLOR_POWER), most);
        let edges = (a.edges[k] - b.edges[k]).abs();
        let points = (a.points[k] - b.points[k]).abs();
        // [12], [13]
        let feature = (edges.max(points) / 2_f64.sqrt()).powf(0.5);
        color.powf(1.0 - feature.min(1.0))
    };
    FlipMap::new((0..reference.len()).map(difference).collect())
}

const COLOR_POWER: f64 = 0.7;

/// What the eye gets from an image.
struct Seen {
    /// Filtered by contrast sensitivity, in Hunt-adjusted L*a*b*.
    colors: Vec<Color>,
    edges: Vec<f64>,
    points: Vec<f64>,
}

impl Seen {
    fn new(image: &[[f32; 3]], width: usize) -> Self {
        let opponent: Vec<Color> = image
            .iter()
            .map(|rgb| opponent(rgb.map(|c| f64::from(c).clamp(0.0, 1.0))))
            .collect();
        let channel = |k: usize| opponent.iter().map(|c| c[k]).collect::<Vec<_>>();
        let [y, cx, cz] = [channel(0), channel(1), channel(2)];
        // [4], table 1; red-green and luminance are one Gaussian each.
        let sensitivity = |image: &[f64], terms: &[[f64; 2]]| contrast_filter(image, width, terms);
        let filtered = [
            sensitivity(&y, &[[1.0, 0.0047]]),
            sensitivity(&cx, &[[1.0, 0.0053]]),
            sensitivity(&cz, &[[34.1, 0.04], [13.5, 0.025]]),
        ];
        let colors = (0..image.len())
            .map(|k| {
                hunt_lab(from_opponent([
                    filtered[0][k],
                    filtered[1][k],
                    filtered[2][k],
                ]))
            })
            .collect();
        let luminance: Vec<f64> = y.iter().map(|y| (y + 16.0) / 116.0).collect();
        let (edge, point, blur) = feature_kernels();
        let magnitude = |kernel: &[f64]| -> Vec<f64> {
            let across = convolve(&luminance, width, kernel, &blur);
            let down = convolve(&luminance, width, &blur, kernel);
            across.iter().zip(down).map(|(x, y)| x.hypot(y)).collect()
        };
        Self {
            colors,
            edges: magnitude(&edge),
            points: magnitude(&point),
        }
    }
}

fn transform(matrix: [Color; 3], v: Color) -> Color {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// XYZ over that of white.
fn relative_xyz(rgb: Color) -> Color {
    let (xyz, white) = (transform(TO_XYZ, rgb), transform(TO_XYZ, [1.0; 3]));
    [0, 1, 2].map(|k| xyz[k] / white[k])
}

/// YCxCz: a linear L*a*b*.
fn opponent(rgb: Color) -> Color {
    let [x, y, z] = relative_xyz(rgb);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Back to linear red, green and blue in [0, 1].
fn from_opponent([y, cx, cz]: Color) -> Color {
    const FROM_XYZ: [Color; 3] = [
        [3.241003275, -1.537398934, -0.498615861],
        [-0.969224334, 1.875930071, 0.041554224],
        [0.055639423, -0.204011202, 1.057148933],
    ];
    let y = (y + 16.0) / 116.0;
    let relative = [y + cx / 500.0, y, y - cz / 200.0];
    let white = transform(TO_XYZ, [1.0; 3]);
    let xyz = [0, 1, 2].map(|k| relative[k] * white[k]);
    transform(FROM_XYZ, xyz).map(|c| c.clamp(0.0, 1.0))
}

/// L*a*b* with colourfulness that grows with lightness (Hunt 1952).
fn hunt_lab(rgb: Color) -> Color {
    const DELTA: f64 = 6.0 / 29.0;
    let f = |t: f64| {
        if t > DELTA.powi(3) {
            t.cbrt()
        } else {
            t / (3.0 * DELTA * DELTA) + 4.0 / 29.0
        }
    };
    let [x, y, z] = relative_xyz(rgb).map(f);
    let lightness = 116.0 * y - 16.0;
    let hunt = 0.01 * lightness;
    [lightness, hunt * 500.0 * (x - y), hunt * 200.0 * (y - z)]
}

/// HyAB distance [6].
fn hyab(a: Color, b: Color) -> f64 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}

/// Distances to [0, 1]: the small ones get most of it [8].
fn redistribute(distance: f64, most: f64) -> f64 {
    const PART: f64 = 0.4;
    const RANGE: f64 = 0.95;
    let knee = PART * most;
    if distance < knee {
        RANGE / knee * distance
    } else {
        (RANGE + (distance - knee) / (most - knee) * (1.0 - RANGE)).min(1.0)
    }
}

/// Sums of Gaussians `[a, b]`, a·√(π/b)·exp(−π²x²/b) with x in degrees, together of weight 1.
fn contrast_filter(image: &[f64], width: usize, terms: &[[f64; 2]]) -> Vec<f64> {
    // Three standard deviations of the widest of all filters.
    let radius = (3.0 * (0.04 / (2.0 * PI * PI)).sqrt() * PIXELS_PER_DEGREE).ceil() as i32;
    let mut sum = vec![0.0; image.len()];
    let mut total = 0.0;
    for [a, b] in terms {
        let gaussian = |x: i32| (-(PI * f64::from(x) / PIXELS_PER_DEGREE).powi(2) / b).exp();
        let kernel: Vec<f64> = (-radius..=radius).map(gaussian).collect();
        let scale = a * (PI / b).sqrt();
        total += scale * kernel.iter().sum::<f64>().powi(2);
        for (sum, value) in sum.iter_mut().zip(convolve(image, width, &kernel, &kernel)) {
            *sum += scale * value;
        }
    }
    sum.iter().map(|value| value / total).collect()
}

/// First and second derivative of a Gaussian, whose positive and negative parts weigh 1 each, and the Gaussian [10].
fn feature_kernels() -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let sigma = 0.5 * 0.082 * PIXELS_PER_DEGREE;
    let radius = (3.0 * sigma).ceil() as i32;
    let kernel = |f: &dyn Fn(f64) -> f64| -> Vec<f64> {
        (-radius..=radius)
            .map(|x| {
                let x = f64::from(x);
                f(x) * (-x * x / (2.0 * sigma * sigma)).exp()
            })
            .collect()
    };
    let balanced = |kernel: Vec<f64>| -> Vec<f64> {
        let weight = |sign: f64| -> f64 {
            let part = kernel.iter().map(|w| (w * sign).max(0.0));
            part.sum()
        };
        let (positive, negative) = (weight(1.0), weight(-1.0));
        let scaled = kernel.iter().map(|w| match *w > 0.0 {
            true => w / positive,
            false => w / negative,
        });
        scaled.collect()
    };
    let blur = kernel(&|_| 1.0);
    let sum: f64 = blur.iter().sum();
    (
        balanced(kernel(&|x| -x)),
        balanced(kernel(&|x| x * x / (sigma * sigma) - 1.0)),
        blur.iter().map(|w| w / sum).collect(),
    )
}

/// A separable filter; beyond the border its pixels go on.
fn convolve(image: &[f64], width: usize, across: &[f64], down: &[f64]) -> Vec<f64> {
    let height = image.len() / width;
    let at = |place: usize, offset: usize, kernel: &[f64], size: usize| {
        (place + offset)
            .saturating_sub(kernel.len() / 2)
            .min(size - 1)
    };
    let mut rows = Vec::with_capacity(image.len());
    for row in image.chunks(width) {
        rows.extend((0..width).map(|x| {
            let terms = across.iter().enumerate();
            terms
                .map(|(k, weight)| weight * row[at(x, k, across, width)])
                .sum::<f64>()
        }));
    }
    let mut result = vec![0.0; image.len()];
    for (y, row) in result.chunks_mut(width).enumerate() {
        for (k, weight) in down.iter().enumerate() {
            let from = at(y, k, down, height) * width;
            for (value, source) in row.iter_mut().zip(&rows[from..from + width]) {
                *value += weight * source;
            }
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(width: usize, height: usize, f: impl Fn(f32, f32) -> [f32; 3]) -> Vec<[f32; 3]> {
        let pixel = |k: usize| f((k % width) as f32, (k / width) as f32);
        (0..width * height).map(pixel).collect()
    }

    #[test]
    fn ends_of_the_scale() {
        let plain = |rgb| image(20, 15, move |_, _| rgb);
        let (black, white) = (plain([0.0; 3]), plain([1.0; 3]));
        assert!(flip(&black, &black, 20).abs() < 1e-6);
        // Beyond white there is white.
        assert!(flip(&white, &plain([7.0; 3]), 20).abs() < 1e-6);
        // Green and blue are the farthest apart by definition, lightness 100 against 0 is nearly as far.
        let (green, blue) = (plain([0.0, 1.0, 0.0]), plain([0.0, 0.0, 1.0]));
        assert!((flip(&green, &blue, 20) - 1.0).abs() < 1e-6);
        // Greys without features: closed form, with lightness 100 and 116·∛¼ − 16.
        let most = hyab(hunt_lab([0.0, 1.0, 0.0]), hunt_lab([0.0, 0.0, 1.0])).powf(0.7);
        let lightness = 116.0 * 0.25_f64.cbrt() - 16.0;
        let expected = redistribute((100.0 - lightness).powf(0.7), most);
        assert!((flip(&white, &plain([0.25; 3]), 20) - expected).abs() < 1e-6);
    }

    /// Numbers of the authors' own program (flip-evaluator 1.7, LDR, linear input).
    #[test]
    fn the_authors_numbers() {
        let waves = |x: f32, y: f32| {
            let wave = |f: f32| 0.5 + 0.5 * (f * x + 0.3 * y).sin();
            [wave(0.31), wave(0.17), wave(0.07)]
        };
        let reference = image(61, 47, waves);
        let brighter = image(61, 47, |x, y| waves(x, y).map(|c| 0.9 * c + 0.1));
        let moved = image(61, 47, |x, y| waves(x + 0.5, y));
        let dotted = image(61, 47, |x, y| {
            let dot = x % 9.0 == 4.0 && y % 7.0 == 3.0;
            if dot { [1.0, 0.2, 0.0] } else { waves(x, y) }
        });
        for (test, expected) in [
            (&brighter, EXPECTED[0]),
            (&moved, EXPECTED[1]),
            (&dotted, EXPECTED[2]),
        ] {
            let ours = flip(&reference, test, 61);
            assert!(
                (ours - expected).abs() < 2e-4,
                "{ours} instead of {expected}"
            );
        }
    }

    const EXPECTED: [f64; 3] = [0.296_868_3, 0.201_710_0, 0.066_588_6];
}
