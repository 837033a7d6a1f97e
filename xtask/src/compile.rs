//! Compiling emitted code: a crate of its own beside the workspace's build, made by cargo, loaded.

use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::Mutex;

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
    Compiler::default().compile(plan, lanes)
}

/// One compilation, which can be given up from another thread.
#[derive(Debug, Default)]
pub(crate) struct Compiler {
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    cargo: Option<Child>,
    given_up: bool,
}

impl Compiler {
    pub(crate) fn compile(&self, plan: &Plan, lanes: LaneCount) -> Result<LoadedRenderer> {
        let mut source = rust::module(plan, &lanes_name(lanes));
        source.push_str("\nresidual_device_cpu::export_renderer!();\n");
        let mut hasher = DefaultHasher::new();
        source.hash(&mut hasher);
        let name = format!("residual_scene_{:016x}", hasher.finish());
        let library = self
            .build(&name, &source)
            .with_context(|| format!("compiling the renderer of {:?}", plan.name))?;
        // SAFETY: cargo has just made this library from code that we emitted, for these sources and this lane count.
        Ok(unsafe { LoadedRenderer::load(library.as_os_str(), lanes) }?)
    }

    /// Ends the compilation if it still runs: nobody waits for it any more.
    pub(crate) fn give_up(&self) {
        let mut state = self.state.lock().expect("nothing panics while holding it");
        state.given_up = true;
        if let Some(cargo) = &mut state.cargo {
            // It may have ended by itself; either is fine.
            let _ = cargo.kill();
        }
    }

    /// Whether [`Compiler::give_up`] was called.
    pub(crate) fn was_given_up(&self) -> bool {
        self.state
            .lock()
            .expect("nothing panics while holding it")
            .given_up
    }

    /// Builds a crate of this name and source; returns the path of the library.
    fn build(&self, name: &str, source: &str) -> Result<PathBuf> {
        let workspace = workspace();
        let target = target_directory();
        let directory = target.join("residual").join(name);
        fs::create_dir_all(directory.join("src"))
            .with_context(|| format!("creating {}", directory.display()))?;
        write_if_changed(&directory.join("Cargo.toml"), &manifest(name, workspace))?;
        write_if_changed(&directory.join("src/lib.rs"), source)?;
        // The same versions of everything as the workspace's, so that its builds are used.
        let lock =
            fs::read_to_string(workspace.join("Cargo.lock")).context("reading Cargo.lock")?;
        if !directory.join("Cargo.lock").exists() {
            write_if_changed(&directory.join("Cargo.lock"), &lock)?;
        }
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let mut command = Command::new(&cargo);
        command
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
            .arg(&target);
        self.run(command)
            .with_context(|| format!("running {}", cargo.display()))?;
        let file = format!(
            "{}{name}{}",
            std::env::consts::DLL_PREFIX,
            std::env::consts::DLL_SUFFIX
        );
        Ok(target.join("release").join(file))
    }

    /// Runs cargo to its end. Its errors are read before it is waited for, so that it can be killed meanwhile.
    fn run(&self, mut command: Command) -> Result<()> {
        let mut child = command
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()?;
        let mut stderr = child.stderr.take().expect("it is piped");
        {
            let mut state = self.state.lock().expect("nothing panics while holding it");
            if state.given_up {
                child.kill()?;
            }
            state.cargo = Some(child);
        }
        let mut messages = Vec::new();
        stderr.read_to_end(&mut messages)?;
        let mut state = self.state.lock().expect("nothing panics while holding it");
        let status = state.cargo.as_mut().expect("put there above").wait()?;
        state.cargo = None;
        if !status.success() {
            bail!("cargo failed:\n{}", String::from_utf8_lossy(&messages));
        }
        Ok(())
    }
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
