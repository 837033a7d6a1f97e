//! A module: recorded functions, what they refer to, and what a device writes around them.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use residual_render::domain::tape::Output;

use crate::arithmetic::{Arithmetic, Helper};
use crate::bindings::Bindings;
use crate::names::type_name;
use crate::print::print;
use crate::recorded::Recorded;

const HEADER: &str = "\
// Printed by residual-wgsl from a scene's structure. Directions are world space. A path is its ray (`org`, `dir`, a unit
// vector), `throughput`, the density `pdf` of its direction, the sample that it belongs to (`pixel`, a hash, and `index`)
// and its `state`, which is 1 for the ray from the camera.
";

/// A text of WGSL while it is put together.
#[derive(Clone, Debug, Default)]
pub struct Module {
    arithmetic: Arithmetic,
    structs: BTreeMap<&'static str, String>,
    bindings: Bindings,
    names: BTreeSet<String>,
    functions: String,
}

impl Module {
    /// An empty module whose operations are spelled like this.
    pub fn new(arithmetic: Arithmetic) -> Self {
        Self {
            arithmetic,
            ..Self::default()
        }
    }

    /// Adds a line of comment.
    pub fn heading(&mut self, heading: &str) {
        let _ = write!(self.functions, "\n// {heading}\n");
    }

    /// Adds a function, unless it is there.
    ///
    /// # Panics
    /// If a structure of outputs has two definitions.
    pub fn add(&mut self, recorded: &Recorded) {
        let Recorded {
            function,
            result,
            comment,
        } = recorded;
        if !self.names.insert(function.name.clone()) {
            return;
        }
        if function.outputs.len() > 1 {
            let text = structure(result, &function.outputs);
            let known = self.structs.insert(result, text.clone());
            assert!(
                known.is_none_or(|known| known == text),
                "{result} has one definition"
            );
        }
        let printed = print(function, result, self.arithmetic);
        self.bindings.extend(&printed.bindings);
        let _ = write!(self.functions, "\n// {comment}\n{}", printed.text);
    }

    /// Adds what a device has written. It may call the recorded functions and their helpers.
    pub fn add_text(&mut self, text: &str) {
        let _ = write!(self.functions, "\n{text}");
    }

    /// The text.
    pub fn finish(self) -> String {
        let mut text = HEADER.to_owned();
        let declarations = self.bindings.declarations();
        if !declarations.is_empty() {
            let _ = write!(text, "\n{declarations}");
        }
        for structure in self.structs.values() {
            let _ = write!(text, "\n{structure}");
        }
        for helper in Helper::called_in(&self.functions) {
            let _ = write!(text, "\n{}", helper.definition(self.arithmetic));
        }
        text + &self.functions
    }
}

fn structure(name: &str, outputs: &[Output]) -> String {
    let mut text = format!("struct {name} {{\n");
    for output in outputs {
        let _ = writeln!(text, "    {}: {},", output.name, type_name(output.kind));
    }
    text + "}\n"
}
