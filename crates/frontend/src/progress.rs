//! What a render shows while it runs: a bar in a terminal; a line now and then where standard error goes to a file or a pipe.

use std::io::{IsTerminal, stderr};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use residual_render::passes::{Progress, RenderOptions};

use crate::note;
use crate::precision;

/// Shows how far a render has come.
pub(crate) enum Reporter {
    /// A bar that moves.
    Bar(ProgressBar),
    /// Lines, the next when this much time has gone by.
    Lines(Duration),
    /// Nothing.
    Quiet,
}

/// The first line comes after this time.
const FIRST_LINE: Duration = Duration::from_secs(2);
/// Lines come after times that grow by this factor, …
const LINE_FACTOR: f64 = 1.5;
/// … but no farther apart than this, so that those who watch a log see that something moves.
const LONGEST_SILENCE: Duration = Duration::from_secs(60);

impl Reporter {
    /// What suits the place that standard error goes to.
    pub(crate) fn new(is_quiet: bool) -> Self {
        if is_quiet {
            Self::Quiet
        } else if stderr().is_terminal() {
            Self::Bar(bar_of(0))
        } else {
            Self::Lines(FIRST_LINE)
        }
    }

    /// Shows it.
    pub(crate) fn show(&mut self, options: &RenderOptions, progress: &Progress<'_>) {
        match self {
            Self::Bar(bar) => {
                let (position, length) = place(options, progress);
                bar.set_length(length.max(position));
                bar.set_position(position);
                bar.set_message(reached(progress));
            }
            Self::Lines(next) if progress.elapsed >= *next => {
                note!("{}", line(options, progress));
                *next = next_line(progress.elapsed);
            }
            Self::Lines(_) | Self::Quiet => {}
        }
    }

    /// Takes the bar away.
    pub(crate) fn finish(self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}

/// A progress bar as all commands show it.
pub fn bar_of(length: u64) -> ProgressBar {
    let style =
        ProgressStyle::with_template("{bar:40} {percent:>3} % {msg}, {elapsed} gone, {eta} left");
    ProgressBar::new(length).with_style(style.expect("the template is valid"))
}

/// Where a render is and where it ends: in samples where their number is known or, on the way to an error, forecast, else in
/// milliseconds of the time limit. The end is 0 as long as it is not known.
fn place(options: &RenderOptions, progress: &Progress<'_>) -> (u64, u64) {
    match (options.samples, options.time) {
        (Some(samples), _) => (u64::from(progress.samples), u64::from(samples)),
        (None, Some(time)) => (progress.elapsed.as_millis() as u64, time.as_millis() as u64),
        (None, None) => {
            let target = options.error.map(|error| error * error);
            let end = target.and_then(|target| progress.convergence.forecast(target));
            let end = end.map_or(0, |end| end.samples as u64);
            (u64::from(progress.samples), end)
        }
    }
}

/// Samples so far, and the error after some of them.
fn reached(progress: &Progress<'_>) -> String {
    let samples = progress.samples;
    match progress.convergence.last() {
        Some(last) => {
            let error = precision::percent(last.error.relmse.value);
            format!("{samples} spp, error {error}")
        }
        None => format!("{samples} spp"),
    }
}

fn line(options: &RenderOptions, progress: &Progress<'_>) -> String {
    let (position, length) = place(options, progress);
    let elapsed = progress.elapsed.as_secs_f64();
    let so_far = format!("{}, {elapsed:.0} s gone", reached(progress));
    if length == 0 {
        return so_far;
    }
    let part = (position as f64 / length as f64).min(1.0);
    let left = if part > 0.0 {
        elapsed / part - elapsed
    } else {
        0.0
    };
    format!("{:.0} %: {so_far}, {left:.0} s left", 100.0 * part)
}

fn next_line(elapsed: Duration) -> Duration {
    elapsed.mul_f64(LINE_FACTOR).min(elapsed + LONGEST_SILENCE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use residual_accuracy::Convergence;
    use residual_render::film::Film;
    use residual_render::layer::Layers;

    #[test]
    fn lines_say_how_far_a_render_is() {
        let film = Film::new(1, 1, 1, Layers::NONE);
        let convergence = Convergence::default();
        let progress = Progress {
            samples: 16,
            elapsed: Duration::from_secs(3),
            film: &film,
            convergence: &convergence,
        };
        let of = |samples, time, error| {
            let options = RenderOptions {
                samples,
                time,
                error,
                ..RenderOptions::default()
            };
            line(&options, &progress)
        };
        let time = Some(Duration::from_secs(12));
        assert_eq!(of(Some(64), None, None), "25 %: 16 spp, 3 s gone, 9 s left");
        assert_eq!(of(None, time, None), "25 %: 16 spp, 3 s gone, 9 s left");
        assert_eq!(of(None, None, Some(0.01)), "16 spp, 3 s gone");
    }

    #[test]
    fn lines_get_rarer_up_to_one_a_minute() {
        let (mut elapsed, mut lines) = (FIRST_LINE, 1);
        while elapsed < Duration::from_secs(3600) {
            let next = next_line(elapsed);
            assert!(next > elapsed && next - elapsed <= LONGEST_SILENCE);
            (elapsed, lines) = (next, lines + 1);
        }
        assert!((60..80).contains(&lines), "{lines}");
    }
}
