//! A render as people see it: progress, images on the way, Ctrl-C, the image at the end.

use std::ffi::OsStr;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use residual_accuracy::{Convergence, Measured};
use residual_render::film::{Film, Sampling, TILE_SIZE};
use residual_render::layer::Layers;
use residual_render::passes::{Counters, Pass, Progress, RenderOptions, render_passes};

use crate::cryptomatte::Manifest;
use crate::options::{RenderArgs, StatsFormat};
use crate::output::{self, Format, Metadata};
use crate::precision;
use crate::process_time;
use crate::progress::Reporter;
use crate::rendered::Rendered;
use crate::stats::Statistics;
use crate::{note, out};

/// Images on the way are written no more often than that so large a part of the time goes into them.
const PART_FOR_IMAGES: f64 = 0.02;

/// What is rendered.
#[derive(Clone, Copy)]
pub struct Subject<'a> {
    /// The scene's name.
    pub name: &'a str,
    /// What is kept beside radiance.
    pub layers: Layers,
    /// The names behind the ids of its Cryptomatte layers.
    pub manifests: &'a [Manifest],
}

/// What is set up before a scene is even loaded, so that mistakes show at once.
pub struct Session<'a> {
    args: &'a RenderArgs,
    outputs: Vec<PathBuf>,
    stop: Arc<AtomicBool>,
    /// When the session began.
    pub start: Instant,
}

impl<'a> Session<'a> {
    /// Checks the names of the images and listens for Ctrl-C. Without names, the image has the scene's.
    ///
    /// # Errors
    /// If an image could not be written, no file can hold the layers, or the system does not let us listen.
    pub fn new(args: &'a RenderArgs, scene: &OsStr, layers: Layers) -> Result<Self> {
        let outputs = if args.output.is_empty() {
            // Not `with_extension`: a name may have dots of its own.
            let mut name = scene.to_owned();
            name.push(".png");
            vec![PathBuf::from(name)]
        } else {
            args.output.clone()
        };
        outputs.iter().try_for_each(|path| output::check(path))?;
        output::check_layers(&outputs, layers)?;
        Ok(Self {
            args,
            outputs,
            stop: stop_on_interrupt()?,
            start: Instant::now(),
        })
    }

    /// Renders a film, showing progress, and writes the images: after the first pass, from time to
    /// time, and at the end. `pass` adds a pass of samples; `after_pass` is called after each.
    ///
    /// # Errors
    /// If a pass fails or an image cannot be written. When a pass fails, the images are what there was before.
    pub fn render<E: Into<anyhow::Error>>(
        &self,
        subject: Subject<'_>,
        options: &RenderOptions,
        pass: impl FnMut(&mut Film, Pass) -> Result<Counters, E>,
        mut after_pass: impl FnMut(&Progress<'_>),
    ) -> Result<Rendered> {
        let mut reporter = Reporter::new(self.args.quiet);
        let mut first_image = None;
        let mut next_image = Duration::ZERO;
        let mut failed = None;
        let show = |progress: Progress<'_>| {
            reporter.show(options, &progress);
            after_pass(&progress);
            let is_last = options.samples == Some(progress.samples);
            if !is_last && progress.elapsed >= next_image {
                let start = Instant::now();
                if let Err(error) = self.write(
                    subject,
                    progress.film,
                    progress.elapsed,
                    progress.convergence,
                ) {
                    failed = Some(error);
                    return ControlFlow::Break(());
                }
                next_image = progress.elapsed + start.elapsed().div_f64(PART_FOR_IMAGES);
                first_image.get_or_insert(self.start.elapsed());
            }
            if self.stop.load(Ordering::Relaxed) {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let before = process_time();
        let film = Film::sampled_by(options.sampling, options.size, TILE_SIZE, subject.layers);
        let mut film = film.with_second_set(options.seed);
        let (report, outcome) = render_passes(options, &mut film, pass, show);
        let cpu = process_time() - before;
        reporter.finish();
        if let Some(error) = failed {
            return Err(error);
        }
        if let Err(error) = outcome {
            let error = error.into();
            // What there is stays, whatever comes of the rest.
            return Err(match film.samples() {
                0 => error,
                samples => match self.write(subject, &film, report.elapsed, &report.convergence) {
                    Ok(()) => error.context(format!(
                        "rendering ended early; the image has {samples} samples per pixel"
                    )),
                    Err(unwritten) => error.context(format!("{unwritten:#}; before that")),
                },
            });
        }
        self.write(subject, &film, report.elapsed, &report.convergence)?;
        let first_image = first_image.unwrap_or_else(|| self.start.elapsed());
        Ok(Rendered {
            film,
            report,
            cpu,
            first_image,
        })
    }

    fn write(
        &self,
        subject: Subject<'_>,
        film: &Film,
        elapsed: Duration,
        convergence: &Convergence,
    ) -> Result<()> {
        let of_these = |last: &&Measured| last.samples == film.samples();
        let metadata = Metadata {
            scene: subject.name.to_owned(),
            samples: film.samples(),
            seconds: elapsed.as_secs_f64(),
            error: convergence.last().filter(of_these).map(|last| last.error),
            manifests: subject.manifests.to_vec(),
        };
        self.outputs
            .iter()
            .try_for_each(|path| output::write(path, film, self.args.display(), &metadata))
    }

    /// Says how it went; statistics where they were asked for.
    pub fn finish(&self, statistics: &Statistics<'_>) {
        let is_png = |path: &PathBuf| matches!(Format::of(path), Ok(Format::Png));
        if let Some(path) = self.outputs.iter().find(|path| is_png(path))
            && let Some(message) = self.args.display().note(&statistics.rendered.film.image())
        {
            note!("warning: {}: {message}", path.display());
        }
        if !self.args.quiet {
            self.summary(statistics);
        }
        match self.args.stats {
            Some(StatsFormat::Json) => out!("{}", statistics.json()),
            Some(StatsFormat::Text) => out!("{}", statistics.text().trim_end()),
            None => {}
        }
    }

    fn summary(&self, statistics: &Statistics<'_>) {
        let film = &statistics.rendered.film;
        let files: Vec<_> = self
            .outputs
            .iter()
            .map(|path| path.display().to_string())
            .collect();
        let seconds = statistics.rendered.report.elapsed.as_secs_f64();
        let spread = match film.sampling() {
            Sampling::Uniform => "",
            Sampling::Adaptive => " on average, more where it is noisy,",
        };
        note!(
            "{}: {} samples per pixel{spread} in {seconds:.2} s",
            files.join(", "),
            film.samples()
        );
        for line in precision::lines(&statistics.rendered.report.convergence) {
            note!("{line}");
        }
        if let Some(mse) = statistics.guaranteed_mse() {
            note!(
                "guaranteed with 95 % confidence, since no sample is brighter than white: \
                 an error of at most {} of white, the root of the mean squared error",
                precision::percent(mse)
            );
        }
        if film.invalid_samples() > 0 {
            note!(
                "warning: {} samples were not finite and counted as black; please report this",
                film.invalid_samples()
            );
        }
        if self.stop.load(Ordering::Relaxed) {
            note!("stopped; the image is what there was by then");
        }
    }
}

/// Set by Ctrl-C, after which the pass under way is finished and the image is written. A second Ctrl-C ends the program.
fn stop_on_interrupt() -> Result<Arc<AtomicBool>> {
    let stop = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&stop);
    ctrlc::set_handler(move || {
        if flag.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
        note!("\nstopping after this pass; Ctrl-C again to end at once");
    })
    .context("listening for Ctrl-C")?;
    Ok(stop)
}
