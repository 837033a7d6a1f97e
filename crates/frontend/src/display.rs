//! From radiance to what a screen shows: exposure, then a tone curve, then the codes of sRGB. Files of linear radiance know
//! nothing of it.

use std::str::FromStr;

use clap::ValueEnum;
use residual_accuracy::luminance;
use residual_render::texture::srgb_code;

/// How pictures of 8 bits are made.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Display {
    /// How bright.
    pub exposure: Exposure,
    /// By which curve.
    pub tone_map: ToneMap,
}

/// The factor on radiance before the curve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Exposure {
    /// 1, but metered where most of the picture would be white: photometric lights, in candela and lux, make pictures of
    /// hundreds and thousands.
    #[default]
    Fitting,
    /// 2 to the power of so many stops.
    Stops(f32),
    /// As a camera meters it: the mean luminance, averaged over its logarithm where there is light, becomes middle grey.
    Auto,
}

/// From this share of white pixels on, a picture says little.
const MUCH_WHITE: f64 = 0.5;

/// The part of the pixels that are brighter than white in all channels.
fn part_beyond_white(image: &[[f32; 3]]) -> f64 {
    // Rounding of white is white.
    const WHITE: f32 = 1.01;
    let is_beyond = |rgb: &&[f32; 3]| rgb.iter().all(|&value| value > WHITE);
    image.iter().filter(is_beyond).count() as f64 / image.len().max(1) as f64
}

/// Reflectance of a photographer's grey card.
const MIDDLE_GREY: f64 = 0.18;

impl Exposure {
    /// The factor for an image.
    pub fn factor(self, image: &[[f32; 3]]) -> f32 {
        match self {
            Self::Fitting if part_beyond_white(image) < MUCH_WHITE => 1.0,
            Self::Stops(stops) => stops.exp2(),
            Self::Fitting | Self::Auto => {
                let luminances = image.iter().map(|rgb| luminance(*rgb));
                let lit = luminances.filter(|y| *y > 0.0 && y.is_finite());
                let (sum, count) = lit.fold((0.0, 0_u32), |(sum, n), y| (sum + y.ln(), n + 1));
                match count {
                    0 => 1.0,
                    _ => (MIDDLE_GREY / (sum / f64::from(count)).exp()) as f32,
                }
            }
        }
    }
}

impl FromStr for Exposure {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        if text == "auto" {
            return Ok(Self::Auto);
        }
        let stops = text.parse::<f32>().ok();
        stops
            .filter(|stops| stops.abs() <= 64.0)
            .map(Self::Stops)
            .ok_or_else(|| "expected auto, or stops from -64 to 64, as in -1.5".to_owned())
    }
}

/// Curves from linear radiance to linear display values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum ToneMap {
    /// None: what is brighter than white is white
    #[default]
    Srgb,
    /// Khronos PBR Neutral: base colours as they are, highlights compressed; for models
    Neutral,
    /// The film-like curve of ACES
    Aces,
    /// AgX: highlights lose colour as on film; for scenes of high contrast
    Agx,
}

impl ToneMap {
    /// The display value of a colour.
    pub fn apply(self, color: [f32; 3]) -> [f32; 3] {
        // What is no number is black, as in the codes.
        let color = color.map(|c| {
            if c > 0.0 {
                f64::from(c.min(f32::MAX))
            } else {
                0.0
            }
        });
        let mapped = match self {
            Self::Srgb => color,
            Self::Neutral => neutral(color),
            Self::Aces => aces(color),
            Self::Agx => agx(color),
        };
        mapped.map(|c| c.clamp(0.0, 1.0) as f32)
    }
}

impl Display {
    /// What was done to an image that nobody has asked for.
    pub fn note(self, image: &[[f32; 3]]) -> Option<String> {
        let stops = self.exposure.factor(image).log2();
        let is_changed = self.exposure == Exposure::Fitting && stops != 0.0;
        is_changed.then(|| {
            format!(
                "{:.0} % of the pixels are brighter than white, as lights in candela and lux make them; the PNG is exposed by \
                 {stops:.1} stops (--exposure 0 shows them as they are)",
                100.0 * part_beyond_white(image)
            )
        })
    }

    /// The codes of an image.
    pub fn codes(self, image: &[[f32; 3]]) -> Vec<[u8; 3]> {
        let factor = self.exposure.factor(image);
        let code = |rgb: &[f32; 3]| self.tone_map.apply(rgb.map(|c| c * factor)).map(srgb_code);
        image.iter().map(code).collect()
    }
}

type Rgb = [f64; 3];

fn transform(rows: [Rgb; 3], [r, g, b]: Rgb) -> Rgb {
    rows.map(|row| row[0] * r + row[1] * g + row[2] * b)
}

/// Khronos PBR Neutral Tone Mapper, specification 1.0, section 2.
fn neutral(color: Rgb) -> Rgb {
    const START: f64 = 0.8 - 0.04;
    const DESATURATION: f64 = 0.15;
    let least = color.into_iter().fold(f64::MAX, f64::min);
    // Fresnel reflection of white light, which lightens all of a model.
    let offset = match least < 0.08 {
        true => least - 6.25 * least * least,
        false => 0.04,
    };
    let color = color.map(|c| c - offset);
    let peak = color.into_iter().fold(0.0, f64::max);
    if peak < START {
        return color;
    }
    let range = 1.0 - START;
    let new_peak = 1.0 - range * range / (peak + range - START);
    let white = 1.0 - 1.0 / (DESATURATION * (peak - new_peak) + 1.0);
    color.map(|c| {
        let compressed = c / peak * new_peak;
        compressed + (new_peak - compressed) * white
    })
}

/// Hill's fit of the reference rendering and output transforms of ACES 1.0 (2016, as in MJP's BakingLab, ACES.hlsl).
fn aces(color: Rgb) -> Rgb {
    const IN: [Rgb; 3] = [
        [0.59719, 0.35458, 0.04823],
        [0.07600, 0.90834, 0.01566],
        [0.02840, 0.13383, 0.83777],
    ];
    const OUT: [Rgb; 3] = [
        [1.60475, -0.53108, -0.07367],
        [-0.10208, 1.10813, -0.00605],
        [-0.00327, -0.07276, 1.07602],
    ];
    let curve = |v: f64| {
        let v = v.min(1e6);
        (v * (v + 0.024_578_6) - 0.000_090_537) / (v * (0.983_729 * v + 0.432_951) + 0.238_081)
    };
    transform(OUT, transform(IN, color).map(curve))
}

/// AgX (Sobotka 2022) with the polynomial for its curve that Wrensch fitted (*Minimal AgX Implementation*, 2023), in the
/// primaries of Rec. 2020.
fn agx(color: Rgb) -> Rgb {
    const TO_REC2020: [Rgb; 3] = [
        [0.6274, 0.3293, 0.0433],
        [0.0691, 0.9195, 0.0113],
        [0.0164, 0.0880, 0.8956],
    ];
    const FROM_REC2020: [Rgb; 3] = [
        [1.6605, -0.5876, -0.0728],
        [-0.1246, 1.1329, -0.0083],
        [-0.0182, -0.1006, 1.1187],
    ];
    const INSET: [Rgb; 3] = [
        [
            0.856_627_153_315_983,
            0.095_121_240_538_158_8,
            0.048_251_606_145_858_3,
        ],
        [
            0.137_318_972_929_847,
            0.761_241_990_602_591,
            0.101_439_036_467_562,
        ],
        [
            0.111_898_212_999_95,
            0.076_799_418_603_190_3,
            0.811_302_368_396_859,
        ],
    ];
    const OUTSET: [Rgb; 3] = [
        [
            1.127_100_581_814_436_8,
            -0.110_606_643_096_603_23,
            -0.016_493_938_717_834_573,
        ],
        [
            -0.141_329_763_498_438_3,
            1.157_823_702_216_272,
            -0.016_493_938_717_834_257,
        ],
        [
            -0.141_329_763_498_438_26,
            -0.110_606_643_096_602_94,
            1.251_936_406_595_040_5,
        ],
    ];
    const LEAST_STOPS: f64 = -12.473_93;
    const MOST_STOPS: f64 = 4.026_069;
    let curve = |v: f64| {
        let stops = (v.max(1e-10).log2() - LEAST_STOPS) / (MOST_STOPS - LEAST_STOPS);
        let x = stops.clamp(0.0, 1.0);
        [-0.00232, 0.1191, 0.4298, -6.868, 31.96, -40.14, 15.5]
            .into_iter()
            .rev()
            .fold(0.0, |sum, factor| sum * x + factor)
    };
    let inset = transform(INSET, transform(TO_REC2020, color));
    // The curve gives codes of a display with a gamma of 2.2.
    let linear = transform(OUTSET, inset.map(curve)).map(|c| c.max(0.0).powf(2.2));
    transform(FROM_REC2020, linear)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [ToneMap; 4] = [ToneMap::Srgb, ToneMap::Neutral, ToneMap::Aces, ToneMap::Agx];

    #[test]
    fn greys_stay_grey_and_in_order() {
        for map in ALL {
            let mut last = -1.0;
            for stops in -40..=60 {
                let grey = 2_f32.powf(stops as f32 * 0.25);
                let [r, g, b] = map.apply([grey; 3]);
                assert!(r >= last, "{map:?} {grey}: {r} after {last}");
                assert!(
                    (r - g).abs() < 2e-3 && (g - b).abs() < 2e-3,
                    "{map:?} {grey}"
                );
                last = r;
            }
            assert!(last > 0.97, "{map:?}: {last}");
        }
    }

    #[test]
    fn whatever_comes_is_a_display_value() {
        let values = [
            0.0,
            -1.0,
            f32::NAN,
            f32::INFINITY,
            f32::MAX,
            1e-30,
            0.5,
            700.0,
        ];
        for map in ALL {
            for (r, g, b) in values.into_iter().flat_map(|r| {
                values
                    .into_iter()
                    .flat_map(move |g| values.map(move |b| (r, g, b)))
            }) {
                let mapped = map.apply([r, g, b]);
                assert!(
                    mapped.iter().all(|c| (0.0..=1.0).contains(c)),
                    "{map:?} {r} {g} {b}: {mapped:?}"
                );
            }
            assert_eq!(map.apply([f32::NAN; 3]), map.apply([0.0; 3]));
        }
    }

    /// Numbers that the specification and its authors give.
    #[test]
    fn known_values() {
        let close = |a: [f32; 3], b: [f32; 3], by: f32| {
            assert!(
                a.iter().zip(b).all(|(a, b)| (a - b).abs() < by),
                "{a:?}, not {b:?}"
            );
        };
        // A base colour under white light is seen with 4 % of reflection, which is taken off again.
        close(
            ToneMap::Neutral.apply([0.54, 0.34, 0.14]),
            [0.5, 0.3, 0.1],
            1e-6,
        );
        // Where compression begins, and its asymptote.
        close(ToneMap::Neutral.apply([0.8; 3]), [0.76; 3], 1e-6);
        close(ToneMap::Neutral.apply([1e6; 3]), [1.0; 3], 1e-5);
        // At peak 1.24: 1 − 0.24² ÷ (1.2 + 0.24 − 0.76).
        close(
            ToneMap::Neutral.apply([1.24; 3]),
            [1.0 - 0.0576 / 0.68; 3],
            1e-6,
        );
        // AgX has middle grey at half of the display's codes; ACES darkens it.
        close(ToneMap::Agx.apply([0.18; 3]), [0.5_f32.powf(2.2); 3], 0.005);
        close(ToneMap::Aces.apply([0.18; 3]), [0.104; 3], 0.02);
        assert_eq!(ToneMap::Srgb.apply([0.25, 2.0, 1.0]), [0.25, 1.0, 1.0]);
    }

    #[test]
    fn bright_colours_turn_white_but_for_the_clipped_curve() {
        for (map, least) in [
            (ToneMap::Srgb, 0.0),
            (ToneMap::Neutral, 0.9),
            (ToneMap::Agx, 0.6),
        ] {
            let [r, g, b] = map.apply([1000.0, 0.0, 0.0]);
            assert!(r > 0.9 && g >= least && b >= least, "{map:?}: {r} {g} {b}");
        }
    }

    #[test]
    fn exposure_is_a_factor_or_metered() {
        assert_eq!(Exposure::Stops(-2.0).factor(&[]), 0.25);
        let image = [[0.0; 3], [0.1; 3], [10.0; 3], [f32::NAN; 3]];
        assert!((Exposure::Auto.factor(&image) / 0.18 - 1.0).abs() < 1e-6);
        assert_eq!(Exposure::Auto.factor(&[[0.0; 3]]), 1.0);
        let display = Display {
            exposure: Exposure::Auto,
            tone_map: ToneMap::Srgb,
        };
        // Candela and lux: 683 times as bright is the same picture.
        let dark = [[0.1_f32, 0.2, 0.3], [0.4, 0.1, 0.05]];
        let bright = dark.map(|rgb| rgb.map(|c| 683.0 * c));
        assert_eq!(display.codes(&dark), display.codes(&bright));
    }

    #[test]
    fn pictures_that_would_be_white_are_exposed() {
        let display = Display::default();
        let white = vec![[326.0, 326.0, 300.0], [500.0; 3], [1500.0; 3], [0.5; 3]];
        let note = display.note(&white).unwrap();
        assert!(note.starts_with("75 %") && note.contains("stops"), "{note}");
        assert!(display.codes(&white)[0] < display.codes(&white)[2]);
        // White, colours and a few highlights are no reason.
        for image in [
            vec![[1.0; 3]],
            vec![[0.5, 9.0, 9.0]],
            vec![[0.5; 3], [0.1; 3], [40.0; 3]],
        ] {
            assert_eq!(display.note(&image), None);
            assert_eq!(display.exposure.factor(&image), 1.0);
        }
        let asked = Display {
            exposure: Exposure::Stops(0.0),
            ..display
        };
        assert_eq!(asked.note(&white), None);
    }

    #[test]
    fn exposures_parse() {
        assert_eq!("auto".parse(), Ok(Exposure::Auto));
        assert_eq!("-1.5".parse(), Ok(Exposure::Stops(-1.5)));
        assert!("bright".parse::<Exposure>().is_err() && "nan".parse::<Exposure>().is_err());
        assert!("1000".parse::<Exposure>().is_err());
    }
}
