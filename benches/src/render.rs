//! Whole renders: contenders in turn, round by round, and what the times say.

use std::ops::ControlFlow;

use residual_accuracy::Estimate;
use residual_device_cpu::{CpuDevice, SceneView, TileRenderer};
use residual_render::passes::{Counters, RenderOptions};
use serde_json::{Value, json};

/// One way to render a scene.
pub struct RenderContender<'a> {
    /// `interpreted` or `specialized`.
    pub tier: &'static str,
    /// Whose traversal: `residual`, `embree1` or `embree16`.
    pub traversal: &'static str,
    /// Paths shaded at once.
    pub lanes: u32,
    /// What renders tiles.
    pub renderer: &'a dyn TileRenderer,
    /// The scene, with that traversal.
    pub view: SceneView<'a>,
}

/// What one contender took.
#[derive(Clone, Debug)]
pub struct RenderRow {
    /// Name of the scene.
    pub scene: String,
    /// As in [`RenderContender`].
    pub tier: &'static str,
    /// As in [`RenderContender`].
    pub traversal: &'static str,
    /// As in [`RenderContender`].
    pub lanes: u32,
    /// Million samples (paths from the camera) a second on the clock.
    pub msamples_per_s: Estimate,
    /// Million samples a second of CPU time, of all threads.
    pub msamples_per_cpu_s: Estimate,
    /// Seconds on the clock to a relative mean squared error of [`TARGET_ERROR`], from that of the samples taken: it
    /// falls with their number.
    pub time_to_error_s: Option<f64>,
    /// CPU time of the first contender over this one's, round by round.
    pub speed: Estimate,
    /// Thread seconds of the stages, and rays, of all rounds.
    pub counters: Counters,
    /// Samples in all rounds.
    pub samples: f64,
}

/// The relative mean squared error that time is measured to.
pub const TARGET_ERROR: f64 = 0.01;

/// Renders `rounds` times with every contender in turn. A round before them, which warms caches, does not count.
///
/// # Panics
/// Without contenders or rounds.
pub fn renders(
    scene: &str,
    device: &CpuDevice,
    contenders: &[RenderContender<'_>],
    options: &RenderOptions,
    rounds: usize,
) -> Vec<RenderRow> {
    let count = contenders.len();
    let pixels = f64::from(options.size[0]) * f64::from(options.size[1]);
    let mut clock = vec![Vec::new(); count];
    let mut cpu = vec![Vec::new(); count];
    let mut counters = vec![Counters::default(); count];
    let mut errors = vec![None; count];
    let mut samples = 0.0;
    for round in 0..=rounds {
        for turn in 0..count {
            let index = (round + turn) % count;
            let contender = &contenders[index];
            let before = residual_frontend::process_time();
            let (film, report) = device.render(
                || contender.renderer,
                &contender.view,
                options,
                |_| ControlFlow::Continue(()),
            );
            let used = residual_frontend::process_time() - before;
            if round > 0 {
                clock[index].push(report.elapsed.as_secs_f64());
                cpu[index].push(used.as_secs_f64());
                counters[index] += report.counters;
                errors[index] = film.error().map(|error| error.relmse.value);
                samples = pixels * film.samples() as f64;
            }
        }
    }
    let speeds = |times: &[f64]| Estimate::of(times.iter().map(|t| samples / t / 1e6).collect());
    let row = |(index, contender): (usize, &RenderContender<'_>)| {
        let ratios = cpu[0]
            .iter()
            .zip(&cpu[index])
            .map(|(first, own)| first / own);
        RenderRow {
            scene: scene.to_owned(),
            tier: contender.tier,
            traversal: contender.traversal,
            lanes: contender.lanes,
            msamples_per_s: speeds(&clock[index]),
            msamples_per_cpu_s: speeds(&cpu[index]),
            time_to_error_s: errors[index]
                .map(|error| Estimate::of(clock[index].clone()).median * error / TARGET_ERROR),
            speed: Estimate::of(ratios.collect()),
            counters: counters[index],
            samples: samples * rounds as f64,
        }
    };
    contenders.iter().enumerate().map(row).collect()
}

impl RenderRow {
    /// Nanoseconds of thread time a sample in each stage.
    pub fn stages(&self) -> [(&'static str, f64); 7] {
        let stages = self.counters.stages();
        stages.map(|(name, seconds)| (name, seconds / self.samples * 1e9))
    }

    /// As one JSON object.
    pub fn to_json(&self) -> Value {
        let stages: serde_json::Map<_, _> = self
            .stages()
            .into_iter()
            .map(|(name, ns)| (name.to_owned(), json!(ns)))
            .collect();
        json!({
            "scene": self.scene,
            "device": "cpu",
            "tier": self.tier,
            "traversal": self.traversal,
            "lanes": self.lanes,
            "msamples_per_s": self.msamples_per_s.median,
            "msamples_per_cpu_s": self.msamples_per_cpu_s.median,
            "msamples_per_cpu_s_ci": self.msamples_per_cpu_s.interval,
            "time_to_error_s": self.time_to_error_s,
            "speed": self.speed.median,
            "speed_ci": self.speed.interval,
            "ns_per_sample": stages,
        })
    }
}

/// A table of a scene's rows, and one of their stages (thesis, Figure 3.3).
pub fn render_table(rows: &[RenderRow]) -> String {
    let mut text = format!(
        "{:<12} {:<9} {:>5}  {:>22}  {:>11}  {:>12}  {:>20}\n",
        "tier",
        "traversal",
        "lanes",
        "Msamples/CPU-s [95 %]",
        "Msamples/s",
        "s to 1 % MSE",
        "speed [95 %]"
    );
    for row in rows {
        let (cpu, speed) = (&row.msamples_per_cpu_s, &row.speed);
        text.push_str(&format!(
            "{:<12} {:<9} {:>5}  {:>6.3} [{:>5.3}, {:>5.3}]  {:>11.3}  {:>12}  {:>5.2} [{:>4.2}, {:>4.2}]\n",
            row.tier,
            row.traversal,
            row.lanes,
            cpu.median,
            cpu.interval[0],
            cpu.interval[1],
            row.msamples_per_s.median,
            row.time_to_error_s.map_or("-".to_owned(), |s| format!("{s:.1}")),
            speed.median,
            speed.interval[0],
            speed.interval[1],
        ));
    }
    text.push_str("\nns of thread time a sample\n");
    text.push_str(&format!("{:<12} {:<9} {:>5}", "tier", "traversal", "lanes"));
    for (name, _) in Counters::default().stages() {
        text.push_str(&format!(" {name:>12}"));
    }
    text.push('\n');
    for row in rows {
        text.push_str(&format!(
            "{:<12} {:<9} {:>5}",
            row.tier, row.traversal, row.lanes
        ));
        for (_, ns) in row.stages() {
            text.push_str(&format!(" {ns:>12.1}"));
        }
        text.push('\n');
    }
    text
}
