//! Having cargo build members of the workspace around emitted code.

use std::ffi::OsString;
use std::fs::{self, File, TryLockError};
use std::io::Read as _;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::{Mutex, MutexGuard};
use std::time::Duration;

use anyhow::{Context, Result, bail};
use residual_frontend::output::write_atomically;

use crate::workspace;

/// Cargo in the workspace, whose `.cargo/config.toml` says for which machine to build: the one in `CARGO`, if that is set.
pub fn command() -> Command {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| OsString::from("cargo"));
    let mut command = Command::new(cargo);
    command.current_dir(workspace::root());
    command
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

/// Builds, one after the other, which can be given up from another thread.
#[derive(Debug, Default)]
pub(crate) struct Builder(Mutex<State>);

#[derive(Debug, Default)]
struct State {
    cargo: Option<Child>,
    given_up: bool,
}

impl Builder {
    fn state(&self) -> MutexGuard<'_, State> {
        self.0.lock().expect("nothing panics while holding it")
    }

    /// Ends the build if it still runs, and all later ones: nobody waits for them any more.
    pub(crate) fn give_up(&self) {
        let mut state = self.state();
        state.given_up = true;
        if let Some(cargo) = &mut state.cargo {
            // It may have ended by itself; either is fine.
            let _ = cargo.kill();
        }
    }

    /// Whether [`Builder::give_up`] was called.
    pub(crate) fn was_given_up(&self) -> bool {
        self.state().given_up
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
        let mut command = command();
        if let Some(flags) = build.rustflags {
            command.env("RUSTFLAGS", flags);
        }
        command
            .env("RESIDUAL_SCENE", source)
            .args(["rustc", "--release", "--offline", "--quiet", "--package"])
            .arg(build.package)
            .arg("--target-dir")
            .arg(build.target_directory)
            .arg("--")
            .args(build.flags);
        self.run(&mut command)
            .with_context(|| format!("running {}", command.get_program().display()))?;
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
    fn run(&self, command: &mut Command) -> Result<()> {
        let mut child = command
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()?;
        let mut stderr = child.stderr.take().expect("it is piped");
        {
            let mut state = self.state();
            if state.given_up {
                child.kill()?;
            }
            state.cargo = Some(child);
        }
        let mut messages = Vec::new();
        stderr.read_to_end(&mut messages)?;
        let mut state = self.state();
        let status = state.cargo.as_mut().expect("put there above").wait()?;
        state.cargo = None;
        if !status.success() {
            bail!("cargo failed:\n{}", String::from_utf8_lossy(&messages));
        }
        Ok(())
    }
}
