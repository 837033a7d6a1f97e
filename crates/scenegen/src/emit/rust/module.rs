//! A module of emitted Rust: its text, and a list of the names that the text uses.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use super::layout::{Code, Origin, WIDTH};

/// A module while it is written.
#[derive(Debug)]
pub(super) struct Module {
    /// How the module says the renderer's crate.
    render: &'static str,
    /// Columns in front of its lines.
    indent: usize,
    text: String,
    /// Names by the modules of the renderer's crate that have them.
    names: BTreeMap<&'static str, BTreeSet<String>>,
    /// Names of the module around it, shorter ones first, so that numbers at their ends are in order.
    outer: BTreeSet<(usize, String)>,
}

impl Module {
    /// The emitted module, which calls the renderer's crate `render`.
    pub(super) fn emitted() -> Self {
        Self::new("render", 0)
    }

    /// A module in it.
    pub(super) fn inner() -> Self {
        Self::new("super::render", super::layout::LEVEL)
    }

    fn new(render: &'static str, indent: usize) -> Self {
        Self {
            render,
            indent,
            text: String::new(),
            names: BTreeMap::new(),
            outer: BTreeSet::new(),
        }
    }

    /// Names that are used of a module of the renderer's crate.
    pub(super) fn import(&mut self, module: &'static str, names: &[&str]) {
        let known = self.names.entry(module).or_default();
        known.extend(names.iter().map(|name| (*name).to_owned()));
    }

    /// Code in lines, as [`Code::lines`] breaks it.
    pub(super) fn lines(
        &mut self,
        code: &Code,
        indent: usize,
        column: usize,
        after: usize,
    ) -> String {
        self.import_names(code);
        code.lines(indent, column, after)
    }

    /// `let name = code;` in lines.
    pub(super) fn bind(&mut self, name: &str, code: &Code, indent: usize) -> String {
        self.define(&format!("let {name}"), code, indent)
    }

    /// `what = code;` in lines.
    pub(super) fn define(&mut self, what: &str, code: &Code, indent: usize) -> String {
        self.import_names(code);
        code.defines(what, indent)
    }

    fn import_names(&mut self, code: &Code) {
        for name in code.names() {
            let end = name.text.find(|c: char| !c.is_alphanumeric() && c != '_');
            let identifier = &name.text[..end.unwrap_or(name.text.len())];
            match name.origin {
                Origin::Known => {}
                Origin::Emitted => {
                    let known = (identifier.len(), identifier.to_owned());
                    self.outer.insert(known);
                }
                Origin::Render(module) => self.import(module, &[identifier]),
            }
        }
    }

    /// Lines that import what the module around it has; none if nothing is used of it.
    pub(super) fn outer_imports(&self) -> String {
        let names: Vec<_> = self.outer.iter().map(|(_, name)| name.as_str()).collect();
        match names.is_empty() {
            true => String::new(),
            false => self.import_line("super", &names),
        }
    }

    /// Lines that import what the renderer's crate has.
    pub(super) fn imports(&self) -> String {
        let line = |(module, names): (&&str, &BTreeSet<String>)| {
            let names: Vec<_> = names.iter().map(String::as_str).collect();
            self.import_line(&format!("{}::{module}", self.render), &names)
        };
        self.names.iter().map(line).collect()
    }

    /// What was written.
    pub(super) fn text(&self) -> &str {
        &self.text
    }

    /// `use path::{names};` as rustfmt breaks it: as many names on a line as there is room for.
    fn import_line(&self, path: &str, names: &[&str]) -> String {
        let indent = " ".repeat(self.indent);
        if let [name] = names {
            return format!("{indent}use {path}::{name};\n");
        }
        let line = format!("{indent}use {path}::{{{}}};\n", names.join(", "));
        // A list of names that just fits is broken all the same.
        if line.len() - 1 < WIDTH {
            return line;
        }
        let inner = " ".repeat(self.indent + super::layout::LEVEL);
        let mut lines = vec![String::new()];
        for name in names {
            let last = lines.last_mut().expect("there is a line");
            if last.is_empty() {
                *last = format!("{inner}{name},");
            } else if last.len() + 2 + name.len() <= WIDTH {
                *last += &format!(" {name},");
            } else {
                lines.push(format!("{inner}{name},"));
            }
        }
        format!(
            "{indent}use {path}::{{\n{}\n{indent}}};\n",
            lines.join("\n")
        )
    }
}

impl fmt::Write for Module {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.text.push_str(text);
        Ok(())
    }
}
