//! What a render reports of itself.

use std::time::Duration;

use serde_json::{Value, json};

use crate::precision;
use crate::process_time;
use crate::rendered::Rendered;

/// What statistics say about the scene.
#[derive(Clone, Debug, Default)]
pub struct SceneSummary {
    /// Its name.
    pub name: String,
    /// How many triangles it has.
    pub triangles: usize,
    /// How many material programs.
    pub programs: usize,
    /// The effects that are in.
    pub effects: Vec<String>,
    /// Bytes of its buffers.
    pub bytes: usize,
    /// No sample can be brighter than white, whatever is in the scene.
    pub is_bounded: bool,
}

/// How long the stages before rendering took.
#[derive(Clone, Copy, Debug, Default)]
pub struct Preparation {
    /// Reading and planning the scene.
    pub load: Duration,
    /// Building the hierarchy.
    pub bvh: Duration,
    /// Compiling the renderer, beside the others.
    pub compile: Duration,
}

/// Which renderers were at work.
#[derive(Clone, Copy, Debug)]
pub struct TierReport {
    /// `specialized` if a compiled renderer was used at all, else `interpreted`.
    pub tier: &'static str,
    /// Samples a pixel after which the compiled renderer took over.
    pub compiled_from: Option<u32>,
    /// Samples a pixel after which compiling has paid for itself; only known where both were at work.
    pub break_even: Option<f64>,
}

/// What rendered.
#[derive(Clone, Debug)]
pub enum DeviceReport {
    /// The processor.
    Cpu,
    /// A GPU.
    Wgpu(WgpuReport),
}

/// What a GPU was, and how it did.
#[derive(Clone, Debug)]
pub struct WgpuReport {
    /// The adapter: name, kind, interface, driver.
    pub adapter: String,
    /// How its kernels compute.
    pub arithmetic: String,
    /// What its answers are, beside the processor's.
    pub answers: String,
    /// Samples have the processor's bits.
    pub is_exact: bool,
    /// How work is divided into kernels.
    pub mapping: String,
    /// How long its kernels took to compile, beside rendering.
    pub compile: Duration,
    /// Samples a pixel that the processor had rendered when it took over; `None` if it did not.
    pub from: Option<u32>,
    /// Of the first samples: how many pixels have the processor's bits, of how many.
    pub agreement: Option<(usize, usize)>,
    /// Bytes of the scene and of the paths under way on the device.
    pub bytes: u64,
}

impl DeviceReport {
    fn name(&self) -> &'static str {
        match self {
            Self::Cpu => "cpu",
            Self::Wgpu(_) => "wgpu",
        }
    }

    fn json(&self) -> Option<Value> {
        match self {
            Self::Cpu => None,
            Self::Wgpu(gpu) => Some(json!({
                "adapter": gpu.adapter,
                "arithmetic": gpu.arithmetic,
                "answers": gpu.answers,
                "exact": gpu.is_exact,
                "mapping": gpu.mapping,
                "compile_seconds": gpu.compile.as_secs_f64(),
                "from_samples": gpu.from,
                "pixels_equal": gpu.agreement.map(|(same, pixels)| json!([same, pixels])),
                "memory_mib": mib(gpu.bytes as usize),
            })),
        }
    }

    fn text(&self) -> String {
        match self {
            Self::Cpu => String::new(),
            Self::Wgpu(gpu) => {
                let from = match gpu.from {
                    Some(samples) => format!("from sample {samples} on"),
                    None => "not ready before the end".to_owned(),
                };
                let agreement = gpu.agreement.map_or(String::new(), |(same, pixels)| {
                    format!("; {same} of {pixels} first samples have the processor's bits")
                });
                format!(
                    "{} {from}, {}\n{}: {}{agreement}\nkernels compiled in {:.2} s, {:.1} MiB on the device\n",
                    gpu.adapter,
                    gpu.mapping,
                    gpu.arithmetic,
                    gpu.answers,
                    gpu.compile.as_secs_f64(),
                    mib(gpu.bytes as usize),
                )
            }
        }
    }
}

/// Everything that is known at the end of a render.
pub struct Statistics<'a> {
    /// The scene.
    pub scene: &'a SceneSummary,
    /// What was rendered.
    pub rendered: &'a Rendered,
    /// What went before.
    pub preparation: Preparation,
    /// Since the start of the program.
    pub total: Duration,
    /// Which renderers were at work.
    pub tiers: TierReport,
    /// What rendered.
    pub device: DeviceReport,
    /// Threads of the processor.
    pub threads: usize,
    /// Paths shaded at once.
    pub lanes: u32,
    /// Bytes of the hierarchy.
    pub bvh_bytes: usize,
}

/// The greatest resident memory of this process in MiB, where the system tells.
fn peak_memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(
        line.trim()
            .strip_suffix(" kB")?
            .trim()
            .parse::<f64>()
            .ok()?
            / 1024.0,
    )
}

/// Bytes in MiB.
pub fn mib(bytes: usize) -> f64 {
    bytes as f64 / f64::from(1 << 20)
}

impl Statistics<'_> {
    fn samples(&self) -> f64 {
        let film = &self.rendered.film;
        f64::from(film.width()) * f64::from(film.height()) * film.samples() as f64
    }

    /// A mean squared error that the image does not exceed, where samples are bounded.
    pub fn guaranteed_mse(&self) -> Option<f64> {
        let is_bounded = self.scene.is_bounded;
        is_bounded.then(|| self.rendered.film.guaranteed_mse())?
    }

    /// As one JSON object.
    pub fn json(&self) -> Value {
        let c = &self.rendered.report.counters;
        let render = self.rendered.report.elapsed.as_secs_f64();
        let rays = c.camera_rays + c.bounce_rays + c.shadow_rays;
        let film = &self.rendered.film;
        let preparation = &self.preparation;
        json!({
            "scene": self.scene.name,
            "device": self.device.name(),
            "gpu": self.device.json(),
            "tier": self.tiers.tier,
            "lanes": self.lanes,
            "threads": self.threads,
            "width": film.width(),
            "height": film.height(),
            "spp": film.samples(),
            "sampling": film.sampling().to_string(),
            "triangles": self.scene.triangles,
            "seconds": {
                "load": preparation.load.as_secs_f64(),
                "bvh": preparation.bvh.as_secs_f64(),
                "compile": preparation.compile.as_secs_f64(),
                "render": render,
                "first_image": self.rendered.first_image.as_secs_f64(),
                "total": self.total.as_secs_f64(),
            },
            "thread_seconds": serde_json::Map::from_iter(
                c.stages().map(|(name, seconds)| (name.to_owned(), json!(seconds))),
            ),
            "compiled_from_spp": self.tiers.compiled_from,
            "break_even_spp": self.tiers.break_even,
            "msamples_per_s": self.samples() / render / 1e6,
            "msamples_per_cpu_s": self.samples() / self.rendered.cpu.as_secs_f64() / 1e6,
            "cpu_seconds": process_time().as_secs_f64(),
            "rays": { "camera": c.camera_rays, "bounce": c.bounce_rays, "shadow": c.shadow_rays },
            "mrays_per_s": rays as f64 / render / 1e6,
            "programs": self.scene.programs,
            "effects": self.scene.effects,
            "mean": film.mean(),
            "error": precision::json(&self.rendered.report.convergence),
            "guaranteed_mse": self.guaranteed_mse(),
            "invalid_samples": film.invalid_samples(),
            "memory_mib": {
                "scene": mib(self.scene.bytes),
                "hierarchy": mib(self.bvh_bytes),
            },
            "peak_rss_mib": peak_memory(),
        })
    }

    /// For people.
    pub fn text(&self) -> String {
        let c = &self.rendered.report.counters;
        let rays = (c.camera_rays + c.bounce_rays + c.shadow_rays) as f64;
        let render = self.rendered.report.elapsed.as_secs_f64();
        let stages = [
            ("camera rays", c.emit + c.trace_camera),
            ("bounce rays", c.trace_bounce),
            ("shadow rays", c.trace_shadow),
            ("sorting", c.sort),
            ("shading", c.shade),
            ("film", c.film),
        ];
        let busy: f64 = stages.iter().map(|(_, seconds)| seconds).sum();
        let preparation = &self.preparation;
        let [r, g, b] = self.rendered.film.mean();
        let mut text = format!(
            "load {:.2} s, hierarchy {:.2} s, compile {:.2} s, render {render:.2} s\n\
             {:.2} Msamples/s, {:.2} Mrays/s, {} threads, {} lanes, {}\n\
             scene {:.1} MiB, hierarchy {:.1} MiB, at most {:.1} MiB in all\n\
             mean {r:.5} {g:.5} {b:.5}\n",
            preparation.load.as_secs_f64(),
            preparation.bvh.as_secs_f64(),
            preparation.compile.as_secs_f64(),
            self.samples() / render / 1e6,
            rays / render / 1e6,
            self.threads,
            self.lanes,
            self.tiers.tier,
            mib(self.scene.bytes),
            mib(self.bvh_bytes),
            peak_memory().unwrap_or(f64::NAN),
        );
        text.push_str(&self.device.text());
        for (name, seconds) in stages {
            text.push_str(&format!(
                "{name:<12} {:5.1} %\n",
                100.0 * seconds / busy.max(1e-9)
            ));
        }
        text
    }
}
