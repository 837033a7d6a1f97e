//! How true the error is that renders state: many short renders of different seeds, each beside the mean of all others.

use std::sync::atomic::{AtomicU32, Ordering};

use anyhow::{Context, Result};
use residual_accuracy::{ErrorEstimate, Estimate, Interval, luminance, relative_mse};
use residual_device_cpu::{AnyBvh, CpuDevice, Interpreter, SceneView, Width};
use residual_frontend::hierarchy_quality;
use residual_render::film::{Film, Sampling, TILE_SIZE, TileRect};
use residual_render::passes::RenderOptions;
use residual_scenegen::plan::Plan;
use serde_json::{Value, json};

/// What one render said, and what it was, after so many samples.
struct Run {
    image: Vec<[f32; 3]>,
    stated: ErrorEstimate,
}

/// Of which numbers the error is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Red, green and blue.
    Color,
    /// Luminance.
    Luminance,
}

impl Quantity {
    fn name(self) -> &'static str {
        match self {
            Self::Color => "color",
            Self::Luminance => "luminance",
        }
    }

    fn stated(self, error: &ErrorEstimate) -> Interval {
        match self {
            Self::Color => error.relmse,
            Self::Luminance => error.luminance,
        }
    }

    fn truth(self, reference: &[[f32; 3]], image: &[[f32; 3]]) -> f64 {
        match self {
            Self::Color => relative_mse(reference, image),
            Self::Luminance => relative_mse(&grey(reference), &grey(image)),
        }
    }
}

fn grey(image: &[[f32; 3]]) -> Vec<[f32; 3]> {
    image
        .iter()
        .map(|&pixel| [luminance(pixel) as f32; 3])
        .collect()
}

/// How the statements compare with the truth, after so many samples.
#[derive(Clone, Debug)]
pub struct Row {
    /// Name of the scene.
    pub scene: String,
    /// Samples per pixel.
    pub samples: u32,
    /// Of what.
    pub quantity: Quantity,
    /// Width and height of the part of the image that was looked at.
    pub size: [u32; 2],
    /// Renders.
    pub runs: usize,
    /// Their relative mean squared errors.
    pub relmse: Estimate,
    /// The stated error ÷ the true one.
    pub stated_over_true: Estimate,
    /// Half of the stated interval, relative to its middle, on the median.
    pub half_width: f64,
    /// Part of the renders whose interval holds the truth.
    pub covered: f64,
    /// Part of the renders that call their interval untrustworthy.
    pub distrusted: f64,
    /// Part of the renders with a trusted interval that holds the truth; `None` if none is trusted.
    pub covered_of_trusted: Option<f64>,
    /// Part of those intervals that do not hold the truth which are called untrustworthy; `None` if all hold it.
    pub failures_distrusted: Option<f64>,
}

/// What is rendered, and which parts of the image are looked at.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'a> {
    /// The scene.
    pub plan: &'a Plan,
    /// Width and height of the image.
    pub size: [u32; 2],
    /// How samples are spread over it.
    pub sampling: Sampling,
    /// The parts, within the image.
    pub parts: &'a [TileRect],
}

/// A part of an image of `width` pixels a row.
fn part_of(image: &[[f32; 3]], width: u32, part: TileRect) -> Vec<[f32; 3]> {
    let rows = image.chunks_exact(width as usize);
    rows.skip(part.y as usize)
        .take(part.height as usize)
        .flat_map(|row| &row[part.x as usize..][..part.width as usize])
        .copied()
        .collect()
}

/// Renders `runs` times, and looks at the error after each of these numbers of samples, which are ascending.
///
/// # Errors
/// If the system gives no threads.
pub fn coverage(
    subject: &Subject<'_>,
    samples: &[u32],
    runs: u32,
    threads: usize,
    progress: impl Fn(u32) + Sync,
) -> Result<Vec<Row>> {
    let &Subject {
        plan,
        size,
        sampling,
        parts,
    } = subject;
    let quality = hierarchy_quality(plan.data.triangle_count());
    let bvh = AnyBvh::build(&plan.data, Width::Native, quality);
    let view = SceneView {
        buffers: plan.data.buffers(),
        traversal: &bvh,
    };
    let interpreter = Interpreter::new(plan.structure.clone());
    let render = |device: &CpuDevice, seed: u32| -> Vec<Vec<Run>> {
        let options = RenderOptions {
            size,
            seed,
            sampling,
            ..RenderOptions::default()
        };
        let film = Film::sampled_by(sampling, size, TILE_SIZE, plan.structure.layers);
        let mut film = film.with_second_set(seed);
        let look = |&until: &u32| {
            device.render_until(&interpreter, &view, &options, &mut film, until);
            let image = film.image();
            let run = |part: &TileRect| Run {
                image: part_of(&image, size[0], *part),
                stated: film.error_within(*part).expect("at least four samples"),
            };
            parts.iter().map(run).collect()
        };
        samples.iter().map(look).collect()
    };
    // Small images keep few threads busy: each render has one, and there are many renders.
    let threads = match threads {
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        some => some,
    };
    let (next, done) = (AtomicU32::new(0), AtomicU32::new(0));
    let some_renders = || -> Result<Vec<(u32, Vec<Vec<Run>>)>> {
        let device = CpuDevice::new(1).context("starting a thread")?;
        let mut renders = Vec::new();
        loop {
            let seed = next.fetch_add(1, Ordering::Relaxed);
            if seed >= runs {
                return Ok(renders);
            }
            renders.push((seed, render(&device, seed)));
            progress(done.fetch_add(1, Ordering::Relaxed) + 1);
        }
    };
    let renders = std::thread::scope(|scope| {
        let started: Vec<_> = (0..threads).map(|_| scope.spawn(some_renders)).collect();
        let renders = started.into_iter();
        let renders = renders.map(|thread| thread.join().expect("no render panicked"));
        renders.collect::<Result<Vec<_>>>()
    })?;
    let mut renders: Vec<_> = renders.into_iter().flatten().collect();
    renders.sort_by_key(|(seed, _)| *seed);
    let rows = parts
        .iter()
        .enumerate()
        .flat_map(|(part, TileRect { width, height, .. })| {
            let runs = |look: usize| -> Vec<&Run> {
                renders
                    .iter()
                    .map(|(_, looks)| &looks[look][part])
                    .collect()
            };
            let reference = Reference::of(&runs(samples.len() - 1));
            let row = |(look, &samples): (usize, &u32)| {
                let size = [*width, *height];
                let row = |of| row(&plan.name, samples, of, size, &runs(look), &reference);
                [Quantity::Color, Quantity::Luminance].map(row)
            };
            samples.iter().enumerate().flat_map(row).collect::<Vec<_>>()
        });
    Ok(rows.collect())
}

/// The sum of the longest renders, from which each is compared with the mean of the others.
struct Reference {
    images: Vec<Vec<[f32; 3]>>,
    sum: Vec<[f64; 3]>,
}

impl Reference {
    fn of(runs: &[&Run]) -> Self {
        let images: Vec<_> = runs.iter().map(|run| run.image.clone()).collect();
        let mut sum = vec![[0.0; 3]; images[0].len()];
        for image in &images {
            for (sum, pixel) in sum.iter_mut().zip(image) {
                *sum = std::array::from_fn(|k| sum[k] + f64::from(pixel[k]));
            }
        }
        Self { images, sum }
    }

    /// The mean of all but one.
    fn without(&self, left_out: usize) -> Vec<[f32; 3]> {
        let others = (self.images.len() - 1) as f64;
        let pixels = self.sum.iter().zip(&self.images[left_out]);
        pixels
            .map(|(sum, own)| {
                std::array::from_fn(|k| ((sum[k] - f64::from(own[k])) / others) as f32)
            })
            .collect()
    }

    /// What its own noise adds to the relative mean squared error of other images: `n` images whose mean differs from one more
    /// by v(1 + 1/n) have themselves v/n.
    fn own_error(&self, quantity: Quantity) -> f64 {
        let others = (self.images.len() - 1) as f64;
        let of = |index: usize| quantity.truth(&self.without(index), &self.images[index]);
        let mean = (0..self.images.len()).map(of).sum::<f64>() / self.images.len() as f64;
        mean / (others + 1.0)
    }
}

fn row(
    scene: &str,
    samples: u32,
    quantity: Quantity,
    size: [u32; 2],
    runs: &[&Run],
    reference: &Reference,
) -> Row {
    let own = reference.own_error(quantity);
    let truths: Vec<f64> = runs
        .iter()
        .enumerate()
        .map(|(index, run)| quantity.truth(&reference.without(index), &run.image) - own)
        .collect();
    let part = |of: &dyn Fn(&Run, f64) -> bool, among: &dyn Fn(&Run, f64) -> bool| {
        let pairs = || {
            runs.iter()
                .zip(&truths)
                .filter(|(run, truth)| among(run, **truth))
        };
        let all = pairs().count();
        let some = pairs().filter(|(run, truth)| of(run, **truth)).count();
        (all > 0).then(|| some as f64 / all as f64)
    };
    let covered = |run: &Run, truth: f64| {
        let interval = quantity.stated(&run.stated);
        interval.low <= truth && truth <= interval.high
    };
    let distrusted = |run: &Run, _: f64| run.stated.distrust.is_some();
    let all = |_: &Run, _: f64| true;
    let pairs = || runs.iter().zip(&truths);
    let ratios = pairs().map(|(run, truth)| quantity.stated(&run.stated).value / truth);
    let widths = runs
        .iter()
        .map(|run| quantity.stated(&run.stated))
        .map(|i| (i.high - i.low) / (2.0 * i.value));
    Row {
        scene: scene.to_owned(),
        samples,
        quantity,
        size,
        runs: runs.len(),
        relmse: Estimate::of(truths.clone()),
        stated_over_true: Estimate::of(ratios.collect()),
        half_width: Estimate::of(widths.collect()).median,
        covered: part(&covered, &all).unwrap_or(f64::NAN),
        distrusted: part(&distrusted, &all).unwrap_or(f64::NAN),
        covered_of_trusted: part(&covered, &|run, truth| !distrusted(run, truth)),
        failures_distrusted: part(&distrusted, &|run, truth| !covered(run, truth)),
    }
}

impl Row {
    /// As a JSON object.
    pub fn to_json(&self) -> Value {
        json!({
            "scene": self.scene,
            "spp": self.samples,
            "quantity": self.quantity.name(),
            "size": self.size,
            "runs": self.runs,
            "relmse": self.relmse.median,
            "stated_over_true": self.stated_over_true.median,
            "stated_over_true_ci95": self.stated_over_true.interval,
            "half_width": self.half_width,
            "covered": self.covered,
            "distrusted": self.distrusted,
            "covered_of_trusted": self.covered_of_trusted,
            "failures_distrusted": self.failures_distrusted,
        })
    }
}

/// Rows for people.
pub fn table(rows: &[Row]) -> String {
    let mut text = "  spp  pixels     of            relMSE  stated / true          half width  covered  distrusted  of trusted  failures distrusted\n".to_owned();
    for row in rows {
        let percent = |part: f64| format!("{:.1} %", 100.0 * part);
        let maybe = |part: Option<f64>| part.map_or("-".to_owned(), percent);
        let Estimate { median, interval } = row.stated_over_true;
        text.push_str(&format!(
            "{:>5}  {:<9}  {:<9}  {:>9.2e}  {median:.3} ({:.3}-{:.3})  {:>10}  {:>7}  {:>10}  {:>10}  {:>19}\n",
            row.samples,
            format!("{}x{}", row.size[0], row.size[1]),
            row.quantity.name(),
            row.relmse.median,
            interval[0],
            interval[1],
            percent(row.half_width),
            percent(row.covered),
            percent(row.distrusted),
            maybe(row.covered_of_trusted),
            maybe(row.failures_distrusted),
        ));
    }
    text
}
