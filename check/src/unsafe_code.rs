//! Unsafe code is in few places, each of which has a reason.

use std::path::Path;

use anyhow::{Result, anyhow};
use proc_macro2::{TokenStream, TokenTree};

use crate::problem::{Place, Problem};
use crate::sources;
use crate::workspace::Workspace;

/// Folders and files, relative to the workspace, in which unsafe code may be, and what for.
pub const ALLOWED: &[(&str, &str)] = &[
    ("crates/bvh", "kernels"),
    (
        "crates/device-cpu",
        "kernels, and the interface of compiled renderers",
    ),
    (
        "crates/device-wgpu/src/experimental.rs",
        "asks for kernels that wgpu does not translate",
    ),
    (
        "crates/device-wgpu/src/shader.rs",
        "loads kernels that are not checked again",
    ),
    ("crates/driver/src/compile.rs", "loads compiled renderers"),
    ("benches/src/embree", "calls Embree, which is loaded"),
];

/// Unsafe code elsewhere.
///
/// # Errors
/// If a file cannot be read, or is not Rust.
pub fn problems(workspace: &Workspace) -> Result<Vec<Problem>> {
    let mut problems = Vec::new();
    for package in &workspace.packages {
        for source in sources::of_package(&package.directory)? {
            let file = workspace.relative(&source.path);
            if !ALLOWED.iter().any(|(place, _)| file.starts_with(place)) {
                problems.extend(in_file(file, &source.text)?);
            }
        }
    }
    Ok(problems)
}

/// Unsafe code of a file, in which there may be none.
///
/// # Errors
/// If it is not Rust.
pub fn in_file(file: &Path, text: &str) -> Result<Vec<Problem>> {
    let tokens: TokenStream = text
        .parse()
        .map_err(|error| anyhow!("{}: {error}", file.display()))?;
    let mut lines = Vec::new();
    add_lines(tokens, &mut lines);
    let places: Vec<_> = ALLOWED.iter().map(|(place, _)| *place).collect();
    let remedy = format!(
        "write it safely; unsafe code may be in {}",
        places.join(", ")
    );
    let problem = |line| {
        Problem::new(
            Some(Place::line(file, line)),
            "unsafe code",
            remedy.as_str(),
        )
    };
    Ok(lines.into_iter().map(problem).collect())
}

/// Lines with the keyword, also within macros.
fn add_lines(tokens: TokenStream, lines: &mut Vec<usize>) {
    for token in tokens {
        match token {
            TokenTree::Ident(name) if name == "unsafe" => lines.push(name.span().start().line),
            TokenTree::Group(group) => add_lines(group.stream(), lines),
            _ => (),
        }
    }
}
