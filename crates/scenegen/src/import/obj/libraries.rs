//! The material libraries that a file names, and the materials in them by name.

use std::collections::{BTreeSet, HashMap, HashSet};
use std::path::{Path, PathBuf};

use super::find::Finder;
use super::geometry::{Geometry, NamedMaterial};
use super::lines::line_place;
use super::mtl::{self, MtlMaterial};
use super::names::{readings, relaxed};
use crate::import::files;
use crate::import::text::{self, other_decodings};
use crate::import::warnings::Warnings;

/// More `mtllib` statements than this are not read.
const MAX_LIBRARIES: usize = 256;

/// More words of one are not looked at.
const MAX_WORDS: usize = 64;

/// All materials of all libraries.
#[derive(Default)]
pub(super) struct Libraries {
    /// In order of the libraries.
    pub(super) materials: Vec<MtlMaterial>,
    /// By index in `materials`, the index of the `mtllib` that led to it.
    statements: Vec<usize>,
    /// Each reading of a name → indices of `materials`.
    exact: HashMap<String, Vec<usize>>,
    /// The same for names of which only case and spaces may differ.
    relaxed: HashMap<String, Vec<usize>>,
    /// The same for what names may be in other code pages.
    decoded: HashMap<String, Vec<usize>>,
}

/// A material that a name leads to.
pub(super) struct Found {
    /// Index of [`Libraries::materials`].
    pub(super) index: usize,
    /// Whether its name is another but for case, spaces and code page.
    pub(super) is_guess: bool,
}

impl Libraries {
    /// Reads all libraries that a file names; those that are missing are warned about.
    pub(super) fn load(geometry: &Geometry, file: &Path, warnings: &mut Warnings) -> Self {
        let folder = file.parent().unwrap_or(Path::new(""));
        let mut libraries = Self::default();
        let mut finder = Finder::new();
        let (mut seen_names, mut seen_paths) = (HashSet::new(), HashSet::new());
        for (statement, (line, names)) in geometry.libraries.iter().enumerate() {
            let place = line_place(*line);
            // Files repeat the statement for every object.
            if !seen_names.insert(names.as_str()) {
                continue;
            }
            if seen_names.len() > MAX_LIBRARIES {
                let message =
                    format!("more than {MAX_LIBRARIES} libraries are named; the rest is left out");
                warnings.push(place, message);
                break;
            }
            if names.is_empty() {
                warnings.push(&*place, "mtllib without a name is ignored");
            }
            for (name, path) in split_names(names, folder, &mut finder) {
                let path =
                    path.or_else(|| guess_library(&name, &place, file, &mut finder, warnings));
                let Some(path) = path else {
                    let message = format!("material library \"{name}\" is not there; left out");
                    warnings.push(&*place, message);
                    continue;
                };
                if seen_paths.insert(path.clone()) {
                    libraries.read(&path, statement, &place, warnings);
                }
            }
        }
        let sibling = file.with_extension("mtl");
        if geometry.libraries.is_empty() && !geometry.materials.is_empty() && sibling.is_file() {
            let place = line_place(geometry.materials[0].line);
            let message = format!(
                "no mtllib names a library; {} is used",
                quoted_name(&sibling)
            );
            warnings.push(&*place, message);
            libraries.read(&sibling, 0, &place, warnings);
        }
        libraries
    }

    fn read(&mut self, path: &Path, statement: usize, place: &str, warnings: &mut Warnings) {
        let library = path.file_name().unwrap_or_default().to_string_lossy();
        let bytes = match files::read(path) {
            Ok(bytes) => bytes,
            Err(problem) => {
                warnings.push(
                    place,
                    format!("material library \"{library}\" {problem}; left out"),
                );
                return;
            }
        };
        let folder = path.parent().unwrap_or(Path::new(""));
        for material in mtl::parse(&text::decode(bytes), &library, folder, warnings) {
            let index = self.materials.len();
            for name in readings(&material.name) {
                self.exact.entry(name.to_owned()).or_default().push(index);
                self.relaxed.entry(relaxed(name)).or_default().push(index);
                for name in other_decodings(name) {
                    let indices = self.decoded.entry(relaxed(&name)).or_default();
                    if indices.last() != Some(&index) {
                        indices.push(index);
                    }
                }
            }
            self.materials.push(material);
            self.statements.push(statement);
        }
    }

    /// The material of a `usemtl`: of several with the name the last one of the libraries named so far, or else the first
    /// one of those that are named later.
    pub(super) fn find(&self, named: &NamedMaterial) -> Option<Found> {
        let by = |map: &HashMap<String, Vec<usize>>, name: &str| -> Option<usize> {
            let indices = map.get(name)?;
            // The most literal reading of a name wins.
            let literal =
                |index: &&usize| readings(&self.materials[**index].name).next() == Some(name);
            let is_before = |index: &&usize| self.statements[**index] < named.libraries_before;
            let last =
                |filter: &dyn Fn(&&usize) -> bool| indices.iter().rev().find(filter).copied();
            last(&|index| literal(index) && is_before(index))
                .or_else(|| indices.iter().find(literal).copied())
                .or_else(|| last(&is_before))
                .or(indices.first().copied())
        };
        let exact = readings(&named.name).find_map(|name| by(&self.exact, name));
        let relaxed = || readings(&named.name).find_map(|name| by(&self.relaxed, &relaxed(name)));
        let found = |index, is_guess| Found { index, is_guess };
        let elsewhere = || {
            let name = readings(&named.name).find_map(|name| self.name_across_code_pages(name))?;
            by(&self.exact, readings(name).next()?)
        };
        exact
            .map(|index| found(index, false))
            .or_else(|| relaxed().or_else(elsewhere).map(|index| found(index, true)))
    }

    /// The name of a material that one of the two files has in another code page, if there is only one that it may be.
    fn name_across_code_pages(&self, name: &str) -> Option<&str> {
        let decoded = other_decodings(name);
        let here = decoded
            .iter()
            .filter_map(|name| self.relaxed.get(&relaxed(name)));
        let there = self.decoded.get(&relaxed(name));
        let indices = here.chain(there).flatten();
        let names: BTreeSet<&str> = indices.map(|&index| &*self.materials[index].name).collect();
        names.first().copied().filter(|_| names.len() == 1)
    }
}

/// The files that one `mtllib` names. Several are separated by spaces, while names have spaces, too: the longest runs
/// of words that name a file are what is meant.
fn split_names(text: &str, folder: &Path, finder: &mut Finder) -> Vec<(String, Option<PathBuf>)> {
    let folders = [folder];
    let whole = |path| vec![(text.to_owned(), path)];
    if let Some(path) = finder.find(text, &folders) {
        return whole(Some(path));
    }
    let quoted: Vec<&str> = text.split('"').skip(1).step_by(2).collect();
    if quoted.len() > 1 {
        return quoted
            .into_iter()
            .map(|name| (name.to_owned(), finder.find(name, &folders)))
            .collect();
    }
    let starts: Vec<usize> = (0..text.len())
        .filter(|&at| text.is_char_boundary(at))
        .filter(|&at| !text[at..].starts_with(char::is_whitespace))
        .filter(|&at| {
            text[..at]
                .chars()
                .next_back()
                .is_none_or(char::is_whitespace)
        })
        .take(MAX_WORDS)
        .collect();
    let mut names = Vec::new();
    let mut missing: Option<usize> = None;
    let mut first = 0;
    while first < starts.len() {
        let ends = (first + 1..=starts.len()).rev();
        let found = ends.into_iter().find_map(|end| {
            let name = text[starts[first]..starts.get(end).copied().unwrap_or(text.len())].trim();
            Some((end, name, finder.find(name, &folders)?))
        });
        match found {
            Some((end, name, path)) => {
                names.extend(
                    missing
                        .take()
                        .map(|start| (text[start..starts[first]].trim().to_owned(), None)),
                );
                names.push((name.to_owned(), Some(path)));
                first = end;
            }
            None => {
                missing.get_or_insert(starts[first]);
                first += 1;
            }
        }
    }
    match missing {
        Some(start) if names.is_empty() && start == starts[0] => whole(None),
        Some(start) => {
            names.push((text[start..].trim().to_owned(), None));
            names
        }
        None => names,
    }
}

/// Where a library that is not where it should be may be.
fn guess_library(
    name: &str,
    place: &str,
    file: &Path,
    finder: &mut Finder,
    warnings: &mut Warnings,
) -> Option<PathBuf> {
    let folder = file.parent().unwrap_or(Path::new(""));
    let sibling = file.with_extension("mtl");
    let path = finder
        .guess(name, &[folder])
        .or_else(|| sibling.is_file().then_some(sibling))?;
    let message = format!(
        "material library \"{name}\" is not there; {} is used",
        quoted_name(&path)
    );
    warnings.push(place, message);
    Some(path)
}

fn quoted_name(path: &Path) -> String {
    format!("\"{}\"", path.file_name().unwrap_or_default().display())
}
