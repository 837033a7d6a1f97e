//! A material program of emitted code.

use std::collections::BTreeSet;
use std::fmt::{self, Write as _};

use residual_render::program::{InputNode, Program, SourceNode};

use super::layout::{Code, Name};
use super::literals::{Images, Literals, attribute_set};
use super::module::Module;
use crate::plan::MaterialUse;

/// A program, in a module of its own: what is in one module, the compiler compiles together, and modules in parallel.
pub(super) fn program(
    index: usize,
    program: &Program,
    uses: &[MaterialUse],
    images: &Images<'_>,
) -> Result<String, fmt::Error> {
    let mut comment = String::new();
    for material in uses {
        let images: BTreeSet<_> = material.images.values().collect();
        let images: String = images
            .into_iter()
            .map(|image| format!(", image {image:?}"))
            .collect();
        writeln!(comment, "/// {:?}{images}", material.name)?;
    }
    let mut module = Module::inner();
    implementation(&mut module, program, images)?;
    let outer = module.outer_imports();
    let blank = if outer.is_empty() { "" } else { "\n" };
    Ok(format!(
        "{comment}mod program{index} {{\n{outer}{blank}{}\n{}}}\n",
        module.imports(),
        module.text()
    ))
}

const PROGRAM: &str = "    pub struct Program;

    impl<D: Domain> Material<D> for Program {
        #[inline(always)]";

const SHADE: &str = "        #[inline(always)]
        #[allow(unused_variables, reason = \"not every program reads everything\")]
        fn shade<'s>(
            &'s self,
            d: D,
            surface: &mut Surface<D>,
            wo: Vec3<D::F>,
        ) -> Shading<D::F, impl Bsdf<D> + 's>
        where
            D: 's,
        {
";

fn implementation(out: &mut Module, program: &Program, images: &Images<'_>) -> fmt::Result {
    out.import("bsdf", &["Bsdf"]);
    out.import("domain", &["Domain"]);
    out.import("material", &["Material", "Shading"]);
    out.import("math", &["Vec3"]);
    out.import("surface", &["Attributes", "Surface"]);
    let attributes = out.lines(&attribute_set(program.attributes), 12, 12, 0);
    writeln!(
        out,
        "{PROGRAM}\n        fn attributes(&self) -> Attributes {{\n            {attributes}\n        }}\n"
    )?;
    if let Some(offset) = program.interior {
        out.import("material", &["medium"]);
        writeln!(
            out,
            "        #[inline(always)]\n        fn interior(&self, d: D, surface: &Surface<D>) -> Option<D::U> {{\n            Some(medium(d, surface, {offset}))\n        }}\n"
        )?;
    }
    if program.filters() {
        writeln!(
            out,
            "        #[inline(always)]\n        fn filters(&self) -> bool {{\n            true\n        }}\n"
        )?;
    }
    if program.disperses() {
        writeln!(
            out,
            "        #[inline(always)]\n        fn disperses(&self) -> bool {{\n            true\n        }}\n"
        )?;
    }
    out.write_str(SHADE)?;

    let names = input_names(&program.inputs);
    let literals = Literals::new(images, &names);
    for (input, name) in program.inputs.iter().zip(&names) {
        let value = match &input.source {
            SourceNode::Color(node) => literals
                .value(&node.literal())
                .method(".color(d, surface)", Name::of("texture", "ColorSource")),
            SourceNode::Scalar(node) => literals
                .value(&node.literal())
                .method(".scalar(d, surface)", Name::of("texture", "ScalarSource")),
        };
        let bound = Code::call(Name::of("texture", "Bound"), [value]);
        let bound = out.bind(name, &bound, 12);
        writeln!(out, "            {bound}")?;
    }
    if let Some(normal) = program.normal {
        out.import("surface", &["decode_normal"]);
        let [texel, scale] = [normal.texel, normal.scale].map(|input| &names[input.0]);
        writeln!(
            out,
            "            let normal = decode_normal(d, {texel}.0, {scale}.0);"
        )?;
        writeln!(
            out,
            "            *surface = surface.with_normal(d, normal, wo);"
        )?;
    }
    if let Some(tangent) = program.tangent {
        let [texel, cos, sin] =
            [tangent.texel, tangent.cos, tangent.sin].map(|input| &names[input.0]);
        let arguments = [
            Code::word("d"),
            Code::word(format!("{texel}.0")),
            Code::word(format!("[{cos}.0, {sin}.0]")),
        ];
        let tangent = Code::call(Name::of("surface", "decode_tangent"), arguments);
        let tangent = out.bind("tangent", &tangent, 12);
        writeln!(out, "            {tangent}")?;
        writeln!(
            out,
            "            *surface = surface.with_tangent(d, tangent);"
        )?;
    }
    let emission = match program.emission {
        None => Name::known("None"),
        Some(emission) => {
            let radiance = &names[emission.radiance.0];
            if emission.double_sided {
                Name::known(format!("Some({radiance}.0)"))
            } else {
                out.import("material", &["front_only"]);
                Name::known(format!("Some(front_only(d, surface, {radiance}.0))"))
            }
        }
    };
    let fields = [
        ("emission", Code::Word(emission)),
        ("bsdf", literals.value(&program.bsdf.literal())),
    ];
    let shading = Code::literal(Name::of("material", "Shading"), fields);
    let shading = out.lines(&shading, 12, 12, 0);
    writeln!(out, "            {shading}\n        }}\n    }}")
}

/// Names of a program's inputs; those that occur twice are numbered.
fn input_names(inputs: &[InputNode]) -> Vec<String> {
    let name = |(index, input): (usize, &InputNode)| {
        let twins = |other: &&InputNode| other.name == input.name;
        match inputs[..index].iter().filter(twins).count() {
            0 => input.name.to_owned(),
            before => format!("{}_{}", input.name, before + 1),
        }
    };
    inputs.iter().enumerate().map(name).collect()
}
