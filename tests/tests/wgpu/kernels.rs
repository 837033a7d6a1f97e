//! The texts of kernels, for every tiny scene: naga accepts them, nothing that was recorded is dead, and no function is so long
//! that drivers choke on it. No adapter is needed.

use std::collections::{BTreeMap, BTreeSet};

use naga::compact::{KeepUnused, compact};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use residual_render::layer::{Layer, Layers};
use residual_render::program::Structure;
use residual_render::tracer::{AnySharing, DebugView, PathOrigin, TracerNode};
use residual_scenegen::plan::{PlanOptions, plan};
use residual_tests::{read_scene, scenes, tiny};
use residual_wgsl::{Arithmetic, Division, Fma, SquareRoot};
use residual_wgsl::{Kernels, Traits};

use crate::subject::{SCENES_OF_LAYERS, Subject};

/// Lines of the longest function that is allowed, and where paths begin at lights, whose lobes are evaluated for both sides.
const LONGEST: usize = 1_500;
const LONGEST_OF_LIGHTS: usize = 2_000;

/// Everything in `f64` that can be.
const DOUBLE: Arithmetic = Arithmetic {
    fma: Fma::Double,
    division: Division::Double,
    square_root: SquareRoot::Double,
};

/// What is written by hand for all kernels; each is used by some kernel, and need not be by every one.
const SHARED: [&str; 17] = [
    "const NONE",
    "const QUEUES",
    "const STACK",
    "const STRIDE",
    "const WORKGROUP",
    "fn add",
    "fn pixel_of",
    "fn sample_in",
    "fn sample_of",
    "struct Path",
    "struct Settings",
    "struct ShadowRay",
    "var paths",
    "var samples",
    "var settings",
    "var shadow_rays",
    "var tree",
];

/// A kernel of a scene.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Kernel {
    entry: &'static str,
    text: String,
}

/// All kernels of a structure's paths that begin at one end, with everything that they may have in them or not, each text once.
fn kernels(structure: &Structure, origin: PathOrigin) -> BTreeSet<Kernel> {
    let traits = (0..8).map(|bits| Traits {
        sided: bits & 1 != 0,
        visits: bits & 2 != 0,
        f64: bits & 4 != 0,
    });
    let everything = Traits {
        sided: true,
        visits: true,
        f64: true,
    };
    let native = traits.map(|traits| (traits, Arithmetic::default()));
    let mut all = BTreeSet::new();
    for (traits, arithmetic) in native.chain([(everything, DOUBLE)]) {
        let kernels = Kernels::new(structure, origin, traits, arithmetic);
        let mut add = |entry, text| all.insert(Kernel { entry, text });
        add("emit_paths", kernels.emit());
        add("trace", kernels.trace());
        add("plan", kernels.control());
        add("scatter", kernels.scatter());
        for queue in kernels.queues_with_steps() {
            add("shade", kernels.shade(queue));
        }
        if !kernels.folded().is_empty() {
            add("shade", kernels.shade_folded());
        }
        add("follow_path", kernels.megakernel());
    }
    all
}

/// Parses and validates; panics with naga's words and the text. Only a text that says so may compute in `f64`.
#[track_caller]
fn accept(text: &str) -> naga::Module {
    let module = naga::front::wgsl::parse_str(text)
        .unwrap_or_else(|error| panic!("{}\n{text}", error.emit_to_string(text)));
    let capabilities = match text.contains("f64") {
        true => Capabilities::FLOAT64,
        false => Capabilities::empty(),
    };
    let mut validator = Validator::new(ValidationFlags::all(), capabilities);
    if let Err(error) = validator.validate(&module) {
        panic!("{}\n{text}", error.emit_to_string(text));
    }
    module
}

/// What naga could remove: by kind and name, functions also with how much is in them.
fn inventory(module: &naga::Module) -> BTreeSet<(String, [usize; 2])> {
    let named = |kind: &str, name: &Option<String>| {
        let name = name.as_ref()?;
        Some((format!("{kind} {name}"), [0; 2]))
    };
    let types = module.types.iter();
    let types = types.filter_map(|(_, ty)| named("struct", &ty.name));
    let variables = module.global_variables.iter();
    let variables = variables.filter_map(|(_, variable)| named("var", &variable.name));
    let of_entries = module.entry_points.iter().map(|entry| &entry.function);
    let functions = module.functions.iter().map(|(_, function)| function);
    let functions = functions.chain(of_entries).map(|function| {
        let name = function.name.as_deref().unwrap_or_default();
        let sizes = [function.expressions.len(), function.local_variables.len()];
        (format!("fn {name}"), sizes)
    });
    types.chain(variables).chain(functions).collect()
}

/// Constants and variables that are named once and never again: naga keeps what has a name.
fn idle_names(text: &str) -> Vec<String> {
    let code = text.lines().filter(|line| !line.trim().starts_with("//"));
    let code: Vec<&str> = code.collect();
    let code = code.join("\n");
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    let mut idle = Vec::new();
    // Constants are named in the whole text, variables in their function.
    for (part, keywords) in std::iter::once((&code[..], &["const"][..])).chain(
        code.split("\nfn ")
            .map(|function| (function, &["let", "var"][..])),
    ) {
        let mut uses = BTreeMap::<&str, usize>::new();
        for word in part.split(|c| !is_part(c)) {
            *uses.entry(word).or_default() += 1;
        }
        for line in part.lines().map(str::trim) {
            let Some((keyword, rest)) = line.split_once(' ') else {
                continue;
            };
            let name = rest.split(|c| !is_part(c)).next().unwrap_or_default();
            if keywords.contains(&keyword) && uses[name] == 1 {
                idle.push(format!("{keyword} {name}"));
            }
        }
    }
    idle
}

/// What naga removes from a kernel, or removes something from, and names that nothing refers to.
fn dead(kernel: &Kernel) -> BTreeSet<String> {
    let before = accept(&kernel.text);
    let mut points = before.entry_points.iter();
    assert!(points.any(|point| point.name == kernel.entry));
    let mut after = before.clone();
    compact(&mut after, KeepUnused::No);
    let after = inventory(&after);
    let before = inventory(&before);
    let removed = before.difference(&after);
    let removed = removed.map(|(name, _)| name.clone());
    removed.chain(idle_names(&kernel.text)).collect()
}

/// The longest function of a text: its lines, and its name.
fn longest(text: &str) -> (usize, String) {
    let mut most = (0, String::new());
    let (mut start, mut name) = (0, "");
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

/// Checks all kernels of a structure.
fn check(name: &str, structure: &Structure) {
    check_from(name, structure, PathOrigin::Camera);
    if structure.tracer.has_light_paths() {
        let name = format!("{name}, from lights");
        check_from(&name, structure, PathOrigin::Lights);
    }
}

fn check_from(name: &str, structure: &Structure, origin: PathOrigin) {
    let mut most = (0, String::new());
    let mut unused: Option<BTreeSet<String>> = None;
    for kernel in kernels(structure, origin) {
        let dead = dead(&kernel);
        let is_shared = |what: &&String| SHARED.contains(&what.as_str());
        let recorded: Vec<_> = dead.iter().filter(|what| !is_shared(what)).collect();
        let Kernel { entry, text } = &kernel;
        assert!(recorded.is_empty(), "{name}, {entry}: {recorded:?}\n{text}");
        most = most.max(longest(text));
        unused = Some(match unused {
            Some(unused) => unused.intersection(&dead).cloned().collect(),
            None => dead,
        });
    }
    let unused = unused.expect("a kernel");
    assert!(unused.is_empty(), "{name}: no kernel uses {unused:?}");
    let (lines, function) = most;
    println!("{name}: the longest function is {function}, {lines} lines");
    let most = match origin {
        PathOrigin::Camera => LONGEST,
        PathOrigin::Lights => LONGEST_OF_LIGHTS,
    };
    assert!(lines <= most, "{name}: {function} has {lines} lines");
}

#[test]
fn kernels_of_tiny_scenes() {
    for tiny in tiny::all() {
        check(tiny.name, &tiny.plan().structure);
    }
}

#[test]
fn kernels_of_paths_from_both_ends() {
    // All are recorded and run in `reads.rs`.
    for tiny in tiny::all().into_iter().step_by(3) {
        let subject = Subject::from_both_ends(&tiny.scene, &tiny.options);
        check(tiny.name, &subject.plan.structure);
    }
}

#[test]
fn kernels_of_every_tracer_and_layer() {
    let views = DebugView::ALL.into_iter().map(TracerNode::Debug);
    let tracers = [
        TracerNode::default(),
        TracerNode::Bidirectional(AnySharing::Combined),
        TracerNode::Bidirectional(AnySharing::LightPathsOnly),
        TracerNode::AmbientOcclusion,
    ];
    for tracer in tracers.into_iter().chain(views) {
        for name in SCENES_OF_LAYERS {
            for layers in [Layers::NONE, Layer::ALL.into_iter().collect()] {
                let options = PlanOptions {
                    tracer,
                    layers,
                    ..PlanOptions::default()
                };
                let plan = plan(&tiny::named(name).scene, &options).unwrap();
                check(&format!("{tracer:?} of {name}"), &plan.structure);
            }
        }
    }
}

#[test]
fn kernels_of_interiors() {
    let Some(scenes) = scenes() else {
        return;
    };
    for file in [
        "cornell-box.glb",
        "living-room-grey-white.glb",
        "bedroom.glb",
    ] {
        let scene = read_scene(&scenes.join("interiors").join(file), None).unwrap();
        let plan = plan(&scene, &PlanOptions::default()).unwrap();
        check(file, &plan.structure);
    }
}

/// What is dead is found: a function, a variable, a constant, a structure, a value.
#[test]
fn dead_code_is_found() {
    let plan = tiny::plain().plan();
    let kernel = kernels(&plan.structure, PathOrigin::Camera)
        .into_iter()
        .find(|kernel| kernel.entry == "shade")
        .expect("a kernel");
    let text = kernel.text.clone();
    let with = |text: String| {
        let dead = dead(&Kernel {
            entry: kernel.entry,
            text,
        });
        let is_new = |what: &&String| !SHARED.contains(&what.as_str());
        dead.iter().filter(is_new).cloned().collect::<Vec<_>>()
    };
    assert_eq!(with(text.clone()), [""; 0]);
    for (addition, what) in [
        ("fn idle() -> u32 {\n    return 1u;\n}\n", "fn idle"),
        ("var<private> idle: u32;\n", "var idle"),
        ("const IDLE: u32 = 7u;\n", "const IDLE"),
        ("struct Idle {\n    x: u32,\n}\n", "struct Idle"),
    ] {
        assert_eq!(with(format!("{text}\n{addition}")), [what]);
    }
    let entry = "    let path = paths[slot];\n";
    let idle = format!("{entry}    let idle = path.state * 3u;\n");
    assert_eq!(with(text.replace(entry, &idle)), ["let idle"]);
}
