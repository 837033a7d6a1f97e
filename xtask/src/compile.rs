//! Compiling emitted code: a crate of its own beside the workspace's build, made by cargo, loaded.

use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail};
use residual_device_cpu::LaneCount;
use residual_device_cpu::plugin::LoadedRenderer;
use residual_scenegen::emit::rust;
use residual_scenegen::plan::Plan;

/// The workspace that this command line was built from.
fn workspace() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("xtask lies in the workspace")
}

/// Where the workspace's builds are; compiled renderers share their dependencies with them.
fn target_directory() -> PathBuf {
    let given = std::env::var_os("CARGO_TARGET_DIR").map(PathBuf::from);
    // Cargo is run from the workspace; a relative path is relative to here.
    given.map_or_else(
        || workspace().join("target"),
        |path| std::path::absolute(&path).unwrap_or(path),
    )
}

/// The name of the `LaneCount` variant.
pub fn lanes_name(lanes: LaneCount) -> String {
    format!("{lanes:?}")
}

/// Compiles and loads the renderer of a plan.
///
/// # Errors
/// If there is no cargo, or it fails.
pub fn compile(plan: &Plan, lanes: LaneCount) -> Result<LoadedRenderer> {
    let mut source = rust::module(plan, &lanes_name(lanes));
    source.push_str("\nresidual_device_cpu::export_renderer!();\n");
    let mut hasher = DefaultHasher::new();
    source.hash(&mut hasher);
    let name = format!("residual_scene_{:016x}", hasher.finish());
    let library = build(&name, &source)
        .with_context(|| format!("compiling the renderer of {:?}", plan.name))?;
    // SAFETY: cargo has just made this library from code that we emitted, for these sources and this lane count.
    Ok(unsafe { LoadedRenderer::load(library.as_os_str(), lanes) }?)
}

/// Builds a crate of this name and source; returns the path of the library.
fn build(name: &str, source: &str) -> Result<PathBuf> {
    let workspace = workspace();
    let target = target_directory();
    let directory = target.join("residual").join(name);
    fs::create_dir_all(directory.join("src"))
        .with_context(|| format!("creating {}", directory.display()))?;
    write_if_changed(&directory.join("Cargo.toml"), &manifest(name, workspace))?;
    write_if_changed(&directory.join("src/lib.rs"), source)?;
    // The same versions of everything as the workspace's, so that its builds are used.
    let lock = fs::read_to_string(workspace.join("Cargo.lock")).context("reading Cargo.lock")?;
    if !directory.join("Cargo.lock").exists() {
        write_if_changed(&directory.join("Cargo.lock"), &lock)?;
    }
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(&cargo)
        // The workspace's `.cargo/config.toml` says for which machine to build.
        .current_dir(workspace)
        .args([
            "build",
            "--release",
            "--offline",
            "--quiet",
            "--manifest-path",
        ])
        .arg(directory.join("Cargo.toml"))
        .arg("--target-dir")
        .arg(&target)
        .output()
        .with_context(|| format!("running {}", cargo.display()))?;
    if !output.status.success() {
        bail!("cargo failed:\n{}", String::from_utf8_lossy(&output.stderr));
    }
    let file = format!(
        "{}{name}{}",
        std::env::consts::DLL_PREFIX,
        std::env::consts::DLL_SUFFIX
    );
    Ok(target.join("release").join(file))
}

/// The crate's manifest. Its profile is the workspace's, so that dependencies are the same builds.
fn manifest(name: &str, workspace: &Path) -> String {
    let crates = workspace.join("crates");
    format!(
        "[package]\nname = {name:?}\nversion = \"0.0.0\"\nedition = \"2024\"\npublish = false\n\n\
         [lib]\ncrate-type = [\"cdylib\"]\n\n\
         [dependencies]\nresidual-device-cpu = {{ path = {:?} }}\n\n\
         [profile.release]\ndebug = \"line-tables-only\"\n\n\
         [profile.release.package.{name}]\ndebug = false\n\n\
         [workspace]\n",
        crates.join("device-cpu")
    )
}

/// Cargo rebuilds what has a new time stamp; a file that stays the same keeps its own.
fn write_if_changed(path: &Path, content: &str) -> Result<()> {
    if fs::read_to_string(path).is_ok_and(|old| old == content) {
        return Ok(());
    }
    fs::write(path, content).with_context(|| format!("writing {}", path.display()))
}
