//! What naga says of a text.

use naga::compact::{KeepUnused, compact};
use naga::valid::{Capabilities, ValidationFlags, Validator};

/// Functions that printed ones call.
const HELPERS: [&str; 3] = ["copysign", "greatest", "least"];

/// Parses and validates; panics with naga's explanation and the text.
#[track_caller]
pub(crate) fn accept(text: &str) -> naga::Module {
    let module = naga::front::wgsl::parse_str(text)
        .unwrap_or_else(|error| panic!("{}\n{text}", error.emit_to_string(text)));
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    if let Err(error) = validator.validate(&module) {
        panic!("{}\n{text}", error.emit_to_string(text));
    }
    module
}

/// Sizes of everything that could be removed.
pub(crate) fn sizes(module: &naga::Module) -> Vec<(String, usize)> {
    let mut sizes = vec![
        ("types".to_owned(), module.types.len()),
        ("constants".to_owned(), module.constants.len()),
        ("globals".to_owned(), module.global_variables.len()),
        ("functions".to_owned(), module.functions.len()),
    ];
    for (_, function) in module.functions.iter() {
        let name = function.name.clone().unwrap_or_default();
        sizes.push((format!("{name}: expressions"), function.expressions.len()));
        sizes.push((format!("{name}: variables"), function.local_variables.len()));
    }
    sizes
}

/// Nothing in the module is unused: neither by naga's account nor, for names, by counting words.
#[track_caller]
pub(crate) fn no_dead_code(text: &str) {
    // Every function is wanted: an entry point calls them all.
    let module = accept(text);
    let calls = module
        .functions
        .iter()
        .filter(|(_, f)| !HELPERS.contains(&f.name.as_deref().unwrap_or_default()));
    let calls: Vec<String> =
        calls
            .map(|(_, function)| {
                let arguments = function.arguments.iter().map(|argument| {
                    match &module.types[argument.ty].inner {
                        naga::TypeInner::Vector { .. } => "vec3f(0.5)",
                        naga::TypeInner::Scalar(scalar)
                            if scalar.kind == naga::ScalarKind::Float =>
                        {
                            "0.5f"
                        }
                        naga::TypeInner::Scalar(_) => "1u",
                        other => panic!("{other:?}"),
                    }
                });
                let arguments: Vec<&str> = arguments.collect();
                format!(
                    "    _ = {}({});\n",
                    function.name.as_deref().unwrap(),
                    arguments.join(", ")
                )
            })
            .collect();
    let main = format!(
        "{text}\n@compute @workgroup_size(1)\nfn main() {{\n{}}}\n",
        calls.concat()
    );
    let before = accept(&main);
    let mut after = before.clone();
    compact(&mut after, KeepUnused::No);
    let shrunk: Vec<_> = sizes(&before)
        .into_iter()
        .zip(sizes(&after))
        .filter(|(before, after)| before != after)
        .collect();
    assert!(shrunk.is_empty(), "{shrunk:?}\n{text}");

    for function in text.split("\nfn ").skip(1) {
        let words: Vec<&str> = function
            .split(|c: char| !c.is_alphanumeric() && c != '_')
            .collect();
        for line in function.lines() {
            let line = line.trim();
            let Some(rest) = line.strip_prefix("let ").or(line.strip_prefix("var ")) else {
                continue;
            };
            let name = rest.split([' ', ':']).next().unwrap();
            let uses = words.iter().filter(|word| **word == name).count();
            let needed =
                if line.ends_with("f32;") || line.ends_with("u32;") || line.ends_with("bool;") {
                    4
                } else {
                    2
                };
            assert!(uses >= needed, "{name} is used {uses} times in\n{function}");
        }
    }
}
