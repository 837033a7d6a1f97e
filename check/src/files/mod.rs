//! Files of a crate do not depend on each other in a circle.
//!
//! A file depends on another where a path in it means an item of the other: in a `use`, a type, an expression, a bound, a
//! macro. Paths are followed through re-exports to the file that defines the item, so that a module that only declares its
//! children and re-exports what they have depends on none of them. One whose own code uses a child's item does; a child
//! that uses an item of that module makes it a circle.

mod circles;
mod modules;
mod names;
mod tokens;
mod uses;

use std::path::{Path, PathBuf};

use anyhow::Result;

use crate::problem::{Place, Problem};
use crate::workspace::Workspace;

pub(crate) use modules::{Crate, requires_test};

/// Files that depend on each other.
#[derive(Clone, Debug)]
pub struct Circle {
    /// One for each of its files and each other file of the circle that it uses: the first place.
    pub uses: Vec<Use>,
    /// How many files it has.
    pub files: usize,
}

/// A place where a file uses another.
#[derive(Clone, Debug)]
pub struct Use {
    /// The file that uses.
    pub from: PathBuf,
    /// Of that file, from 1.
    pub line: usize,
    /// The path that is written there.
    pub path: String,
    /// The file that is used.
    pub to: PathBuf,
}

/// Circles of all crates of the workspace.
///
/// # Errors
/// If a file cannot be read, or is not Rust.
pub fn problems(workspace: &Workspace) -> Result<Vec<Problem>> {
    let mut problems = Vec::new();
    for package in &workspace.packages {
        for target in &package.targets {
            for circle in circles(&target.source)? {
                problems.push(problem(workspace, &circle));
            }
        }
    }
    Ok(problems)
}

fn problem(workspace: &Workspace, circle: &Circle) -> Problem {
    let describe = |used: &Use| {
        let from = workspace.relative(&used.from).display();
        let to = workspace.relative(&used.to).display();
        format!("{from}:{} uses {to} ({})", used.line, used.path)
    };
    let first = &circle.uses[0];
    Problem {
        place: Some(Place::line(workspace.relative(&first.from), first.line)),
        what: format!("a circle of {} files", circle.files),
        details: circle.uses.iter().map(describe).collect(),
        remedy: "move what several of them need to a file of its own, which uses none of them"
            .to_owned(),
    }
}

/// Circles of the crate whose first file this is.
///
/// # Errors
/// If a file cannot be read, or is not Rust.
pub fn circles(root: &Path) -> Result<Vec<Circle>> {
    let read = Crate::read(root)?;
    let uses = uses::uses(&read);
    let mut graph = circles::Graph::new();
    for used in &uses {
        graph.entry(used.from).or_default().insert(used.to);
    }
    let describe = |files: Vec<usize>| {
        let first_use = |from: usize, to: usize| {
            let mut between = uses
                .iter()
                .filter(|used| (used.from, used.to) == (from, to));
            between.next().map(|used| Use {
                from: read.files[from].path.clone(),
                line: used.line,
                path: used.path.clone(),
                to: read.files[to].path.clone(),
            })
        };
        let pairs = files
            .iter()
            .flat_map(|&from| files.iter().map(move |&to| (from, to)));
        Circle {
            uses: pairs.filter_map(|(from, to)| first_use(from, to)).collect(),
            files: files.len(),
        }
    };
    Ok(circles::circles(&graph).into_iter().map(describe).collect())
}
