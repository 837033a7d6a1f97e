//! Names of modules, and what paths mean by them.
//!
//! What a path means is the module that defines the item, however many re-exports lead there. Types are not inferred: of
//! a method or a field, only the path of its type is known, where one is written.

use std::collections::{HashMap, HashSet};

use syn::{ForeignItem, Item, ItemUse, UseTree};

use super::modules::Crate;
use super::tokens;

/// A path as written, without arguments of types.
pub(crate) type Path = Vec<String>;

/// What a path means in its crate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Target {
    /// An item that this module defines, or something within it.
    Item(usize),
    /// This module.
    Module(usize),
}

/// Names that a module or a block gives.
#[derive(Default)]
pub(crate) struct Names {
    defined: HashMap<String, Vec<Definition>>,
    /// What `*` is imported from.
    globs: Vec<Path>,
    /// Names in calls of macros that may define items.
    in_macros: HashSet<String>,
}

enum Definition {
    Item,
    /// Of an item that another module defines.
    ItemOf(usize),
    Module(usize),
    Import(Path),
}

impl Names {
    /// Names that items give; those of modules are not among them.
    pub(crate) fn of<'a>(items: impl Iterator<Item = &'a Item>) -> Self {
        let mut names = Self::default();
        for item in items {
            names.add(item);
        }
        names
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.defined.is_empty() && self.globs.is_empty()
    }

    fn add(&mut self, item: &Item) {
        let ident = match item {
            Item::Const(item) => &item.ident,
            Item::Enum(item) => &item.ident,
            Item::Fn(item) => &item.sig.ident,
            Item::Static(item) => &item.ident,
            Item::Struct(item) => &item.ident,
            Item::Trait(item) => &item.ident,
            Item::TraitAlias(item) => &item.ident,
            Item::Type(item) => &item.ident,
            Item::Union(item) => &item.ident,
            Item::Macro(item) => match &item.ident {
                Some(ident) => ident,
                None => {
                    return self
                        .in_macros
                        .extend(tokens::names(item.mac.tokens.clone()));
                }
            },
            Item::ForeignMod(item) => {
                for item in &item.items {
                    match item {
                        ForeignItem::Fn(item) => self.define(&item.sig.ident, Definition::Item),
                        ForeignItem::Static(item) => self.define(&item.ident, Definition::Item),
                        ForeignItem::Type(item) => self.define(&item.ident, Definition::Item),
                        _ => (),
                    }
                }
                return;
            }
            Item::ExternCrate(item) if item.ident == "self" => {
                if let Some((_, name)) = &item.rename {
                    self.define(name, Definition::Import(vec!["crate".to_owned()]));
                }
                return;
            }
            Item::Use(item) => return self.import(item),
            _ => return,
        };
        self.define(ident, Definition::Item);
    }

    fn import(&mut self, item: &ItemUse) {
        for import in imports(item) {
            match import.name {
                ImportName::Glob => self.globs.push(import.path),
                ImportName::Name(name) => self.define(name, Definition::Import(import.path)),
            }
        }
    }

    fn define(&mut self, name: impl ToString, definition: Definition) {
        let definitions = self.defined.entry(name.to_string()).or_default();
        definitions.push(definition);
    }
}

/// One name of a `use`, or a glob.
pub(crate) struct Import {
    pub(crate) path: Path,
    pub(crate) name: ImportName,
    pub(crate) line: usize,
}

pub(crate) enum ImportName {
    Name(String),
    Glob,
}

/// What a `use` imports from this crate, or from what its names may mean.
pub(crate) fn imports(item: &ItemUse) -> Vec<Import> {
    let mut found = Vec::new();
    if item.leading_colon.is_none() {
        add_imports(&item.tree, &mut Vec::new(), &mut found);
    }
    found
}

fn add_imports(tree: &UseTree, before: &mut Path, found: &mut Vec<Import>) {
    let mut add = |last: &syn::Ident, name: &syn::Ident| {
        let mut path = before.clone();
        let line = last.span().start().line;
        if last != "self" || path.is_empty() {
            path.push(last.to_string());
        }
        let name = if name == "self" {
            path.last().cloned().unwrap_or_default()
        } else {
            name.to_string()
        };
        let name = ImportName::Name(name);
        found.push(Import { path, name, line });
    };
    match tree {
        UseTree::Name(leaf) => add(&leaf.ident, &leaf.ident),
        UseTree::Rename(leaf) => add(&leaf.ident, &leaf.rename),
        UseTree::Glob(glob) => found.push(Import {
            path: before.clone(),
            name: ImportName::Glob,
            line: glob.star_token.spans[0].start().line,
        }),
        UseTree::Path(path) => {
            before.push(path.ident.to_string());
            add_imports(&path.tree, before, found);
            before.pop();
        }
        UseTree::Group(group) => {
            for tree in &group.items {
                add_imports(tree, before, found);
            }
        }
    }
}

/// All names of a crate.
pub(crate) struct Resolver<'a> {
    read: &'a Crate,
    /// Of each module.
    names: Vec<Names>,
    /// Which modules define a macro of this name.
    macros: HashMap<String, Vec<usize>>,
}

/// Which names are being looked for, in which module: imports may refer to each other.
type Visited = HashSet<(usize, String)>;

impl<'a> Resolver<'a> {
    pub(crate) fn new(read: &'a Crate) -> Self {
        let mut resolver = Self {
            read,
            names: Vec::new(),
            macros: HashMap::new(),
        };
        let mut exported = Vec::new();
        for (index, module) in read.modules.iter().enumerate() {
            let mut names = Names::of(module.items.iter());
            for (name, children) in &module.children {
                for &child in children {
                    names.define(name, Definition::Module(child));
                }
            }
            resolver.names.push(names);
            for item in &module.items {
                if let Item::Macro(item) = item
                    && let Some(name) = &item.ident
                {
                    let defining = resolver.macros.entry(name.to_string()).or_default();
                    defining.push(index);
                    let is_exported = |a: &syn::Attribute| a.path().is_ident("macro_export");
                    if item.attrs.iter().any(is_exported) {
                        exported.push((name, index));
                    }
                }
            }
        }
        for (name, module) in exported {
            resolver.names[0].define(name, Definition::ItemOf(module));
        }
        resolver
    }

    /// What a path means in a module, within blocks that give names; of another crate's, nothing.
    pub(crate) fn resolve(&self, module: usize, blocks: &[Names], path: &[String]) -> Vec<Target> {
        let Some((first, rest)) = path.split_first() else {
            return Vec::new();
        };
        for block in blocks.iter().rev() {
            if let Some(definitions) = block.defined.get(first) {
                let follow = |definition: &Definition| match definition {
                    Definition::Import(import) => {
                        self.follow(module, &[import, rest].concat(), &mut Visited::new())
                    }
                    _ => vec![Target::Item(module)],
                };
                return definitions.iter().flat_map(follow).collect();
            }
            for glob in &block.globs {
                for target in self.follow(module, glob, &mut Visited::new()) {
                    if let Target::Module(from) = target
                        && !self.named(from, first, &mut Visited::new()).is_empty()
                    {
                        return self.follow(from, path, &mut Visited::new());
                    }
                }
            }
        }
        self.follow(module, path, &mut Visited::new())
    }

    /// Where the macro is defined that is called by a single name without an import: above the call, so the nearest
    /// module around it, or the only one that there is.
    pub(crate) fn macro_in_scope(&self, module: usize, name: &str) -> Option<usize> {
        let defining = self.macros.get(name)?;
        let around = |&&other: &&usize| self.read.is_within(module, other);
        let nearest = defining.iter().filter(around).max();
        match &defining[..] {
            [only] => Some(*only),
            _ => nearest.copied(),
        }
    }

    /// Whether a module gives a glob anything that it has not itself from elsewhere.
    pub(crate) fn defines_items(&self, module: usize) -> bool {
        let names = &self.names[module];
        let is_item = |definition: &Definition| matches!(definition, Definition::Item);
        !names.in_macros.is_empty() || names.defined.values().flatten().any(is_item)
    }

    fn follow(&self, module: usize, path: &[String], visited: &mut Visited) -> Vec<Target> {
        let Some((first, rest)) = path.split_first() else {
            return Vec::new();
        };
        let mut targets = match first.as_str() {
            "crate" | "$crate" => vec![Target::Module(0)],
            "self" => vec![Target::Module(module)],
            "super" => vec![Target::Module(self.parent(module))],
            name if rest.is_empty() => self.named(module, name, visited),
            name => self.holding(module, name, visited),
        };
        for (index, name) in rest.iter().enumerate() {
            let is_last = index + 1 == rest.len();
            targets = targets
                .into_iter()
                .flat_map(|target| match target {
                    Target::Item(_) => vec![target],
                    Target::Module(module) if name == "super" => {
                        vec![Target::Module(self.parent(module))]
                    }
                    Target::Module(module) => {
                        let found = if is_last {
                            self.named(module, name, visited)
                        } else {
                            self.holding(module, name, visited)
                        };
                        // Some macro defines it there, or it comes from a glob of another crate.
                        if found.is_empty() {
                            vec![Target::Item(module)]
                        } else {
                            found
                        }
                    }
                })
                .collect();
        }
        targets
    }

    fn parent(&self, module: usize) -> usize {
        self.read.modules[module].parent.unwrap_or(0)
    }

    /// What a name means before `::`: a module, if there is one, as functions and macros may have the same name.
    fn holding(&self, module: usize, name: &str, visited: &mut Visited) -> Vec<Target> {
        if let Some(children) = self.read.modules[module].children.get(name) {
            return children.iter().copied().map(Target::Module).collect();
        }
        let found = self.named(module, name, visited);
        let is_module = |target: &Target| matches!(target, Target::Module(_));
        if found.iter().any(is_module) {
            return found.into_iter().filter(is_module).collect();
        }
        found
    }

    /// What a name means in a module.
    fn named(&self, module: usize, name: &str, visited: &mut Visited) -> Vec<Target> {
        if !visited.insert((module, name.to_owned())) {
            return Vec::new();
        }
        let names = &self.names[module];
        if let Some(definitions) = names.defined.get(name) {
            let follow = |definition: &Definition| match definition {
                Definition::Item => vec![Target::Item(module)],
                Definition::ItemOf(other) => vec![Target::Item(*other)],
                Definition::Module(child) => vec![Target::Module(*child)],
                Definition::Import(path) => {
                    let found = self.follow(module, path, visited);
                    // Who takes another crate's item from here depends on this module.
                    if found.is_empty() {
                        vec![Target::Item(module)]
                    } else {
                        found
                    }
                }
            };
            return definitions.iter().flat_map(follow).collect();
        }
        if names.in_macros.contains(name) {
            return vec![Target::Item(module)];
        }
        for glob in &names.globs {
            for target in self.follow(module, glob, visited) {
                if let Target::Module(from) = target {
                    let found = self.named(from, name, visited);
                    if !found.is_empty() {
                        return found;
                    }
                }
            }
        }
        Vec::new()
    }
}
