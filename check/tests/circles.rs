//! Circles of files, in small crates that are written for the purpose.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use residual_check::files::circles;

/// The uses within circles of a crate of these files, as `from:line to`. The first file is its root.
fn uses_in_circles(files: &[(&str, &str)]) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    let folder = folder.path().canonicalize().unwrap();
    let name = |path: &Path| path.strip_prefix(&folder).unwrap().display().to_string();
    let circles = circles(&folder.join(files[0].0)).unwrap();
    for circle in &circles {
        let files: BTreeSet<_> = circle.uses.iter().map(|used| &used.from).collect();
        assert_eq!(files.len(), circle.files);
    }
    let uses = circles.iter().flat_map(|circle| &circle.uses);
    uses.map(|used| format!("{}:{} {}", name(&used.from), used.line, name(&used.to)))
        .collect()
}

#[test]
fn through_use() {
    let found = uses_in_circles(&[
        ("lib.rs", "mod a;\nmod b;\nmod c;"),
        ("a.rs", "use crate::b::B;\npub struct A(B);"),
        (
            "b.rs",
            "pub struct B;\nuse crate::{c::C, a};\nfn f(_: a::A, _: C) {}",
        ),
        ("c.rs", "pub struct C;"),
    ]);
    assert_eq!(found, ["a.rs:1 b.rs", "b.rs:3 a.rs"]);
}

#[test]
fn through_super() {
    let found = uses_in_circles(&[
        ("lib.rs", "mod a;"),
        ("a/mod.rs", "mod b;\npub struct A;\nfn f() { b::g() }"),
        ("a/b.rs", "\npub fn g() { let _ = super::A; }"),
    ]);
    assert_eq!(found, ["a/mod.rs:3 a/b.rs", "a/b.rs:2 a/mod.rs"]);
}

#[test]
fn through_bare_paths_of_types_expressions_patterns_and_bounds() {
    for use_of_b in [
        "fn f() -> b::B { todo!() }",
        "fn f() { b::B::new(); }",
        "fn f(x: u8) { match x { b::C => (), _ => () } }",
        "fn f(x: impl b::D) {}",
        "impl b::D for A {}",
        "fn f() { let _ = Vec::<b::B>::new(); }",
        "fn f() { let _ = <b::B as Clone>::clone; }",
        "struct Of<const N: usize = { b::C }>;",
    ] {
        let found = uses_in_circles(&[
            ("lib.rs", &format!("mod b;\nstruct A;\n{use_of_b}")),
            (
                "b.rs",
                "use crate::A;\npub struct B(A);\npub const C: u8 = 1;\npub trait D {}",
            ),
        ]);
        assert_eq!(found, ["lib.rs:3 b.rs", "b.rs:1 lib.rs"], "{use_of_b}");
    }
}

#[test]
fn through_re_exports_to_the_file_that_defines() {
    let found = uses_in_circles(&[
        ("lib.rs", "mod a;\nmod b;\npub use a::A;"),
        (
            "a/mod.rs",
            "mod inner;\npub use inner::{A, Other as Renamed};\npub use inner::deep::*;",
        ),
        (
            "a/inner/mod.rs",
            "pub mod deep;\nuse crate::b::B;\npub struct A(B);\npub struct Other;",
        ),
        ("a/inner/deep.rs", "pub struct Deep;\n\nuse crate::b::C;"),
        (
            "b.rs",
            "pub struct B;\npub struct C;\nfn f(_: crate::A) {}\nuse crate::a::Deep;",
        ),
    ]);
    assert_eq!(
        found,
        [
            "a/inner/mod.rs:2 b.rs",
            "a/inner/deep.rs:3 b.rs",
            "b.rs:3 a/inner/mod.rs",
            "b.rs:4 a/inner/deep.rs",
        ]
    );
}

#[test]
fn through_another_name_of_a_module() {
    let found = uses_in_circles(&[
        (
            "lib.rs",
            "mod a;\nmod b;\nmod outer { pub use crate::b as inner; }",
        ),
        (
            "a.rs",
            "use crate::outer::inner::{self as other};\npub fn f() { other::g() }",
        ),
        ("b.rs", "pub fn g() { crate::a::f() }"),
    ]);
    assert_eq!(found, ["a.rs:2 b.rs", "b.rs:1 a.rs"]);
}

#[test]
fn through_names_within_functions() {
    let found = uses_in_circles(&[
        ("lib.rs", "mod a;\nmod b;"),
        ("a.rs", "pub fn f() {\n    use crate::b;\n    b::g();\n}"),
        ("b.rs", "pub fn g() {\n    use crate::*;\n    a::f();\n}"),
    ]);
    assert_eq!(found, ["a.rs:3 b.rs", "b.rs:3 a.rs"]);
}

#[test]
fn through_a_re_export_that_is_used_at_home() {
    let found = uses_in_circles(&[
        (
            "lib.rs",
            "mod b;\npub use b::B;\npub struct A;\nfn f(_: B) {}",
        ),
        ("b.rs", "pub struct B(crate::A);"),
    ]);
    assert_eq!(found, ["lib.rs:4 b.rs", "b.rs:1 lib.rs"]);
}

#[test]
fn through_a_re_export_of_what_is_not_a_childs() {
    let found = uses_in_circles(&[
        ("lib.rs", "mod a;\nmod b;"),
        ("a.rs", "pub use crate::b::B;\npub struct A;"),
        ("b.rs", "pub struct B(crate::a::A);"),
    ]);
    assert_eq!(found, ["a.rs:1 b.rs", "b.rs:1 a.rs"]);
}

#[test]
fn through_what_macros_are_called_with() {
    for call in [
        "fn f() { assert_eq!(b::g(), 1, \"{}\", b::C); }",
        "fn f() { let _ = vec![b::C; 2]; }",
        "table! { first => b::g, second }",
        "thread_local! { static X: b::B = b::B; }",
    ] {
        let found = uses_in_circles(&[
            ("lib.rs", &format!("mod b;\npub struct A;\n{call}")),
            ("b.rs", "use crate::A;"),
        ]);
        assert_eq!(found, ["lib.rs:3 b.rs", "b.rs:1 lib.rs"], "{call}");
    }
}

#[test]
fn through_definitions_of_macros() {
    let found = uses_in_circles(&[
        ("lib.rs", "mod a;\nmod b;"),
        (
            "a.rs",
            "#[macro_export]\nmacro_rules! call {\n    ($x:expr) => { $crate::b::g($x) };\n}",
        ),
        ("b.rs", "pub fn g(x: u8) { crate::call!(x) }"),
    ]);
    assert_eq!(found, ["a.rs:3 b.rs", "b.rs:1 a.rs"]);
}

#[test]
fn through_calls_of_macros_that_are_in_scope_by_their_order() {
    let found = uses_in_circles(&[
        (
            "lib.rs",
            "macro_rules! call { () => {} }\nmod b;\nfn f() { b::g() }",
        ),
        ("b.rs", "pub fn g() { call!() }"),
    ]);
    assert_eq!(found, ["lib.rs:3 b.rs", "b.rs:1 lib.rs"]);
}

#[test]
fn through_items_that_macros_define() {
    let found = uses_in_circles(&[
        ("lib.rs", "mod a;\nmod b;\npub use a::*;"),
        (
            "a.rs",
            "nodes! { Diffuse(albedo), Mirror }\npub fn f() { crate::b::g() }",
        ),
        ("b.rs", "pub fn g() { let _ = crate::Mirror; }"),
    ]);
    assert_eq!(found, ["a.rs:2 b.rs", "b.rs:1 a.rs"]);
}

#[test]
fn through_globs_of_what_a_module_defines() {
    let found = uses_in_circles(&[
        ("lib.rs", "mod b;\npub trait A {}\nfn f() { b::g() }"),
        ("b.rs", "use super::*;\npub fn g() {}"),
    ]);
    assert_eq!(found, ["lib.rs:3 b.rs", "b.rs:1 lib.rs"]);
}

#[test]
fn through_files_that_a_path_attribute_names() {
    let found = uses_in_circles(&[
        (
            "src/lib.rs",
            "#[path = \"../other/x.rs\"]\nmod b;\npub struct A;\nfn f() { b::g() }",
        ),
        ("other/x.rs", "use super::A;\nmod y;\npub fn g() { y::h() }"),
        ("other/y.rs", "use super::g;\npub fn h() {}"),
    ]);
    assert_eq!(
        found,
        [
            "src/lib.rs:4 other/x.rs",
            "other/x.rs:1 src/lib.rs",
            "other/x.rs:3 other/y.rs",
            "other/y.rs:1 other/x.rs",
        ]
    );
}

#[test]
fn through_tests_of_a_file() {
    let found = uses_in_circles(&[
        ("lib.rs", "mod a;\nmod b;"),
        (
            "a.rs",
            "pub fn f() {}\n#[cfg(test)]\nmod tests {\n    use super::*;\n    use crate::b::g;\n}",
        ),
        ("b.rs", "pub fn g() { crate::a::f() }"),
    ]);
    assert_eq!(found, ["a.rs:5 b.rs", "b.rs:1 a.rs"]);
}

#[test]
fn circles_that_do_not_meet_are_two() {
    let found = uses_in_circles(&[
        ("lib.rs", "mod a;\nmod b;\nmod c;\nmod d;"),
        ("a.rs", "pub fn f() { crate::b::f(); crate::c::f() }"),
        ("b.rs", "pub fn f() { crate::a::f() }"),
        ("c.rs", "pub fn f() { crate::d::f() }"),
        ("d.rs", "pub fn f() { crate::c::f() }"),
    ]);
    assert_eq!(
        found,
        ["a.rs:1 b.rs", "b.rs:1 a.rs", "c.rs:1 d.rs", "d.rs:1 c.rs"]
    );
}

/// Crates without a circle, each of which has something that might be taken for one.
#[test]
fn no_circle() {
    let crates: &[(&str, &[(&str, &str)])] = &[
        (
            "a module that declares and re-exports children which use it",
            &[
                ("lib.rs", "mod a;"),
                (
                    "a/mod.rs",
                    "mod b;\nmod c;\npub use b::B;\npub(crate) use self::c::*;\npub struct A;",
                ),
                ("a/b.rs", "use super::A;\npub struct B(A);"),
                ("a/c.rs", "use super::{A, B};\npub struct C(A, B);"),
            ],
        ),
        (
            "siblings by way of their parent",
            &[
                ("lib.rs", "mod a;\npub use a::*;"),
                (
                    "a.rs",
                    "mod b;\nmod c;\npub use b::B;\nuse c::C;\nfn f(_: C) {}",
                ),
                ("a/b.rs", "pub struct B;"),
                ("a/c.rs", "use super::B;\nuse crate::*;\npub struct C(B);"),
            ],
        ),
        (
            "comments and texts",
            &[
                (
                    "lib.rs",
                    "//! See [`crate::b::B`].\nmod b;\n/// As [`b::B`] does.\npub struct A;\nfn f() {\n    // b::g()\n    println!(\"b::g() {}\", \"crate::b::B\");\n}\n#[doc = \"b::g\"]\nfn g() {}",
                ),
                ("b.rs", "pub struct B(crate::A);"),
            ],
        ),
        (
            "variables, fields and methods with names of re-exports",
            &[
                (
                    "lib.rs",
                    "mod b;\npub use b::hit;\npub struct A { hit: u8 }\nfn f(hit: u8) -> A { println!(\"{}\", hit); dbg!(hit + 1); let a = A { hit }; a.hit(); table!(hit: 1, a.hit(), fn hit()); a }",
                ),
                ("b.rs", "use crate::A;\npub fn hit() {}"),
            ],
        ),
        (
            "other crates with names of modules",
            &[
                ("lib.rs", "mod a;\nmod b;"),
                (
                    "a.rs",
                    "use ::b::B;\nfn f() { ::b::g() }\nuse glam::Vec3;\npub struct A(Vec3);",
                ),
                ("b.rs", "pub fn f(_: crate::a::A) {}"),
            ],
        ),
        (
            "a module that is imported for what its child has",
            &[
                ("lib.rs", "mod a;"),
                ("a/mod.rs", "mod b;\nmod c;\npub fn f() { c::f() }"),
                ("a/b.rs", "pub fn f() {}"),
                ("a/c.rs", "use crate::a;\npub fn f() { a::b::f() }"),
            ],
        ),
        (
            "a module and a function of one name",
            &[
                (
                    "lib.rs",
                    "mod a;\nmod trace;\nuse trace::trace;\nfn f() { trace() }",
                ),
                ("a.rs", "use crate::trace::trace;\nfn f() { trace() }"),
                ("trace.rs", "pub fn trace() {}"),
            ],
        ),
        (
            "macros whose paths are relative to their caller",
            &[
                ("lib.rs", "mod a;\npub fn g() {}\nfn f() { a::f() }"),
                (
                    "a/mod.rs",
                    "macro_rules! call { ($name:ident) => { super::g(); $name::g(); } }\nmod b;\npub fn f() {}",
                ),
                ("a/b.rs", "call!(x);"),
            ],
        ),
        (
            "tests in a file of their own",
            &[
                ("lib.rs", "mod a;\nmod b;"),
                ("a.rs", "pub fn f() {}\n#[cfg(test)]\nmod tests;"),
                ("a/tests.rs", "use super::*;\nuse crate::b::g;"),
                ("b.rs", "pub fn g() { crate::a::f() }"),
            ],
        ),
        (
            "where an item may be seen",
            &[
                ("lib.rs", "mod a;\npub struct A;\nfn f() { a::b::g() }"),
                ("a.rs", "pub mod b;"),
                (
                    "a/b.rs",
                    "pub(in crate::a) struct B;\npub(super) struct C;\npub(crate) fn g() {}",
                ),
            ],
        ),
        (
            "modules within a file",
            &[(
                "lib.rs",
                "mod a { pub fn f() { super::b::f() } }\nmod b { pub fn f() { super::a::f() } }",
            )],
        ),
    ];
    for (name, files) in crates {
        assert_eq!(uses_in_circles(files), Vec::<String>::new(), "{name}");
    }
}

#[test]
fn what_is_not_rust_is_an_error_with_file_and_line() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path().join("lib.rs");
    fs::write(&root, "fn f() {}\nfn {").unwrap();
    let error = circles(&root).unwrap_err().to_string();
    assert!(error.contains("lib.rs:2: "), "{error}");
}
