//! The moment of an animation that is shown, and how long the shutter is open around it.

use std::str::FromStr;

use clap::Args;
use residual_frontend::options::RenderArgs;
use residual_render::shutter::Moments;

use crate::choices::ShutterPositionArg;
use crate::numbers::{finite, positive};

/// Which moment is shown.
#[derive(Args, Clone)]
pub(crate) struct TimeArgs {
    /// Show this moment of a glTF file's animations; without it, the pose in which the file stands
    #[arg(long, value_name = "SECONDS", group = "moment", allow_negative_numbers = true, value_parser = finite::<f64>)]
    pub(crate) time_code: Option<f64>,
    /// The same by the number of a frame, which --fps makes a time
    #[arg(long, value_name = "N", group = "moment", allow_negative_numbers = true, value_parser = finite::<f64>)]
    pub(crate) frame: Option<f64>,
    /// Frames a second, of which glTF files say nothing; Blender's default is 24
    #[arg(long, value_name = "X", default_value_t = 24.0, requires = "moment", value_parser = positive)]
    pub(crate) fps: f64,
    /// Show only this animation of a glTF file
    #[arg(long, value_name = "NAME|INDEX", requires = "moment")]
    pub(crate) animation: Option<String>,
    /// Motion blur: how long the shutter is open, in frames (0.5 is Blender's default), as an angle of a frame (180deg), or in
    /// seconds (1/48s, 20ms) [default: closed]
    #[arg(
        long,
        value_name = "FRAMES|DEGREESdeg|SECONDSs",
        requires = "moment",
        allow_negative_numbers = true
    )]
    pub(crate) shutter: Option<Shutter>,
    /// When the shutter is open
    #[arg(long, value_enum, default_value_t = ShutterPositionArg::Center, requires = "shutter")]
    pub(crate) shutter_position: ShutterPositionArg,
    /// Moments while the shutter is open over which samples are spread, a power of two; each has its geometry in memory
    /// [default: 16, or as many as samples]
    #[arg(long, value_name = "N", requires = "shutter", allow_negative_numbers = true, value_parser = moments)]
    pub(crate) shutter_moments: Option<u32>,
}

/// How long a shutter is open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Shutter {
    /// In terms of the time from frame to frame.
    Frames(f64),
    /// In seconds.
    Seconds(f64),
}

impl FromStr for Shutter {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let number = |text: &str| {
            let (number, divisor) = match text.split_once('/') {
                Some((number, divisor)) => (number, divisor.parse().ok()?),
                None => (text, 1.0),
            };
            let number = number.parse::<f64>().ok()? / divisor;
            (number >= 0.0 && number.is_finite()).then_some(number)
        };
        // The longest unit of those that end alike comes first.
        let shutter = if let Some(degrees) = text.strip_suffix("deg") {
            number(degrees).map(|degrees| Self::Frames(degrees / 360.0))
        } else if let Some(milliseconds) = text.strip_suffix("ms") {
            number(milliseconds).map(|milliseconds| Self::Seconds(milliseconds / 1000.0))
        } else if let Some(seconds) = text.strip_suffix('s') {
            number(seconds).map(Self::Seconds)
        } else {
            number(text).map(Self::Frames)
        };
        shutter.ok_or("expected frames, an angle of a frame or a time of at least 0, as in 0.5, 180deg or 1/48s")
    }
}

/// What of a render says when the moments are.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Exposure {
    /// Seed of the random numbers.
    pub(crate) seed: u32,
    /// Samples a pixel, where that is known.
    pub(crate) samples: Option<u32>,
}

impl Exposure {
    /// That of a render.
    pub(crate) fn of(args: &RenderArgs) -> Self {
        let is_endless = args.time.is_some() || args.error.is_some();
        Self {
            seed: args.seed,
            samples: args.spp.filter(|_| !is_endless),
        }
    }
}

/// As many moments where the user does not say: the steps that are left are a sixteenth of the way.
const DEFAULT_MOMENTS: u32 = 16;

impl TimeArgs {
    /// The moment that is shown, in seconds, if one is asked for.
    pub(crate) fn moment(&self) -> Option<f64> {
        self.time_code.or(self.frame.map(|frame| frame / self.fps))
    }

    /// Seconds for which the shutter is open.
    pub(crate) fn open_for(&self) -> f64 {
        match self.shutter {
            None => 0.0,
            Some(Shutter::Seconds(seconds)) => seconds,
            Some(Shutter::Frames(frames)) => frames / self.fps,
        }
    }

    /// The moments while the shutter is open, in seconds; none where it is closed.
    pub(crate) fn moments(&self, exposure: Exposure) -> Vec<f64> {
        let length = self.open_for();
        let Some(middle) = self.moment().filter(|_| length > 0.0) else {
            return Vec::new();
        };
        let opens = middle
            - length
                * match self.shutter_position {
                    ShutterPositionArg::Start => 0.0,
                    ShutterPositionArg::Center => 0.5,
                    ShutterPositionArg::End => 1.0,
                };
        // No more than there are samples.
        let most = exposure
            .samples
            .unwrap_or(DEFAULT_MOMENTS)
            .clamp(2, DEFAULT_MOMENTS);
        let count = self.shutter_moments.unwrap_or(most.next_power_of_two());
        let moments = Moments::new(count, exposure.seed);
        let times = moments.iter().flat_map(Moments::times);
        times.map(|time| opens + length * time).collect()
    }
}

/// A number of moments.
pub(crate) fn moments(text: &str) -> Result<u32, String> {
    let count = text.parse().ok();
    let count = count.filter(|&count| count >= 2 && Moments::new(count, 0).is_some());
    count.ok_or_else(|| format!("expected a power of two from 2 to {}", Moments::MOST))
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[derive(Parser)]
    struct Alone {
        #[command(flatten)]
        time: TimeArgs,
    }

    #[test]
    fn shutters_are_frames_angles_or_times() {
        for (text, shutter) in [
            ("0.5", Shutter::Frames(0.5)),
            ("1/2", Shutter::Frames(0.5)),
            ("180deg", Shutter::Frames(0.5)),
            ("1/48s", Shutter::Seconds(1.0 / 48.0)),
            ("20ms", Shutter::Seconds(0.02)),
            ("0", Shutter::Frames(0.0)),
        ] {
            assert_eq!(text.parse(), Ok(shutter), "{text}");
        }
        for wrong in [
            "-1", "nan", "inf", "1/0", "0/0s", "deg", "s", "half", "-1/50s", "",
        ] {
            assert!(wrong.parse::<Shutter>().is_err(), "{wrong}");
        }
    }

    fn time(arguments: &[&str]) -> TimeArgs {
        let all = ["alone"].iter().chain(arguments);
        Alone::try_parse_from(all).expect("arguments").time
    }

    #[test]
    fn the_shutter_is_open_around_the_frame() {
        let around = |position: &str, samples| {
            let arguments = [
                "--frame",
                "12",
                "--shutter",
                "0.5",
                "--shutter-position",
                position,
            ];
            time(&arguments).moments(Exposure { seed: 3, samples })
        };
        for (position, opens) in [
            ("start", 0.5),
            ("center", 0.5 - 0.25 / 24.0),
            ("end", 0.5 - 0.5 / 24.0),
        ] {
            let times = around(position, None);
            assert_eq!(times.len(), 16);
            for (k, time) in times.iter().enumerate() {
                let share = (time - opens) / (0.5 / 24.0) * 16.0;
                let k = k as f64;
                assert!(
                    k <= share + 1e-9 && share < k + 1.0 + 1e-9,
                    "{position}: {times:?}"
                );
            }
        }
        assert_eq!(around("center", Some(5)).len(), 8);
        assert_eq!(around("center", Some(1)).len(), 2);
        assert_eq!(around("center", Some(4096)).len(), 16);
    }

    #[test]
    fn closed_shutters_have_no_moments() {
        for arguments in [&["--frame", "1"][..], &["--frame", "1", "--shutter", "0"]] {
            assert!(time(arguments).moments(Exposure::default()).is_empty());
        }
    }
}
