//! Compiling emitted code: cargo makes a library of it, which is kept in the cache and loaded.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use residual_device_cpu::LaneCount;
use residual_device_cpu::plugin::LoadedRenderer;
use residual_scenegen::emit::rust;
use residual_scenegen::plan::Plan;

use crate::cache::Cache;
use crate::cargo::{Build, Builder};
use crate::workspace;

/// Compiles and loads the renderer of a plan, or finds it in the workspace's cache.
///
/// # Errors
/// If there is no cargo, or it fails.
pub fn compile(plan: &Plan, lanes: LaneCount) -> Result<LoadedRenderer> {
    Ok(Compiler::default().compile(plan, lanes)?.0)
}

/// Compiles the renderer of a plan as [`compile`] does, but with line tables, into a file: for those who want to see
/// what is in it.
///
/// # Errors
/// If there is no cargo, or it fails, or the file cannot be written.
pub fn compile_with_line_tables(plan: &Plan, lanes: LaneCount, file: &Path) -> Result<()> {
    let (source, name) = (library_source(plan, lanes), library_name());
    let target = workspace::target_directory();
    let build = library(&source, &name, &target, LINE_TABLES);
    Builder::default().build(&build, |library| {
        fs::copy(library, file).with_context(|| format!("writing {}", file.display()))?;
        Ok(())
    })
}

/// What the library of a plan is compiled from.
pub fn library_source(plan: &Plan, lanes: LaneCount) -> String {
    let module = rust::module(plan, &lanes_name(lanes));
    format!("{module}\nresidual_device_cpu::export_renderer!();\n")
}

/// The name of the variant of [`LaneCount`], as emission wants it.
pub fn lanes_name(lanes: LaneCount) -> String {
    format!("{lanes:?}")
}

/// Line tables. Functions that are left out keep theirs, which begin at 0 unless a linker for ELF is told otherwise: long ones would
/// seem to be where others are.
const LINE_TABLES: &[&str] = if cfg!(target_os = "linux") {
    &[
        "-Cdebuginfo=line-tables-only",
        "-Clink-arg=-Wl,-z,dead-reloc-in-nonalloc=.debug_*=0x7000000000000000",
    ]
} else {
    &["-Cdebuginfo=line-tables-only"]
};

/// Line tables would be most of a library.
const FLAGS: &[&str] = &["-Cstrip=debuginfo"];

fn library_name() -> String {
    use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
    format!("{DLL_PREFIX}residual_compiled_scene{DLL_SUFFIX}")
}

fn library<'a>(
    source: &'a str,
    file: &'a str,
    target_directory: &'a Path,
    flags: &'a [&'a str],
) -> Build<'a> {
    Build {
        package: "residual-compiled-scene",
        source,
        file,
        flags,
        rustflags: None,
        target_directory,
    }
}

/// Where a compiled renderer came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// It was compiled.
    Compiled,
    /// It had been compiled before.
    Cached,
}

/// Compiles renderers, one after the other; another thread can have it give up.
#[derive(Debug)]
pub struct Compiler {
    cache: Cache,
    builder: Builder,
}

impl Default for Compiler {
    /// With the workspace's cache.
    fn default() -> Self {
        Self::new(Cache::open())
    }
}

impl Compiler {
    /// What this one compiles is kept in `cache`.
    pub fn new(cache: Cache) -> Self {
        Self {
            cache,
            builder: Builder::default(),
        }
    }

    /// Compiles and loads the renderer of a plan, or finds it in the cache.
    ///
    /// # Errors
    /// If there is no cargo, or it fails or is given up, or the cache cannot be written.
    pub fn compile(&self, plan: &Plan, lanes: LaneCount) -> Result<(LoadedRenderer, Origin)> {
        self.compile_source(&library_source(plan, lanes), lanes)
            .with_context(|| format!("compiling the renderer of {:?}", plan.name))
    }

    /// Compiles what [`library_source`] gave for this lane count.
    ///
    /// # Errors
    /// As [`Compiler::compile`].
    pub fn compile_source(
        &self,
        source: &str,
        lanes: LaneCount,
    ) -> Result<(LoadedRenderer, Origin)> {
        let (file, target) = (library_name(), workspace::target_directory());
        let key = Cache::key(source)?;
        if let Some(library) = self.cache.find(&key, source) {
            // One that does not load is compiled again.
            if let Ok(renderer) = load(&library, lanes) {
                return Ok((renderer, Origin::Cached));
            }
        }
        let build = library(source, &file, &target, FLAGS);
        let keep = |library: &Path| self.cache.keep(&key, source, library);
        let library = self.builder.build(&build, keep)?;
        Ok((load(&library, lanes)?, Origin::Compiled))
    }

    /// Builds all that compiled scenes depend on, and a library of nothing: cargo then has to compile the next scene,
    /// whichever came before.
    ///
    /// # Errors
    /// If there is no cargo, or it fails or is given up.
    pub fn build_dependencies(&self) -> Result<()> {
        let (file, target) = (library_name(), workspace::target_directory());
        self.builder
            .build(&library("", &file, &target, FLAGS), |_| Ok(()))
            .context("building what compiled scenes depend on")
    }

    /// Ends the compilation if it still runs: nobody waits for it any more.
    pub fn give_up(&self) {
        self.builder.give_up();
    }

    /// Whether [`Compiler::give_up`] was called.
    pub fn was_given_up(&self) -> bool {
        self.builder.was_given_up()
    }
}

fn load(library: &Path, lanes: LaneCount) -> Result<LoadedRenderer> {
    // SAFETY: the cache holds only libraries that cargo made from code that we emitted; the caller asks for the one that
    // was made with this lane count.
    Ok(unsafe { LoadedRenderer::load(library.as_os_str(), lanes) }?)
}
