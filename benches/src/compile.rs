//! How soon a scene's renderer is ready (thesis, Figure 3.6).

use std::fmt::Write;

use anyhow::{Result, anyhow};
use naga::front::wgsl;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use residual_accuracy::Estimate;
use serde_json::{Value, json};

use crate::report::interval;

/// What it takes to get one scene's renderer for one device. Times are seconds on the clock.
#[derive(Clone, Debug)]
pub struct CompileRow {
    /// Name of the scene.
    pub scene: String,
    /// `cpu`, or `wgpu`: a module of WGSL, as far as there is one.
    pub device: &'static str,
    /// What the compiler knows of materials: `structure`, or all their `constants`.
    pub binding: &'static str,
    /// Shading programs.
    pub programs: usize,
    /// Lines of emitted code, without blank ones and comments.
    pub lines: usize,
    /// Reading the file, and planning.
    pub plan: Estimate,
    /// From the plan to text.
    pub emit: Estimate,
    /// From text to a loaded renderer that was not compiled before; for `wgpu`, to a module that naga has validated.
    pub compile: Estimate,
    /// Of the CPU device only.
    pub library: Option<LibraryRow>,
}

/// What there is to say about a scene's library.
#[derive(Clone, Debug)]
pub struct LibraryRow {
    /// CPU time of compiling, of cargo and all that it starts, where the system tells.
    pub compile_cpu: Option<Estimate>,
    /// From text to a loaded renderer that was compiled before.
    pub cached: Estimate,
    /// Its size.
    pub bytes: u64,
}

/// Has naga parse and validate a module.
///
/// # Errors
/// If it is not WGSL.
pub fn validate_wgsl(text: &str) -> Result<()> {
    let module = wgsl::parse_str(text).map_err(|error| anyhow!(error.emit_to_string(text)))?;
    Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .map_err(|error| anyhow!(error.emit_to_string(text)))?;
    Ok(())
}

impl CompileRow {
    /// Seconds from the file to a renderer that was not compiled before.
    pub fn ready(&self) -> f64 {
        [&self.plan, &self.emit, &self.compile]
            .map(|stage| stage.median)
            .iter()
            .sum()
    }

    /// As one JSON object.
    pub fn to_json(&self) -> Value {
        let library = self.library.as_ref();
        json!({
            "scene": self.scene,
            "device": self.device,
            "binding": self.binding,
            "programs": self.programs,
            "lines": self.lines,
            "seconds": {
                "plan": self.plan.median,
                "emit": self.emit.median,
                "compile": self.compile.median,
                "compile_ci": self.compile.interval,
                "compile_cpu": library.and_then(|library| Some(library.compile_cpu?.median)),
                "cached": library.map(|library| library.cached.median),
            },
            "library_kib": library.map(|library| library.kib()),
        })
    }

    /// As a line below [`compile_heading`].
    pub fn to_line(&self) -> String {
        let mut line = format!(
            "{:<24} {:<6} {:<9}  {:>8}  {:>5}  {:>6.2}  {:>7.1}  {:>20}",
            self.scene,
            self.device,
            self.binding,
            self.programs,
            self.lines,
            self.plan.median,
            self.emit.median * 1e3,
            interval(&self.compile, 3),
        );
        if let Some(library) = &self.library {
            let cpu = library.compile_cpu;
            let cpu = cpu.map_or("-".to_owned(), |cpu| format!("{:.2}", cpu.median));
            let (cached_ms, kib) = (library.cached.median * 1e3, library.kib());
            let _ = write!(line, "  {cpu:>5}  {cached_ms:>9.1}  {kib:>5.0}");
        }
        line
    }
}

impl LibraryRow {
    fn kib(&self) -> f64 {
        self.bytes as f64 / 1024.0
    }
}

/// What [`CompileRow::to_line`] prints.
pub fn compile_heading() -> String {
    format!(
        "{:<24} {:<6} {:<9}  {:>8}  {:>5}  {:>6}  {:>7}  {:>20}  {:>5}  {:>9}  {:>5}",
        "scene",
        "device",
        "binding",
        "programs",
        "lines",
        "plan s",
        "emit ms",
        "compile s [95 %]",
        "CPU s",
        "cached ms",
        "KiB",
    )
}

/// How soon half of the scenes are ready, for each device and binding.
pub fn compile_summary(rows: &[CompileRow]) -> String {
    let kind = |row: &CompileRow| (row.device, row.binding);
    let mut kinds: Vec<_> = rows.iter().map(kind).collect();
    kinds.sort_unstable();
    kinds.dedup();
    let mut text = String::new();
    for (device, binding) in kinds {
        let ready = rows.iter().filter(|row| kind(row) == (device, binding));
        let ready = Estimate::of(ready.map(CompileRow::ready).collect());
        let _ = writeln!(
            text,
            "median of the scenes: {device}, {binding}: ready in {:.3} s",
            ready.median
        );
    }
    text
}
