//! The workspace as cargo sees it.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use serde_json::Value;

/// Packages of a workspace.
#[derive(Clone, Debug)]
pub struct Workspace {
    /// Where it is.
    pub root: PathBuf,
    /// Its members, by name.
    pub packages: Vec<Package>,
}

/// A member of the workspace.
#[derive(Clone, Debug)]
pub struct Package {
    /// Its name.
    pub name: String,
    /// Where its manifest is.
    pub directory: PathBuf,
    /// What cargo compiles of it: each is a crate of its own.
    pub targets: Vec<Target>,
    /// Names of packages it depends on, of the workspace or not, for whatever purpose; sorted.
    pub dependencies: Vec<String>,
}

/// A crate of a package.
#[derive(Clone, Debug)]
pub struct Target {
    /// `lib`, `bin`, `test`, `custom-build` and so on.
    pub kind: String,
    /// Its first file.
    pub source: PathBuf,
    /// Whether cargo runs the tests in it.
    pub is_tested: bool,
}

impl Target {
    /// Whether it is a part of the product, and not of its tests, benchmarks or examples.
    pub fn is_production(&self) -> bool {
        !matches!(self.kind.as_str(), "test" | "bench" | "example")
    }
}

impl Workspace {
    /// The workspace that this program was built from.
    ///
    /// # Errors
    /// If cargo fails.
    pub fn own() -> Result<Self> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"))
            .parent()
            .context("the package lies in the workspace")?;
        let output = cargo(root)
            .args(["metadata", "--no-deps", "--format-version", "1"])
            .output()
            .context("starting cargo")?;
        let errors = String::from_utf8_lossy(&output.stderr);
        ensure!(output.status.success(), "cargo metadata: {errors}");
        Self::from_metadata(&output.stdout)
    }

    /// Reads what `cargo metadata --no-deps` prints.
    ///
    /// # Errors
    /// If it is not that.
    pub fn from_metadata(json: &[u8]) -> Result<Self> {
        let metadata: Value = serde_json::from_slice(json).context("reading cargo's metadata")?;
        let mut packages = array(&metadata, "packages")?
            .iter()
            .map(package)
            .collect::<Result<Vec<_>>>()?;
        packages.sort_by(|a, b| a.name.cmp(&b.name));
        Ok(Self {
            root: text(&metadata, "workspace_root")?.into(),
            packages,
        })
    }

    /// A path as it is shown: relative to the workspace, if it is in it.
    pub fn relative<'a>(&self, path: &'a Path) -> &'a Path {
        path.strip_prefix(&self.root).unwrap_or(path)
    }
}

/// Cargo, which is to run in this directory: the one that runs us, if one does.
pub(crate) fn cargo(directory: &Path) -> Command {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.current_dir(directory);
    command
}

fn package(value: &Value) -> Result<Package> {
    let manifest = PathBuf::from(text(value, "manifest_path")?);
    let mut dependencies = array(value, "dependencies")?
        .iter()
        .map(|dependency| Ok(text(dependency, "name")?.to_owned()))
        .collect::<Result<Vec<_>>>()?;
    dependencies.sort();
    // A package may be needed for code, tests and build script: three entries.
    dependencies.dedup();
    Ok(Package {
        name: text(value, "name")?.to_owned(),
        directory: manifest
            .parent()
            .context("a manifest lies in a directory")?
            .to_owned(),
        targets: array(value, "targets")?
            .iter()
            .map(target)
            .collect::<Result<_>>()?,
        dependencies,
    })
}

fn target(value: &Value) -> Result<Target> {
    let kind = array(value, "kind")?.first().and_then(Value::as_str);
    Ok(Target {
        kind: kind.context("a target has a kind")?.to_owned(),
        source: text(value, "src_path")?.into(),
        is_tested: value["test"]
            .as_bool()
            .context("a target is tested or not")?,
    })
}

fn text<'a>(value: &'a Value, key: &str) -> Result<&'a str> {
    value[key]
        .as_str()
        .with_context(|| format!("cargo's metadata have no text {key:?}"))
}

fn array<'a>(value: &'a Value, key: &str) -> Result<&'a Vec<Value>> {
    value[key]
        .as_array()
        .with_context(|| format!("cargo's metadata have no list {key:?}"))
}
