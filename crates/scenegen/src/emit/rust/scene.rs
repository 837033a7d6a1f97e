//! The type `Scene` of emitted code, and what it is made of.

use std::fmt::{self, Write as _};

use residual_render::light::LightTree;
use residual_render::program::{Program, Structure};

use super::layout::{Code, Name};
use super::literals::{Images, Literals};
use super::module::Module;
use super::tracer;
use crate::fingerprint::fingerprint;
use crate::plan::Plan;

const SCENE: &str = "
/// The scene's structure. What is not in it is not in the renderer.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    #[allow(dead_code, reason = \"read by alpha tests only\")]
    buffers: &'a Buffers<'a>,
}

impl<'a> Scene<'a> {
    /// The scene over its data.
    pub fn new(buffers: &'a Buffers<'a>) -> Self {
        Self { buffers }
    }
}

impl Scene<'_> {
    /// The fingerprint of the structure: the plan whose data are rendered must have the same.
    #[allow(dead_code, reason = \"read by programs that embed the renderer\")]
";

/// The type and its implementation of the renderer's trait.
pub(super) fn scene(out: &mut Module, plan: &Plan, images: &Images<'_>) -> fmt::Result {
    out.write_str(SCENE)?;
    out.import("domain", &["Buffers", "Domain"]);
    writeln!(
        out,
        "    pub const STRUCTURE: u64 = {:#018x};",
        fingerprint(&plan.structure)
    )?;
    tracer::constants(out, &plan.structure)?;
    writeln!(out, "}}")?;
    for (name, kind, value) in images.constants() {
        let start = format!("const {name}: {} = ", out.lines(&kind, 0, 0, 0));
        let value = out.lines(&value, 0, start.len(), 1);
        writeln!(out, "\n{start}{value};")?;
    }
    implementation(out, plan, &Literals::new(images, &[]))
}

fn implementation(out: &mut Module, plan: &Plan, literals: &Literals<'_>) -> fmt::Result {
    let structure = &plan.structure;
    let mut types = Code::tuple([]);
    let mut values = Code::tuple([]);
    for light in structure.lights.iter().rev() {
        let light = light.literal();
        types = Code::tuple([literals.kind(&light), types]);
        values = Code::tuple([literals.value(&light), values]);
    }
    if let Some(LightTree { levels }) = structure.light_tree {
        types = Code::generic(Name::of("light", "ByTree"), [types]);
        let levels = Code::word(levels.to_string());
        let tree = Code::literal(Name::of("light", "LightTree"), [("levels", levels)]);
        values = Code::literal(
            Name::of("light", "ByTree"),
            [("tree", tree), ("kinds", values)],
        );
    }
    let camera = structure.camera.literal();
    writeln!(
        out,
        "\nimpl<D: Domain> render::renderer::Renderer<D> for Scene<'_> {{"
    )?;
    let start = "    type Camera = ";
    let kind = out.lines(&literals.kind(&camera), 4, start.len(), 1);
    writeln!(out, "{start}{kind};")?;
    tracer::associated_type(out, structure)?;
    let start = "    type Lights = ";
    let types = out.lines(&types, 4, start.len(), 1);
    writeln!(out, "{start}{types};\n")?;
    let camera = out.lines(&literals.value(&camera), 8, 9, 0);
    writeln!(
        out,
        "    #[inline(always)]\n    fn camera(&self) -> &Self::Camera {{\n        &{camera}\n    }}"
    )?;
    tracer::method(out, structure)?;
    for (light, of_kind) in structure.lights.iter().zip(&plan.lights) {
        writeln!(out, "    // {}: {}", light.literal().name, of_kind.count)?;
    }
    let values = out.lines(&values, 8, 9, 0);
    writeln!(
        out,
        "    #[inline(always)]\n    fn lights(&self) -> &Self::Lights {{\n        &{values}\n    }}"
    )?;
    alpha_tests(out, &structure.programs, literals)?;
    programs(out, structure)?;
    writeln!(out, "}}")
}

/// The methods about alpha tests; none if no surface has one.
fn alpha_tests(out: &mut Module, programs: &[Program], literals: &Literals<'_>) -> fmt::Result {
    if programs.iter().all(|program| program.alpha_test.is_none()) {
        return Ok(());
    }
    out.import("alpha", &["Candidate", "alpha_test"]);
    out.import("triangle", &["program_in"]);
    writeln!(
        out,
        "    #[inline(always)]\n    fn has_alpha_tests(&self) -> bool {{\n        true\n    }}"
    )?;
    writeln!(
        out,
        "    #[inline(always)]\n    fn alpha_test(&self, candidate: &Candidate) -> bool {{"
    )?;
    writeln!(
        out,
        "        match program_in(self.buffers, candidate.triangle) {{"
    )?;
    for (index, program) in programs.iter().enumerate() {
        let Some(test) = &program.alpha_test else {
            continue;
        };
        let test = out.bind("test", &literals.value(&test.literal()), 16);
        writeln!(out, "            {index} => {{\n                {test}")?;
        writeln!(
            out,
            "                alpha_test(self.buffers, &test, candidate)\n            }}"
        )?;
    }
    writeln!(out, "            _ => true,\n        }}\n    }}")
}

/// The methods about programs.
fn programs(out: &mut Module, structure: &Structure) -> fmt::Result {
    out.import("renderer", &["MaterialVisitor"]);
    let count = structure.programs.len();
    writeln!(
        out,
        "    #[inline(always)]\n    fn programs(&self) -> usize {{\n        {count}\n    }}"
    )?;
    let visitor = if count == 0 { "_" } else { "visitor" };
    writeln!(
        out,
        "    #[inline(always)]\n    fn visit_material<V: MaterialVisitor<D>>(&self, program: usize, {visitor}: V) -> V::Output {{"
    )?;
    writeln!(out, "        match program {{")?;
    for index in 0..count {
        writeln!(
            out,
            "            {index} => visitor.visit(&program{index}::Program),"
        )?;
    }
    writeln!(
        out,
        "            _ => unreachable!(\"the scene has {count} programs\"),"
    )?;
    writeln!(out, "        }}\n    }}")
}
