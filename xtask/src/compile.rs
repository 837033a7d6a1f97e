//! Compiling emitted code: cargo builds a member of the workspace around it; the result is cached and loaded.

use std::fs::{self, File, TryLockError};
use std::io::Read as _;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::Mutex;
use std::time::Duration;

use anyhow::{Context, Result, bail};
use residual_device_cpu::LaneCount;
use residual_device_cpu::plugin::LoadedRenderer;
use residual_frontend::output::write_atomically;
use residual_scenegen::emit::rust;
use residual_scenegen::plan::Plan;

use crate::cache::Cache;
use crate::workspace;

/// The name of the `LaneCount` variant.
pub fn lanes_name(lanes: LaneCount) -> String {
    format!("{lanes:?}")
}

/// Compiles and loads the renderer of a plan.
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
/// If there is no cargo, or it fails.
pub fn compile_with_line_tables(plan: &Plan, lanes: LaneCount, place: &Path) -> Result<()> {
    let (source, file) = (library_source(plan, lanes), library_name());
    let target = workspace::target_directory();
    let build = library(&source, &file, &target, &["-Cdebuginfo=line-tables-only"]);
    Compiler::default().build(&build, |library| {
        fs::copy(library, place).with_context(|| format!("writing {}", place.display()))?;
        Ok(())
    })
}

/// What the library of a plan is compiled from.
pub(crate) fn library_source(plan: &Plan, lanes: LaneCount) -> String {
    let module = rust::module(plan, &lanes_name(lanes));
    format!("{module}\nresidual_device_cpu::export_renderer!();\n")
}

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
pub(crate) enum Origin {
    /// It was compiled.
    Compiled,
    /// It had been compiled before.
    Cached,
}

/// One compilation, which can be given up from another thread.
#[derive(Debug)]
pub(crate) struct Compiler {
    cache: Cache,
    state: Mutex<State>,
}

impl Default for Compiler {
    fn default() -> Self {
        Self::new(Cache::open())
    }
}

#[derive(Debug, Default)]
struct State {
    cargo: Option<Child>,
    given_up: bool,
}

/// A member of the workspace that is built around emitted code.
pub(crate) struct Build<'a> {
    pub(crate) package: &'a str,
    /// The emitted code.
    pub(crate) source: &'a str,
    /// What cargo makes of it.
    pub(crate) file: &'a str,
    /// Compiler flags for the package itself.
    pub(crate) flags: &'a [&'a str],
    /// Compiler flags for all packages, instead of the workspace's.
    pub(crate) rustflags: Option<&'a str>,
    pub(crate) target_directory: &'a Path,
}

impl Compiler {
    /// What this one compiles is kept in `cache`.
    pub(crate) fn new(cache: Cache) -> Self {
        Self {
            cache,
            state: Mutex::default(),
        }
    }

    pub(crate) fn compile(
        &self,
        plan: &Plan,
        lanes: LaneCount,
    ) -> Result<(LoadedRenderer, Origin)> {
        self.compile_source(&library_source(plan, lanes), lanes)
            .with_context(|| format!("compiling the renderer of {:?}", plan.name))
    }

    /// Compiles what [`library_source`] gave for this lane count.
    pub(crate) fn compile_source(
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
        let library = self.build(&build, keep)?;
        Ok((load(&library, lanes)?, Origin::Compiled))
    }

    /// Builds all that compiled scenes depend on, and a library of nothing: cargo then has to compile the next scene,
    /// whichever came before.
    pub(crate) fn build_dependencies(&self) -> Result<()> {
        let (file, target) = (library_name(), workspace::target_directory());
        self.build(&library("", &file, &target, FLAGS), |_| Ok(()))
            .context("building what compiled scenes depend on")
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

    /// Has cargo build a package, and `take` take the result before anybody builds it anew.
    pub(crate) fn build<R>(
        &self,
        build: &Build<'_>,
        take: impl FnOnce(&Path) -> Result<R>,
    ) -> Result<R> {
        let _lock = self.lock()?;
        let source = workspace::own_directory().join(format!("{}.rs", build.package));
        // Cargo rebuilds what has a new time stamp; a file that stays the same keeps its own.
        if !fs::read_to_string(&source).is_ok_and(|old| old == build.source) {
            write_atomically(&source, build.source.as_bytes())?;
        }
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let mut command = Command::new(&cargo);
        if let Some(flags) = build.rustflags {
            command.env("RUSTFLAGS", flags);
        }
        command
            // The workspace's `.cargo/config.toml` says for which machine to build.
            .current_dir(workspace::root())
            .env("RESIDUAL_SCENE", source)
            .args(["rustc", "--release", "--offline", "--quiet", "--package"])
            .arg(build.package)
            .arg("--target-dir")
            .arg(build.target_directory)
            .arg("--")
            .args(build.flags);
        self.run(command)
            .with_context(|| format!("running {}", cargo.display()))?;
        take(&build.target_directory.join("release").join(build.file))
    }

    /// Only one process at a time builds. Waiting for the others can be given up, too.
    fn lock(&self) -> Result<File> {
        let directory = workspace::own_directory();
        let path = directory.join("lock");
        let open = || {
            fs::create_dir_all(&directory)?;
            File::create(&path)
        };
        let file = open().with_context(|| format!("creating {}", path.display()))?;
        loop {
            match file.try_lock() {
                Ok(()) => return Ok(file),
                Err(TryLockError::WouldBlock) if !self.was_given_up() => {
                    std::thread::sleep(Duration::from_millis(20));
                }
                Err(TryLockError::WouldBlock) => bail!("given up"),
                Err(TryLockError::Error(error)) => {
                    return Err(error).with_context(|| format!("locking {}", path.display()));
                }
            }
        }
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

fn load(library: &Path, lanes: LaneCount) -> Result<LoadedRenderer> {
    // SAFETY: the cache holds only libraries that cargo made from code that we emitted; the caller asks for the one that
    // was made with this lane count.
    Ok(unsafe { LoadedRenderer::load(library.as_os_str(), lanes) }?)
}
