//! The modules of a crate, as its files declare them.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow};
use proc_macro2::{TokenStream, TokenTree};
use syn::{Attribute, Expr, ExprLit, Item, ItemMod, Lit, Meta};

/// A crate: its files, and the modules in them. The first module is its root.
pub(crate) struct Crate {
    pub(crate) files: Vec<SourceFile>,
    pub(crate) modules: Vec<Module>,
}

pub(crate) struct SourceFile {
    pub(crate) path: PathBuf,
    /// Whether it is compiled for tests only.
    pub(crate) is_test: bool,
}

/// A module: a file, or a part of one.
pub(crate) struct Module {
    /// Index of its file.
    pub(crate) file: usize,
    /// Index of the module that declares it; the root has none.
    pub(crate) parent: Option<usize>,
    /// Modules that it declares, by name. Conditions of compilation may choose among several of one name.
    pub(crate) children: BTreeMap<String, Vec<usize>>,
    /// Its items. Those of modules within it are with these.
    pub(crate) items: Vec<Item>,
}

impl Crate {
    /// Reads the crate whose first file this is.
    ///
    /// # Errors
    /// If a file cannot be read, or is not Rust.
    pub(crate) fn read(root: &Path) -> Result<Self> {
        let mut read = Self {
            files: Vec::new(),
            modules: Vec::new(),
        };
        let folder = folder_of(root);
        read.add_file(root, None, folder, Use::Product)?;
        Ok(read)
    }

    /// Whether `module` is `ancestor`, or somewhere within it.
    pub(crate) fn is_within(&self, module: usize, ancestor: usize) -> bool {
        let mut above = std::iter::successors(Some(module), |&module| self.modules[module].parent);
        above.any(|module| module == ancestor)
    }

    /// Adds a file as a module. Its children's files are in `folder`.
    fn add_file(
        &mut self,
        path: &Path,
        parent: Option<usize>,
        folder: PathBuf,
        use_: Use,
    ) -> Result<usize> {
        let text = fs::read_to_string(path).with_context(|| path.display().to_string())?;
        let syntax = syn::parse_file(&text).map_err(|error| {
            let line = error.span().start().line;
            anyhow!("{}:{line}: {error}", path.display())
        })?;
        let file = self.file(path, use_);
        self.add_module(syntax.items, file, parent, &folder, use_)
    }

    /// The index of a file, which may be a module more than once.
    fn file(&mut self, path: &Path, use_: Use) -> usize {
        let path = path.canonicalize().unwrap_or_else(|_| path.to_owned());
        let is_test = use_ == Use::Tests;
        if let Some(index) = self.files.iter().position(|file| file.path == path) {
            self.files[index].is_test &= is_test;
            return index;
        }
        self.files.push(SourceFile { path, is_test });
        self.files.len() - 1
    }

    fn add_module(
        &mut self,
        mut items: Vec<Item>,
        file: usize,
        parent: Option<usize>,
        folder: &Path,
        use_: Use,
    ) -> Result<usize> {
        let index = self.modules.len();
        self.modules.push(Module {
            file,
            parent,
            children: BTreeMap::new(),
            items: Vec::new(),
        });
        for item in &mut items {
            if let Item::Mod(declaration) = item
                && let Some(child) = self.add_child(declaration, index, folder, use_)?
            {
                let name = declaration.ident.to_string();
                let children = &mut self.modules[index].children;
                children.entry(name).or_default().push(child);
            }
        }
        self.modules[index].items = items;
        Ok(index)
    }

    /// Adds a declared module, whose items are taken out of its parent's. A file that does not exist is the compiler's to
    /// complain about: a condition may keep it from being looked for.
    fn add_child(
        &mut self,
        declaration: &mut ItemMod,
        parent: usize,
        folder: &Path,
        use_: Use,
    ) -> Result<Option<usize>> {
        let use_ = if is_for_tests(&declaration.attrs) {
            Use::Tests
        } else {
            use_
        };
        let name = declaration.ident.to_string();
        let name = name.trim_start_matches("r#");
        let path = path_attribute(&declaration.attrs);
        let file = self.modules[parent].file;
        if let Some((_, items)) = declaration.content.take() {
            let folder = folder.join(path.as_deref().unwrap_or(name));
            let child = self.add_module(items, file, Some(parent), &folder, use_)?;
            return Ok(Some(child));
        }
        let (path, folder) = match path {
            Some(path) => {
                let path = self.folder_of_paths(parent, folder).join(path);
                let folder = folder_of(&path);
                (path, folder)
            }
            None => {
                let flat = folder.join(format!("{name}.rs"));
                let nested = folder.join(name).join("mod.rs");
                let path = if flat.exists() { flat } else { nested };
                (path, folder.join(name))
            }
        };
        if !path.exists() {
            return Ok(None);
        }
        self.add_file(&path, Some(parent), folder, use_).map(Some)
    }

    /// What a `path` attribute in a module is relative to: the folder of its file, but within modules that are a part of a
    /// file, the folder that their children's files would be in.
    fn folder_of_paths(&self, module: usize, folder: &Path) -> PathBuf {
        let Module { file, parent, .. } = self.modules[module];
        let is_part = parent.is_some_and(|parent| self.modules[parent].file == file);
        if is_part {
            folder.to_owned()
        } else {
            folder_of(&self.files[file].path)
        }
    }
}

/// What code is compiled for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Use {
    Product,
    Tests,
}

fn folder_of(file: &Path) -> PathBuf {
    file.parent().unwrap_or(Path::new("")).to_owned()
}

/// Whether an item is compiled for tests only.
fn is_for_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| match &attribute.meta {
        Meta::List(list) => list.path.is_ident("cfg") && requires_test(list.tokens.clone()),
        _ => false,
    })
}

/// Whether a condition of compilation is `test`, or `all(…)` with that in it.
pub(crate) fn requires_test(condition: TokenStream) -> bool {
    let tokens: Vec<_> = condition.into_iter().collect();
    match &tokens[..] {
        [TokenTree::Ident(name)] => name == "test",
        [TokenTree::Ident(name), TokenTree::Group(list)] if name == "all" => list
            .stream()
            .into_iter()
            .any(|token| matches!(token, TokenTree::Ident(name) if name == "test")),
        _ => false,
    }
}

fn path_attribute(attributes: &[Attribute]) -> Option<String> {
    attributes.iter().find_map(|attribute| {
        let Meta::NameValue(pair) = &attribute.meta else {
            return None;
        };
        match &pair.value {
            Expr::Lit(ExprLit {
                lit: Lit::Str(text),
                ..
            }) if pair.path.is_ident("path") => Some(text.value()),
            _ => None,
        }
    })
}
