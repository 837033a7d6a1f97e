//! WGSL: a scene's structure as a module of functions that kernels call.
//!
//! Every function is recorded from the formulas of `residual-render` (thesis, section 3.1); none is written here.
//! Buffers are arrays of words, bound in group 0 under their number.

mod names;
mod print;
mod record;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use residual_render::domain::Buffer;
use residual_render::domain::tape::{Function, Output};
use residual_render::program::{Program, Structure};

use names::{buffer_name, type_name};
use print::print;
use record::{Outcome, Recorded};

const HEADER: &str = "\
// Printed by residual-scenegen from a scene's structure. Directions are world space. A path is its ray (`org`, `dir`, a
// unit vector), `throughput`, the density `pdf` of its direction, the sample that it belongs to (`pixel`, a hash, and
// `index`) and its `depth`, which is 1 for the ray from the camera.
";

const COPYSIGN: &str = "\
fn copysign(magnitude: f32, sign: f32) -> f32 {
    return bitcast<f32>(
        (bitcast<u32>(magnitude) & 0x7fffffffu) | (bitcast<u32>(sign) & 0x80000000u),
    );
}
";

/// The module of a scene: `emit`, for each program `program_K_step` and `_alpha_test`, and `miss`. What the scene does not
/// call for is not there.
pub fn wgsl_module(structure: &Structure) -> String {
    let mut module = Module::default();
    module.add(None, [record::emit(structure)]);
    let outcome = Outcome::of(structure);
    for (index, program) in structure.programs.iter().enumerate() {
        module.add(
            Some(describe(index, program)),
            record::program(index, program, structure, outcome),
        );
    }
    module.add(None, record::miss(structure));
    module.finish()
}

/// One recorded function as WGSL, several outputs in the structure `result`, with what it refers to. For
/// functions that only one device needs.
pub fn wgsl_function(function: &Function, result: &'static str) -> String {
    let mut module = Module::default();
    let name = function.name.replace('_', " ");
    module.add(
        None,
        [Recorded {
            function: function.clone(),
            result,
            comment: name,
        }],
    );
    module.finish()
}

fn describe(number: usize, program: &Program) -> String {
    let inputs = program.inputs.iter().enumerate();
    let inputs: Vec<String> = inputs
        .map(|(place, input)| format!("{place} {}", input.name))
        .collect();
    format!(
        "Program {number}: {:?}; inputs: {}",
        program.bsdf,
        inputs.join(", ")
    )
}

#[derive(Default)]
struct Module {
    structs: BTreeMap<&'static str, String>,
    buffers: BTreeSet<usize>,
    copysign: bool,
    functions: String,
}

impl Module {
    fn add(&mut self, heading: Option<String>, functions: impl IntoIterator<Item = Recorded>) {
        if let Some(heading) = heading {
            let _ = write!(self.functions, "\n// {heading}\n");
        }
        for Recorded {
            function,
            result,
            comment,
        } in functions
        {
            if function.outputs.len() > 1 {
                let text = structure(result, &function.outputs);
                let known = self.structs.insert(result, text.clone());
                assert!(
                    known.is_none_or(|known| known == text),
                    "{result} has one definition"
                );
            }
            let printed = print(&function, result);
            self.buffers.extend(printed.buffers);
            self.copysign |= printed.copysign;
            let _ = write!(self.functions, "\n// {comment}\n{}", printed.text);
        }
    }

    fn finish(self) -> String {
        let mut text = HEADER.to_owned();
        text.push('\n');
        for buffer in Buffer::ALL
            .into_iter()
            .filter(|&b| self.buffers.contains(&(b as usize)))
        {
            let (binding, name) = (buffer as usize, buffer_name(buffer));
            let _ = writeln!(
                text,
                "@group(0) @binding({binding}) var<storage, read> {name}: array<u32>;"
            );
        }
        for structure in self.structs.values() {
            let _ = write!(text, "\n{structure}");
        }
        if self.copysign {
            let _ = write!(text, "\n{COPYSIGN}");
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
