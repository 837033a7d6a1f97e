//! What a render reports of itself.

use std::time::Duration;

use residual_device_cpu::RenderReport;
use residual_render::film::Film;
use residual_scenegen::effects::Effects;
use residual_scenegen::plan::Plan;
use serde_json::{Value, json};

/// Seconds of the stages before and after rendering.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Stages {
    pub(crate) load: Duration,
    pub(crate) bvh: Duration,
    pub(crate) compile: Duration,
    pub(crate) total: Duration,
}

/// Everything that is known at the end of a render.
pub(crate) struct Statistics<'a> {
    pub(crate) plan: &'a Plan,
    pub(crate) film: &'a Film,
    pub(crate) report: &'a RenderReport,
    pub(crate) stages: Stages,
    pub(crate) tier: &'static str,
    pub(crate) lanes: u32,
    pub(crate) compiled_from: Option<u32>,
    /// CPU seconds of the rendering alone, where the system tells.
    pub(crate) render_cpu: Option<f64>,
    /// Bytes of the hierarchy.
    pub(crate) bvh_bytes: usize,
}

/// The CPU seconds of this process so far, where the system tells.
pub(crate) fn cpu_seconds() -> Option<f64> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    // After the command's closing parenthesis: field 3 is the state; utime and stime are fields 14 and 15, in 1/100 s.
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let field = |number: usize| fields.get(number - 3)?.parse::<f64>().ok();
    Some((field(14)? + field(15)?) / 100.0)
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

fn mib(bytes: usize) -> f64 {
    bytes as f64 / f64::from(1 << 20)
}

impl Statistics<'_> {
    fn samples(&self) -> f64 {
        f64::from(self.film.width()) * f64::from(self.film.height()) * self.film.samples() as f64
    }

    /// As one JSON object.
    pub(crate) fn json(&self) -> Value {
        let c = &self.report.counters;
        let render = self.report.elapsed.as_secs_f64();
        let rays = c.camera_rays + c.bounce_rays + c.shadow_rays;
        let effects: Vec<String> = Effects::of(self.plan)
            .iter()
            .map(|e| e.to_string())
            .collect();
        let error = self.film.error();
        json!({
            "scene": self.plan.name,
            "device": "cpu",
            "tier": self.tier,
            "lanes": self.lanes,
            "threads": self.report.threads,
            "width": self.film.width(),
            "height": self.film.height(),
            "spp": self.film.samples(),
            "triangles": self.plan.data.triangle_count(),
            "seconds": {
                "load": self.stages.load.as_secs_f64(),
                "bvh": self.stages.bvh.as_secs_f64(),
                "compile": self.stages.compile.as_secs_f64(),
                "render": render,
                "total": self.stages.total.as_secs_f64(),
            },
            "thread_seconds": serde_json::Map::from_iter(
                c.stages().map(|(name, seconds)| (name.to_owned(), json!(seconds))),
            ),
            "compiled_from_spp": self.compiled_from,
            "msamples_per_s": self.samples() / render / 1e6,
            "msamples_per_cpu_s": self.render_cpu.map(|cpu| self.samples() / cpu / 1e6),
            "cpu_seconds": cpu_seconds(),
            "rays": { "camera": c.camera_rays, "bounce": c.bounce_rays, "shadow": c.shadow_rays },
            "mrays_per_s": rays as f64 / render / 1e6,
            "programs": self.plan.structure.programs.len(),
            "effects": effects,
            "mean": self.film.mean(),
            "error": error.map(|e| json!({ "relmse": e.relmse, "ci95": e.ci95 })),
            "invalid_samples": self.film.invalid_samples(),
            "memory_mib": {
                "scene": mib(self.plan.data.memory_bytes()),
                "hierarchy": mib(self.bvh_bytes),
            },
            "peak_rss_mib": peak_memory(),
        })
    }

    /// For people.
    pub(crate) fn text(&self) -> String {
        let c = &self.report.counters;
        let rays = (c.camera_rays + c.bounce_rays + c.shadow_rays) as f64;
        let render = self.report.elapsed.as_secs_f64();
        let stages = [
            ("camera rays", c.emit + c.trace_camera),
            ("bounce rays", c.trace_bounce),
            ("shadow rays", c.trace_shadow),
            ("sorting", c.sort),
            ("shading", c.shade),
            ("film", c.film),
        ];
        let busy: f64 = stages.iter().map(|(_, seconds)| seconds).sum();
        let [r, g, b] = self.film.mean();
        let mut text = format!(
            "load {:.2} s, hierarchy {:.2} s, compile {:.2} s, render {render:.2} s\n\
             {:.2} Msamples/s, {:.2} Mrays/s, {} threads, {} lanes, {}\n\
             scene {:.1} MiB, hierarchy {:.1} MiB, at most {:.1} MiB in all\n\
             mean {r:.5} {g:.5} {b:.5}\n",
            self.stages.load.as_secs_f64(),
            self.stages.bvh.as_secs_f64(),
            self.stages.compile.as_secs_f64(),
            self.samples() / render / 1e6,
            rays / render / 1e6,
            self.report.threads,
            self.lanes,
            self.tier,
            mib(self.plan.data.memory_bytes()),
            mib(self.bvh_bytes),
            peak_memory().unwrap_or(f64::NAN),
        );
        for (name, seconds) in stages {
            text.push_str(&format!(
                "{name:<12} {:5.1} %\n",
                100.0 * seconds / busy.max(1e-9)
            ));
        }
        text
    }
}
