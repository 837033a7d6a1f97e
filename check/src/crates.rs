//! Dependencies of crates run one way, and there are none but those in [`TABLE`].

use std::fs;
use std::path::PathBuf;

use crate::problem::{Place, Problem};
use crate::workspace::{Package, Workspace};

/// A package of the workspace, and the packages of the workspace that its manifest may name, for code, tests or build
/// script.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// The package.
    pub package: &'static str,
    /// What it may depend on.
    pub may_use: &'static [&'static str],
}

const fn row(package: &'static str, may_use: &'static [&'static str]) -> Row {
    Row { package, may_use }
}

/// Who may depend on whom. Each package stands below all that it may depend on, so that there can be no circle.
pub const TABLE: &[Row] = &[
    row("residual-check", &[]),
    row("residual-accuracy", &[]),
    row("residual-bvh", &[]),
    row("residual-render", &["residual-accuracy", "residual-bvh"]),
    row("residual-wgsl", &["residual-render"]),
    row("residual-scenegen", &["residual-render"]),
    row("residual-device-cpu", &["residual-bvh", "residual-render"]),
    row(
        "residual-variants",
        &["residual-bvh", "residual-device-cpu", "residual-render"],
    ),
    row(
        "residual-device-wgpu",
        &["residual-bvh", "residual-render", "residual-wgsl"],
    ),
    // Built around emitted code, which uses nothing but the device.
    row("residual-compiled-scene", &["residual-device-cpu"]),
    row(
        "residual-frontend",
        &["residual-accuracy", "residual-bvh", "residual-render"],
    ),
    row(
        "residual-standalone",
        &[
            "residual-device-cpu",
            "residual-frontend",
            "residual-render",
        ],
    ),
    row(
        "residual-driver",
        &[
            "residual-device-cpu",
            "residual-device-wgpu",
            "residual-frontend",
            "residual-accuracy",
            "residual-render",
            "residual-scenegen",
        ],
    ),
    row(
        "residual-benches",
        &[
            "residual-variants",
            "residual-bvh",
            "residual-device-cpu",
            "residual-driver",
            "residual-frontend",
            "residual-accuracy",
            "residual-render",
            "residual-scenegen",
            "residual-wgsl",
        ],
    ),
    row(
        "residual-study",
        &[
            "residual-variants",
            "residual-bvh",
            "residual-device-cpu",
            "residual-driver",
            "residual-frontend",
            "residual-accuracy",
            "residual-render",
            "residual-scenegen",
        ],
    ),
    // Not the benchmarks and the study: what only they need is not built for the command line.
    row(
        "xtask",
        &[
            "residual-accuracy",
            "residual-device-cpu",
            "residual-device-wgpu",
            "residual-driver",
            "residual-frontend",
            "residual-render",
            "residual-scenegen",
            "residual-wgsl",
        ],
    ),
    // With the feature that builds the GPU device.
    row("xtask-wgpu", &["xtask"]),
    row(
        "residual-tests",
        &[
            "residual-variants",
            "residual-bvh",
            "residual-device-cpu",
            "residual-device-wgpu",
            "residual-driver",
            "residual-render",
            "residual-scenegen",
            "residual-wgsl",
            "xtask",
        ],
    ),
    row(
        "residual-example-embed-wgpu",
        &[
            "residual-bvh",
            "residual-device-wgpu",
            "residual-render",
            "residual-scenegen",
            "residual-wgsl",
        ],
    ),
    row(
        "residual-example-embed",
        &[
            "residual-bvh",
            "residual-device-cpu",
            "residual-render",
            "residual-scenegen",
        ],
    ),
];

/// Where the table is, relative to the workspace.
const TABLE_FILE: &str = "check/src/crates.rs";

/// Dependencies that the table does not allow, and rows that allow what is not needed.
pub fn problems(workspace: &Workspace, table: &[Row]) -> Vec<Problem> {
    let mut problems = Vec::new();
    for (index, row) in table.iter().enumerate() {
        check_row(row, &table[..index], workspace, &mut problems);
    }
    for package in &workspace.packages {
        match table.iter().find(|row| row.package == package.name) {
            Some(row) => check_package(package, row, workspace, &mut problems),
            None => problems.push(Problem::new(
                Some(Place::file(manifest(workspace, package))),
                format!("the table of crates has no row for {}", package.name),
                format!("add one in {TABLE_FILE}"),
            )),
        }
    }
    problems
}

/// A row mentions packages of rows above it, all of which it needs.
fn check_row(row: &Row, above: &[Row], workspace: &Workspace, problems: &mut Vec<Problem>) {
    let mut add = |what: String, remedy: &str| {
        problems.push(Problem::new(Some(Place::file(TABLE_FILE)), what, remedy));
    };
    let package = workspace
        .packages
        .iter()
        .find(|package| package.name == row.package);
    let Some(package) = package else {
        let what = format!("the row {} is of no package", row.package);
        return add(what, "remove the row");
    };
    for used in row.may_use {
        if !above.iter().any(|row| row.package == *used) {
            add(
                format!(
                    "the row {} stands above {used}, which it may use",
                    row.package
                ),
                "dependencies run one way: remove it from the row, or order the rows",
            );
        } else if !package.dependencies.iter().any(|name| name == used) {
            add(
                format!("{} may use {used} and does not", row.package),
                "remove it from the row, so that it does not come back unseen",
            );
        }
    }
}

/// A package uses packages of its row.
fn check_package(package: &Package, row: &Row, workspace: &Workspace, problems: &mut Vec<Problem>) {
    for used in &package.dependencies {
        let is_member = workspace.packages.iter().any(|other| other.name == *used);
        if is_member && !row.may_use.contains(&used.as_str()) {
            let file = manifest(workspace, package);
            let text = fs::read_to_string(workspace.root.join(&file)).unwrap_or_default();
            let line = text
                .lines()
                .position(|line| line.starts_with(used.as_str()));
            problems.push(Problem::new(
                Some(Place {
                    file,
                    line: line.map(|index| index + 1),
                }),
                format!("{} may not depend on {used}", package.name),
                format!(
                    "do without; if it is meant, the table in {TABLE_FILE} and ARCHITECTURE.md say so"
                ),
            ));
        }
    }
}

fn manifest(workspace: &Workspace, package: &Package) -> PathBuf {
    workspace
        .relative(&package.directory.join("Cargo.toml"))
        .to_owned()
}
