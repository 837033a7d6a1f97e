//! Which file uses which: every path of a crate, and what it means.

use std::collections::HashSet;

use proc_macro2::{Span, TokenStream};
use syn::parse::Parser as _;
use syn::punctuated::Punctuated;
use syn::visit::{self, Visit};
use syn::{
    Attribute, Block, Expr, ExprCall, ExprPath, ItemMacro, ItemUse, Macro, PatIdent, Path, Stmt,
    Token, VisRestricted, Visibility,
};

use super::modules::Crate;
use super::names::{ImportName, Names, Resolver, Target, imports};
use super::tokens;

/// A place where a file uses an item of another.
#[derive(Clone, Debug)]
pub(crate) struct FileUse {
    /// Index of the file that uses.
    pub(crate) from: usize,
    /// Index of the file that is used.
    pub(crate) to: usize,
    /// Of the file that uses, from 1.
    pub(crate) line: usize,
    /// The path, as written.
    pub(crate) path: String,
}

/// All uses of a crate.
pub(crate) fn uses(read: &Crate) -> Vec<FileUse> {
    let resolver = Resolver::new(read);
    let mut found = Vec::new();
    for (index, module) in read.modules.iter().enumerate() {
        let mut variables = Variables::default();
        let mut finder = Finder {
            read,
            resolver: &resolver,
            module: index,
            variables: HashSet::new(),
            blocks: Vec::new(),
            found: &mut found,
        };
        for item in &module.items {
            variables.visit_item(item);
        }
        finder.variables = variables.0;
        for item in &module.items {
            finder.visit_item(item);
        }
    }
    found
}

/// Names that patterns give to values.
#[derive(Default)]
struct Variables(HashSet<String>);

impl<'ast> Visit<'ast> for Variables {
    fn visit_pat_ident(&mut self, pattern: &'ast PatIdent) {
        self.0.insert(pattern.ident.to_string());
        visit::visit_pat_ident(self, pattern);
    }
}

struct Finder<'a> {
    read: &'a Crate,
    resolver: &'a Resolver<'a>,
    module: usize,
    /// Of the module: a single name among them, unless it is called, is taken for the variable.
    variables: HashSet<String>,
    /// Names of the blocks around, the innermost last.
    blocks: Vec<Names>,
    found: &'a mut Vec<FileUse>,
}

impl Finder<'_> {
    fn add_path(&mut self, path: &[String], span: Span) {
        for target in self.resolver.resolve(self.module, &self.blocks, path) {
            // A path that ends with a module is in a `use`, and what is used of the module comes with it elsewhere.
            if let Target::Item(module) = target {
                self.add(module, span.start().line, &path.join("::"));
            }
        }
    }

    fn add(&mut self, module: usize, line: usize, path: &str) {
        let from = self.read.modules[self.module].file;
        let to = self.read.modules[module].file;
        if from != to {
            let path = path.to_owned();
            self.found.push(FileUse {
                from,
                to,
                line,
                path,
            });
        }
    }

    /// What a macro is called with: syntax if it is that of an expression or of statements, else tokens.
    fn visit_arguments(&mut self, tokens: &TokenStream) {
        let expressions = Punctuated::<Expr, Token![,]>::parse_terminated;
        if let Ok(expressions) = expressions.parse2(tokens.clone()) {
            for expression in &expressions {
                self.visit_expr(expression);
            }
        } else if let Ok(statements) = Block::parse_within.parse2(tokens.clone()) {
            self.visit_statements(&statements);
        } else {
            for path in tokens::paths(tokens.clone()) {
                self.add_path(&path.segments, path.span);
            }
        }
    }

    /// Statements of a block, in which its items and imports have their names.
    fn visit_statements(&mut self, statements: &[Stmt]) {
        let items = statements.iter().filter_map(|statement| match statement {
            Stmt::Item(item) => Some(item),
            _ => None,
        });
        let names = Names::of(items);
        let has_names = !names.is_empty();
        if has_names {
            self.blocks.push(names);
        }
        for statement in statements {
            self.visit_stmt(statement);
        }
        if has_names {
            self.blocks.pop();
        }
    }
}

impl<'ast> Visit<'ast> for Finder<'_> {
    fn visit_item_use(&mut self, item: &'ast ItemUse) {
        let is_reexport = !matches!(item.vis, Visibility::Inherited);
        for import in imports(item) {
            let is_glob = matches!(import.name, ImportName::Glob);
            let targets = self
                .resolver
                .resolve(self.module, &self.blocks, &import.path);
            for target in targets {
                let module = match target {
                    Target::Item(module) => module,
                    Target::Module(module) if is_glob && self.resolver.defines_items(module) => {
                        module
                    }
                    Target::Module(_) => continue,
                };
                // A module that re-exports what its children have does not use it.
                if !(is_reexport && self.read.is_within(module, self.module)) {
                    self.add(module, import.line, &import.path.join("::"));
                }
            }
        }
    }

    fn visit_path(&mut self, path: &'ast Path) {
        if path.leading_colon.is_none() {
            let segments = path.segments.iter();
            let names: Vec<_> = segments.map(|segment| segment.ident.to_string()).collect();
            self.add_path(&names, path.segments[0].ident.span());
        }
        visit::visit_path(self, path);
    }

    fn visit_expr_path(&mut self, expression: &'ast ExprPath) {
        let name = expression.path.get_ident();
        let is_variable = name.is_some_and(|name| self.variables.contains(&name.to_string()));
        if !is_variable {
            visit::visit_expr_path(self, expression);
        }
    }

    fn visit_expr_call(&mut self, call: &'ast ExprCall) {
        match &*call.func {
            Expr::Path(function) => visit::visit_expr_path(self, function),
            function => self.visit_expr(function),
        }
        for argument in &call.args {
            self.visit_expr(argument);
        }
    }

    fn visit_block(&mut self, block: &'ast Block) {
        self.visit_statements(&block.stmts);
    }

    fn visit_macro(&mut self, call: &'ast Macro) {
        let before = self.found.len();
        self.visit_path(&call.path);
        if before == self.found.len()
            && let Some(name) = call.path.get_ident()
            && let Some(module) = self.resolver.macro_in_scope(self.module, &name.to_string())
        {
            self.add(module, name.span().start().line, &format!("{name}!"));
        }
        self.visit_arguments(&call.tokens);
    }

    fn visit_item_macro(&mut self, item: &'ast ItemMacro) {
        if item.ident.is_none() {
            return self.visit_macro(&item.mac);
        }
        for path in tokens::paths(item.mac.tokens.clone()) {
            // These are relative to where the macro is called.
            if !matches!(path.segments[0].as_str(), "self" | "super") {
                self.add_path(&path.segments, path.span);
            }
        }
    }

    // Comments that are documentation are attributes.
    fn visit_attribute(&mut self, _: &'ast Attribute) {}

    fn visit_vis_restricted(&mut self, _: &'ast VisRestricted) {}
}
