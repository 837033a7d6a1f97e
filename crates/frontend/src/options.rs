//! Options of a render, as arguments.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;
use std::time::Duration;

use anyhow::{Result, bail};
use clap::builder::RangedU64ValueParser;
use clap::{Args, ValueEnum};
use residual_render::film::Sampling;
use residual_render::passes::RenderOptions;

use crate::display::{Display, Exposure, ToneMap};

const DEFAULT_SAMPLES: u32 = 64;

/// How long to render, and where to.
#[derive(Args, Clone, Debug)]
pub struct RenderArgs {
    /// Image file (.png, .exr); may be given more than once
    #[arg(short, long, value_name = "FILE")]
    pub output: Vec<PathBuf>,
    /// Brightness of a PNG in stops (-1.5), or auto, which makes the mean middle grey [default: 0, or auto where most of it would be
    /// white]
    #[arg(long, value_name = "STOPS|auto", allow_hyphen_values = true)]
    pub exposure: Option<Exposure>,
    /// How a PNG shows what is brighter than white
    #[arg(long, value_enum, default_value_t = ToneMap::default())]
    pub tonemap: ToneMap,
    /// Samples per pixel [default: 64, or as many as --time and --error allow]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub spp: Option<u32>,
    /// Stop after this time (30s, 2m, 500ms)
    #[arg(long, value_name = "TIME", value_parser = duration)]
    pub time: Option<Duration>,
    /// Stop when the relative error is below this (1%, 0.01) with 97.5 % confidence; the first of --spp, --time and --error ends
    #[arg(long, value_name = "ERROR", value_parser = relative_error)]
    pub error: Option<f64>,
    /// Spend more samples where the image is noisy and fewer where it is not; the average is --spp [default: true on the processor
    /// where --time or --error ends a render of paths from the camera]
    #[arg(long, value_name = "BOOL", num_args = 0..=1, require_equals = true, default_missing_value = "true")]
    pub adaptive: Option<bool>,
    /// Most vertices of a path: 1 is emission seen directly, 2 adds direct light [default: 8, or 256 where bodies scatter]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub max_depth: Option<u32>,
    /// First vertex at which Russian roulette may end a path
    #[arg(long, value_name = "N", default_value_t = RenderOptions::default().roulette_from, value_parser = clap::value_parser!(u32).range(1..))]
    pub roulette: u32,
    /// Seed of the random numbers
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u32,
    /// How far occluders count for ambient occlusion, and where the depth view turns black, in units of the scene
    /// [default: a tenth of the scene's diagonal, and the farthest corner of its box]
    #[arg(long, value_name = "DISTANCE", allow_negative_numbers = true, value_parser = distance)]
    pub reach: Option<f32>,
    /// Threads; 0 is one for each processor
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = RangedU64ValueParser::<usize>::new().range(..=1024))]
    pub threads: usize,
    /// Statistics on standard output
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub stats: Option<StatsFormat>,
    /// No progress and no summary
    #[arg(short, long)]
    pub quiet: bool,
}

impl RenderArgs {
    /// How pictures of 8 bits are made.
    pub fn display(&self) -> Display {
        Display {
            exposure: self.exposure.unwrap_or_default(),
            tone_map: self.tonemap,
        }
    }

    /// Whether the user leaves open how many samples there are.
    fn has_budget(&self) -> bool {
        self.time.is_some() || self.error.is_some()
    }

    /// How samples are spread: as the user says, or else by noise where that is possible and the sooner image is what was asked for.
    ///
    /// # Errors
    /// If the user asks for what is not possible.
    pub fn sampling(&self, even_only: Option<EvenOnly>) -> Result<Sampling> {
        let adaptive = match (self.adaptive, even_only) {
            (Some(true), Some(reason)) => bail!("--adaptive: {reason}"),
            (Some(adaptive), _) => adaptive,
            (None, reason) => reason.is_none() && self.has_budget(),
        };
        Ok(match adaptive {
            true => Sampling::Adaptive,
            false => Sampling::Uniform,
        })
    }

    /// What the device is told.
    pub fn render_options(
        &self,
        size: [u32; 2],
        scene: SceneDefaults,
        sampling: Sampling,
    ) -> RenderOptions {
        RenderOptions {
            size,
            samples: self.spp.or((!self.has_budget()).then_some(DEFAULT_SAMPLES)),
            time: self.time,
            error: self.error,
            sampling,
            max_depth: self.max_depth.unwrap_or(scene.max_depth),
            roulette_from: self.roulette,
            seed: self.seed,
            reach: self.reach.unwrap_or(scene.reach),
        }
    }
}

/// Why no part of an image can have more samples than another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EvenOnly {
    /// Any path may add to any pixel.
    LightPaths,
    /// The device takes all pixels alike.
    Gpu,
}

impl EvenOnly {
    /// Of the processor, which renders with this kind of tracer.
    pub fn of_processor(has_light_paths: bool) -> Option<Self> {
        has_light_paths.then_some(Self::LightPaths)
    }
}

impl fmt::Display for EvenOnly {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::LightPaths => "paths from lights add to any pixel, so that no pixel can have more of them; render with --tracer path",
            Self::Gpu => "a GPU takes as many samples of every pixel; render with --device cpu",
        })
    }
}

/// What a scene suggests where the user asks for nothing.
#[derive(Clone, Copy, Debug)]
pub struct SceneDefaults {
    /// Most vertices of a path.
    pub max_depth: u32,
    /// How far a tracer reaches.
    pub reach: f32,
}

/// How statistics are printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum StatsFormat {
    /// For people
    Text,
    /// One JSON object as the last line
    Json,
}

/// Width and height of an image in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size(pub [u32; 2]);

impl FromStr for Size {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        /// What a film keeps of so many pixels still fits a workstation's memory (5 GiB).
        const MOST_PIXELS: u64 = 1 << 27;
        let error = || {
            "expected width and height from 1 to 65536, at most 134 million pixels, as in 1280x720"
                .to_owned()
        };
        let (width, height) = text.split_once(['x', 'X']).ok_or_else(error)?;
        let parse = |part: &str| {
            let number = part.trim().parse::<u32>().ok();
            number.filter(|n| (1..=65536).contains(n)).ok_or_else(error)
        };
        let size = [parse(width)?, parse(height)?];
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        if pixels <= MOST_PIXELS {
            Ok(Self(size))
        } else {
            Err(error())
        }
    }
}

fn distance(text: &str) -> Result<f32, String> {
    let distance = text.parse::<f32>().ok();
    let distance = distance.filter(|distance| *distance > 0.0 && distance.is_finite());
    distance.ok_or_else(|| "expected a distance above 0".to_owned())
}

fn relative_error(text: &str) -> Result<f64, String> {
    let (number, scale) = match text.strip_suffix('%') {
        Some(number) => (number, 0.01),
        None => (text, 1.0),
    };
    let error = number.trim().parse::<f64>().ok().map(|x| x * scale);
    // Below a hundred-thousandth, 32-bit samples themselves are not so precise.
    error
        .filter(|error| (1e-5..=1.0).contains(error))
        .ok_or_else(|| "expected a relative error from 0.001% to 100%, as in 1% or 0.01".to_owned())
}

fn duration(text: &str) -> Result<Duration, String> {
    let units = [
        ("ms", 1e-3),
        ("s", 1.0),
        ("m", 60.0),
        ("h", 3600.0),
        ("", 1.0),
    ];
    let (number, scale) = units
        .iter()
        .find_map(|(unit, scale)| Some((text.strip_suffix(unit)?.parse::<f64>().ok()?, scale)))
        .ok_or_else(|| "expected a time, as in 30s, 2m or 500ms".to_owned())?;
    let seconds = number * scale;
    if seconds > 0.0 && seconds < 1e9 {
        Ok(Duration::from_secs_f64(seconds))
    } else {
        Err("expected a time above 0".to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_parse() {
        assert_eq!("640x480".parse(), Ok(Size([640, 480])));
        assert!("65536x65536".parse::<Size>().is_err());
        assert!("0x480".parse::<Size>().is_err() && "640".parse::<Size>().is_err());
        assert_eq!(duration("500ms"), Ok(Duration::from_millis(500)));
        assert_eq!(duration("2m"), Ok(Duration::from_secs(120)));
        assert_eq!(distance("0.5"), Ok(0.5));
        assert!(distance("0").is_err() && distance("inf").is_err() && distance("far").is_err());
        assert_eq!(relative_error("1%"), Ok(0.01));
        assert_eq!(relative_error("0.05"), Ok(0.05));
        for wrong in ["0", "-1%", "101%", "%", "nan", "small"] {
            assert!(relative_error(wrong).is_err(), "{wrong}");
        }
        assert!(duration("-1s").is_err() && duration("soon").is_err());
    }

    /// What a render is told by these arguments, or what is wrong with them.
    fn sampling(args: &[&str], even_only: Option<EvenOnly>) -> Result<Sampling, String> {
        #[derive(clap::Parser)]
        struct Command {
            #[command(flatten)]
            render: RenderArgs,
        }
        let args = ["render"].iter().chain(args);
        let command = <Command as clap::Parser>::try_parse_from(args).map_err(|e| e.to_string())?;
        command
            .render
            .sampling(even_only)
            .map_err(|e| e.to_string())
    }

    #[test]
    fn samples_follow_noise_where_a_limit_is_all_that_is_asked_for() {
        let (adaptive, uniform) = (Sampling::Adaptive, Sampling::Uniform);
        // Where it can be done, and where it cannot: `None` is a refusal.
        for (args, possible, impossible) in [
            (&[][..], uniform, Some(uniform)),
            (&["--spp", "16"], uniform, Some(uniform)),
            (&["--error", "1%"], adaptive, Some(uniform)),
            (&["--time", "1s", "--spp", "16"], adaptive, Some(uniform)),
            (
                &["--error", "1%", "--adaptive=false"],
                uniform,
                Some(uniform),
            ),
            (&["--adaptive=true"], adaptive, None),
            (&["--adaptive"], adaptive, None),
        ] {
            assert_eq!(sampling(args, None), Ok(possible), "{args:?}");
            for reason in [EvenOnly::LightPaths, EvenOnly::Gpu] {
                let answer = sampling(args, Some(reason));
                assert_eq!(answer.as_ref().ok(), impossible.as_ref(), "{answer:?}");
                if let Err(error) = answer {
                    assert!(error.contains("; render with "), "{error}");
                }
            }
        }
        assert!(sampling(&["--adaptive=often"], None).is_err());
    }
}
