//! The texts of kernels, for every tiny scene: naga accepts them, nothing that was recorded is dead, and no function is so long
//! that drivers choke on it. No adapter is needed.

use std::collections::BTreeSet;

use naga::compact::{KeepUnused, compact};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use residual_device_wgpu::{Kernels, Traits};
use residual_render::layer::{Layer, Layers};
use residual_render::program::Structure;
use residual_render::tracer::{DebugView, TracerNode};
use residual_scenegen::plan::{PlanOptions, plan};
use residual_tests::{fixtures, read_scene, scenes, tiny};
use residual_wgsl::{Arithmetic, Division, Fma, SquareRoot};

/// Lines of the longest function that is allowed.
const LONGEST: usize = 1_500;

/// Everything in `f64` that can be.
const DOUBLE: Arithmetic = Arithmetic {
    fma: Fma::Double,
    division: Division::Double,
    square_root: SquareRoot::Double,
};

/// A kernel with its entry point.
struct Kernel {
    entry: String,
    text: String,
}

fn kernels(structure: &Structure, traits: Traits, arithmetic: Arithmetic) -> Vec<Kernel> {
    let kernels = Kernels::new(structure, traits, arithmetic);
    let mut all = vec![
        ("emit_paths", kernels.emit()),
        ("trace", kernels.trace()),
        ("plan", kernels.control()),
        ("scatter", kernels.scatter()),
        ("follow_path", kernels.megakernel()),
    ];
    all.extend(
        kernels
            .queues_with_steps()
            .map(|queue| ("shade", kernels.shade(queue))),
    );
    let kernel = |(entry, text): (&str, String)| Kernel {
        entry: entry.to_owned(),
        text,
    };
    all.into_iter().map(kernel).collect()
}

/// Every choice of what kernels may have in them.
fn traits() -> impl Iterator<Item = Traits> {
    (0..8).map(|bits| Traits {
        sided: bits & 1 != 0,
        visits: bits & 2 != 0,
        f64: bits & 4 != 0,
    })
}

/// Parses and validates; panics with naga's words and the text.
#[track_caller]
fn accept(text: &str, f64: bool) -> naga::Module {
    let module = naga::front::wgsl::parse_str(text)
        .unwrap_or_else(|error| panic!("{}\n{text}", error.emit_to_string(text)));
    let capabilities = match f64 {
        true => Capabilities::FLOAT64,
        false => Capabilities::empty(),
    };
    let mut validator = Validator::new(ValidationFlags::all(), capabilities);
    if let Err(error) = validator.validate(&module) {
        panic!("{}\n{text}", error.emit_to_string(text));
    }
    module
}

/// What naga could remove, by kind and name, and how many expressions of each function.
fn inventory(module: &naga::Module) -> BTreeSet<String> {
    let name = |name: &Option<String>| name.clone().unwrap_or_default();
    let mut all = BTreeSet::new();
    all.extend(
        module
            .types
            .iter()
            .filter_map(|(_, t)| Some(format!("struct {}", t.name.as_ref()?))),
    );
    all.extend(
        module
            .constants
            .iter()
            .map(|(_, c)| format!("const {}", name(&c.name))),
    );
    all.extend(
        module
            .global_variables
            .iter()
            .map(|(_, v)| format!("var {}", name(&v.name))),
    );
    let of_entries = module.entry_points.iter().map(|entry| &entry.function);
    for function in module.functions.iter().map(|(_, f)| f).chain(of_entries) {
        let (expressions, variables) = (function.expressions.len(), function.local_variables.len());
        all.insert(format!(
            "fn {}: {expressions} expressions, {variables} variables",
            name(&function.name)
        ));
    }
    all
}

/// What is written by hand for all kernels, of which one may use less.
const SHARED: [&str; 0] = [];

/// What naga removes from a kernel that is not shared.
fn dead(kernel: &Kernel, f64: bool) -> Vec<String> {
    let before = accept(&kernel.text, f64);
    let mut after = before.clone();
    let has_entry = |point: &naga::EntryPoint| point.name == kernel.entry;
    assert!(
        before.entry_points.iter().any(has_entry),
        "{}",
        kernel.entry
    );
    compact(&mut after, KeepUnused::No);
    let after = inventory(&after);
    let before = inventory(&before);
    let removed = before.difference(&after);
    removed
        .filter(|what| !SHARED.contains(&what.as_str()))
        .cloned()
        .collect()
}

/// The longest function of a text: lines and name.
fn longest(text: &str) -> (usize, String) {
    let (mut most, mut start, mut name) = ((0, String::new()), 0, "");
    for (number, line) in text.lines().enumerate() {
        if let Some(rest) = line.strip_prefix("fn ") {
            start = number;
            name = rest.split('(').next().unwrap_or_default();
        } else if line == "}" && number - start > most.0 {
            most = (number - start, name.to_owned());
        }
    }
    most
}

/// Checks all kernels of a structure; returns the length of the longest function.
fn check(name: &str, structure: &Structure) -> (usize, String) {
    let mut most = (0, String::new());
    for traits in traits() {
        for arithmetic in [Arithmetic::default(), DOUBLE] {
            let f64 = traits.f64 || arithmetic.needs_f64();
            for kernel in kernels(structure, traits, arithmetic) {
                let dead = dead(&kernel, f64);
                assert!(
                    dead.is_empty(),
                    "{name}, {}, {traits:?}: {dead:#?}\n{}",
                    kernel.entry,
                    kernel.text
                );
                most = most.max(longest(&kernel.text));
            }
        }
    }
    most
}

#[test]
fn kernels_of_tiny_scenes_are_valid_and_have_no_dead_code() {
    let mut most = (0, String::new());
    for tiny in tiny::all() {
        most = most.max(check(tiny.name, &tiny.plan().structure));
    }
    let (lines, name) = most;
    println!("the longest function: {name}, {lines} lines");
    assert!(lines <= LONGEST);
}
