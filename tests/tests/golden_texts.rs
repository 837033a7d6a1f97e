//! What is emitted for the tiny scenes is what `golden/` holds, and formatted. After a change of what is emitted:
//!
//! ```sh
//! RESIDUAL_BLESS=1 cargo test --release --package residual-tests --test golden_texts
//! ```
//!
//! writes the files; look at their differences before they are committed. `goldens.rs` compiles and runs them.

use std::collections::BTreeSet;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use residual_render::program::{
    AlphaTestNode, BsdfNode, CameraNode, ColorNode, Field, Form, FresnelNode, LayerFrameNode,
    LightNode, Literal, RoughnessNode, ScalarNode, SourceNode, Structure,
};
use residual_render::texture::Input;
use residual_scenegen::effects::{Effect, Effects};
use residual_scenegen::emit::rust;
use residual_scenegen::plan::{Binding, PlanOptions, plan};
use residual_tests::fixtures;
use residual_tests::tiny::{self, Tiny};

/// Lanes are fixed: files must not depend on the machine.
const LANES: &str = "Eight";

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("golden")
}

fn emitted(tiny: &Tiny) -> String {
    rust::module(&tiny.plan(), LANES)
}

/// The lines between the common beginning and the common end; `None` where there are none.
fn difference(old: &str, new: &str) -> Option<String> {
    if old == new {
        return None;
    }
    let (old, new): (Vec<_>, Vec<_>) = (old.split('\n').collect(), new.split('\n').collect());
    let same = |(a, b): &(&&str, &&str)| a == b;
    let start = old.iter().zip(&new).take_while(same).count();
    let rest = [&old[start..], &new[start..]];
    let end = rest[0].iter().rev().zip(rest[1].iter().rev());
    let end = end.take_while(same).count();
    let [old, new] = rest.map(|lines| &lines[..lines.len() - end]);
    let mark = |sign: &str, lines: &[&str]| -> String {
        lines
            .iter()
            .map(|line| format!("{sign} {line}\n"))
            .collect()
    };
    Some(format!(
        "from line {}:\n{}{}",
        start + 1,
        mark("-", old),
        mark("+", new)
    ))
}

#[test]
fn differences_are_those_lines_that_differ() {
    assert_eq!(difference("a\nb\n", "a\nb\n"), None);
    assert_eq!(
        difference("a\nb\nc\n", "a\nx\ny\nc\n").unwrap(),
        "from line 2:\n- b\n+ x\n+ y\n"
    );
    assert_eq!(difference("a\n", "a\na\n").unwrap(), "from line 2:\n+ a\n");
    assert_eq!(difference("a", "a\n").unwrap(), "from line 2:\n+ \n");
}

#[test]
fn emitted_texts_are_the_golden_ones() {
    let bless = std::env::var_os("RESIDUAL_BLESS").is_some();
    let tiny = tiny::all();
    let mut changed = String::new();
    let mut expected = BTreeSet::new();
    for tiny in &tiny {
        let file = format!("{}.rs", tiny.name);
        let path = folder().join(&file);
        let text = emitted(tiny);
        if bless {
            fs::create_dir_all(folder()).unwrap();
            fs::write(&path, &text).unwrap();
        }
        let golden = fs::read_to_string(&path).unwrap_or_default();
        if let Some(difference) = difference(&golden, &text) {
            changed += &format!("golden/{file}, {difference}\n");
        }
        assert!(expected.insert(file), "{} is there twice", tiny.name);
    }
    assert!(
        changed.is_empty(),
        "other texts are emitted than before (- golden, + emitted):\n\n{changed}\
         RESIDUAL_BLESS=1 writes the new ones, if this is meant"
    );
    let found: BTreeSet<_> = fs::read_dir(folder())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    assert_eq!(
        found, expected,
        "files without a scene, or scenes without a file"
    );
}

/// Nothing but the scene's description goes into the text.
#[test]
fn emission_is_deterministic() {
    for (first, second) in tiny::all().iter().zip(tiny::all()) {
        assert_eq!(difference(&emitted(first), &emitted(&second)), None);
    }
}

#[test]
fn each_scene_has_what_it_is_named_after() {
    let effects = |tiny: &Tiny| -> BTreeSet<_> { Effects::of(&tiny.plan()).iter().collect() };
    let plain = effects(&tiny::plain());
    let mut all = BTreeSet::new();
    for tiny in tiny::all() {
        let effects = effects(&tiny);
        let added: BTreeSet<_> = effects.difference(&plain).copied().collect();
        let lacking: BTreeSet<_> = plain.difference(&effects).copied().collect();
        assert_eq!(added, tiny.adds.iter().copied().collect(), "{}", tiny.name);
        assert_eq!(
            lacking,
            tiny.lacks.iter().copied().collect(),
            "{}",
            tiny.name
        );
        all.extend(effects);
    }
    assert_eq!(all, Effect::ALL.iter().copied().collect());
}

/// All nodes of a structure as they are written, those within others too.
fn literals(structure: &Structure) -> Vec<Literal<'_>> {
    fn add<'a>(literal: Literal<'a>, all: &mut Vec<Literal<'a>>) {
        for (_, field) in &literal.fields {
            match field {
                Field::Bsdf(node) => add(node.literal(), all),
                Field::Fresnel(node) => add(node.literal(), all),
                Field::Roughness(node) => add(node.literal(), all),
                Field::LayerFrame(node) => add(node.literal(), all),
                Field::ColorSource(node) => add(node.literal(), all),
                Field::ScalarSource(node) => add(node.literal(), all),
                _ => {}
            }
        }
        all.push(literal);
    }
    let mut all = Vec::new();
    for program in &structure.programs {
        for input in &program.inputs {
            let literal = match &input.source {
                SourceNode::Color(node) => node.literal(),
                SourceNode::Scalar(node) => node.literal(),
            };
            add(literal, &mut all);
        }
        add(program.bsdf.literal(), &mut all);
        let test = program.alpha_test.iter();
        test.for_each(|test| add(test.literal(), &mut all));
    }
    let lights = structure.lights.iter();
    lights.for_each(|light| add(light.literal(), &mut all));
    add(structure.camera.literal(), &mut all);
    all
}

/// The parts between the brackets that follow a name in a text without spaces, for each place where they do.
fn parts(text: &str, name: &str, open: char) -> Vec<Vec<String>> {
    let start = format!("{name}{open}");
    let at = |(start, matched): (usize, &str)| {
        let is_whole = !text[..start].ends_with(|c: char| c.is_alphanumeric() || c == '_');
        is_whole.then_some(start + matched.len())
    };
    let inside = |start: usize| {
        let mut parts = vec![String::new()];
        let mut depth = 0;
        for c in text[start..].chars() {
            match c {
                '(' | '{' | '[' | '<' => depth += 1,
                ')' | '}' | ']' | '>' if depth == 0 => break,
                ')' | '}' | ']' | '>' => depth -= 1,
                ',' if depth == 0 => {
                    parts.push(String::new());
                    continue;
                }
                _ => {}
            }
            parts.last_mut().unwrap().push(c);
        }
        parts.retain(|part| !part.is_empty());
        parts
    };
    text.match_indices(&start)
        .filter_map(at)
        .map(inside)
        .collect()
}

/// Whether a text without spaces has a node with the fields that the node table says.
fn is_written(text: &str, literal: &Literal<'_>) -> bool {
    let names: Vec<_> = literal.fields.iter().map(|(name, _)| *name).collect();
    match literal.form {
        Form::Unit => text.contains(literal.name),
        Form::Tuple => parts(text, literal.name, '(')
            .iter()
            .any(|parts| parts.len() == names.len()),
        Form::Struct => parts(text, literal.name, '{').iter().any(|parts| {
            let fields = parts.iter().map(|part| part.split(':').next().unwrap());
            fields.eq(names.iter().copied())
        }),
        Form::Value => text.contains(&format!("{}<", literal.name)),
    }
}

/// The node table says what is printed: names, fields and their order. Each of its rows is called for by some scene.
#[test]
fn every_row_of_the_node_table_is_emitted() {
    let without_spaces = |text: &str| text.replace(char::is_whitespace, "");
    let mut rows = BTreeSet::new();
    let tiny = tiny::all().into_iter().map(|tiny| tiny.plan());
    let fixtures = [fixtures::room(), fixtures::textures(), fixtures::lights()];
    let options = PlanOptions::default();
    let fixtures = fixtures.map(|scene| plan(&scene, &options).unwrap());
    for plan in tiny.chain(fixtures) {
        let text = without_spaces(&rust::module(&plan, LANES));
        for literal in literals(&plan.structure) {
            assert!(is_written(&text, &literal), "{}: {literal:?}", plan.name);
            rows.insert((literal.module, literal.name));
        }
    }
    let tables = [
        ("bsdf", BsdfNode::NAMES),
        ("bsdf", FresnelNode::NAMES),
        ("bsdf", RoughnessNode::NAMES),
        ("bsdf", LayerFrameNode::NAMES),
        ("texture", ColorNode::NAMES),
        ("texture", ScalarNode::NAMES),
        ("light", LightNode::NAMES),
        ("camera", CameraNode::NAMES),
        ("alpha", AlphaTestNode::NAMES),
    ];
    let all: BTreeSet<_> = tables
        .iter()
        .flat_map(|(module, names)| names.iter().map(|name| (*module, *name)))
        .collect();
    assert_eq!(rows, all);

    // The judge tells other fields, another order and other names from these.
    let sum = BsdfNode::Sum {
        a: Box::new(BsdfNode::Black),
        b: Box::new(BsdfNode::Black),
        probability: Input(0),
    };
    for (text, expected) in [
        ("Sum{a:Black,b:Black,probability,}", true),
        (
            "Sum{a:Mix{a:Black,b,weight},b:Black,probability:Bound(x),}",
            true,
        ),
        ("Sum{b:Black,a:Black,probability,}", false),
        ("Sum{a:Black,probability,}", false),
        ("MySum{a:Black,b:Black,probability,}", false),
    ] {
        assert_eq!(is_written(text, &sum.literal()), expected, "{text}");
    }
    let written = without_spaces(&format!("{sum:?}"));
    assert!(is_written(&written, &sum.literal()), "{written}");
}

/// What rustfmt would change. (Of its standard input, `--check` says nothing in its status.)
fn unformatted(text: &str) -> Option<String> {
    let mut rustfmt = Command::new("rustfmt")
        .args(["--edition", "2024"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    // A text is shorter than what it reads before it writes, since it has to parse all of it.
    rustfmt
        .stdin
        .take()
        .unwrap()
        .write_all(text.as_bytes())
        .unwrap();
    let output = rustfmt.wait_with_output().unwrap();
    assert!(output.status.success());
    difference(text, &String::from_utf8(output.stdout).unwrap())
}

fn has_rustfmt() -> bool {
    let found = Command::new("rustfmt").arg("--version").output();
    let found = found.is_ok_and(|output| output.status.success());
    if !found {
        println!("skipped: there is no rustfmt");
    }
    found
}

#[test]
fn emitted_texts_are_formatted() {
    if !has_rustfmt() {
        return;
    }
    assert!(unformatted("fn main() { }\n").is_some());
    for tiny in tiny::all() {
        assert_eq!(unformatted(&emitted(&tiny)), None, "{}", tiny.name);
    }
    // Lines break elsewhere where numbers are long.
    for mut scene in [fixtures::room(), fixtures::textures(), fixtures::lights()] {
        for material in &mut scene.materials {
            use residual_scenegen::desc::SurfaceDesc;
            if let SurfaceDesc::MetallicRoughness(surface) = &mut material.surface {
                surface.base_color.factor = [0.123_456_79, 1.234_567_8e-30, 0.987_654_3e-30];
                surface.specular_color.texture = surface.base_color.texture.clone();
                surface.specular.texture = surface.roughness.texture.clone();
                surface.specular.factor = 0.123_456_79;
            }
        }
        for binding in [Binding::Structure, Binding::Constants] {
            let options = PlanOptions {
                binding,
                ..PlanOptions::default()
            };
            let plan = plan(&scene, &options).unwrap();
            let text = rust::module(&plan, LANES);
            assert_eq!(unformatted(&text), None, "{}, {binding:?}", scene.name);
        }
    }
}

/// Names come from files, and comments end with the line.
#[test]
fn names_stay_in_comments() {
    let mut tiny = tiny::named("odd_names");
    let odd = tiny.scene.materials[0].name.clone();
    tiny.scene.name.clone_from(&odd);
    let text = emitted(&tiny);
    let plain = emitted(&tiny::plain());
    let code = |text: &str| -> Vec<String> {
        text.lines()
            .filter(|line| !line.trim_start().starts_with("//"))
            .map(str::to_owned)
            .collect()
    };
    assert!(odd.contains(['\n', '\r']));
    assert_eq!(code(&text), code(&plain));
    assert!(text.chars().all(|c| c == '\n' || (' '..='~').contains(&c)));
}
