//! Dependencies of crates, lengths of files, unsafe code: on small examples.

use std::path::Path;

use residual_check::crates::{self, Row};
use residual_check::idle_tests;
use residual_check::problem::Problem;
use residual_check::sizes::{self, MOST_LINES, REASON};
use residual_check::unsafe_code;
use residual_check::workspace::{Package, Target, Workspace};

/// What the problems are, without what to do.
fn what(problems: &[Problem]) -> Vec<&str> {
    problems.iter().map(|problem| &*problem.what).collect()
}

fn workspace(packages: &[(&str, &[&str])]) -> Workspace {
    let package = |(name, dependencies): &(&str, &[&str])| Package {
        name: (*name).to_owned(),
        directory: Path::new("/nowhere").join(name),
        targets: Vec::new(),
        dependencies: dependencies.iter().map(ToString::to_string).collect(),
    };
    Workspace {
        root: "/nowhere".into(),
        packages: packages.iter().map(package).collect(),
    }
}

fn row(package: &'static str, may_use: &'static [&'static str]) -> Row {
    Row { package, may_use }
}

#[test]
fn crates_depend_on_what_the_table_allows() {
    let table = [row("a", &[]), row("b", &["a"]), row("c", &["b"])];
    let problems = |packages| crates::problems(&workspace(packages), &table);
    assert!(problems(&[("a", &["serde_json"]), ("b", &["a"]), ("c", &["b"])]).is_empty());

    let found = problems(&[("a", &[]), ("b", &["a"]), ("c", &["a", "b"])]);
    assert_eq!(what(&found), ["c may not depend on a"]);
    assert!(found[0].to_string().starts_with("c/Cargo.toml: "));

    let found = problems(&[("a", &[]), ("b", &[]), ("c", &["b"])]);
    assert_eq!(what(&found), ["b may use a and does not"]);

    let found = problems(&[("a", &[]), ("b", &["a"]), ("d", &[])]);
    let expected = [
        "the row c is of no package",
        "the table of crates has no row for d",
    ];
    assert_eq!(what(&found), expected);
}

#[test]
fn a_row_allows_nothing_of_the_rows_below() {
    let table = [row("a", &["b"]), row("b", &["a"])];
    let found = crates::problems(&workspace(&[("a", &["b"]), ("b", &["a"])]), &table);
    assert_eq!(what(&found), ["the row a stands above b, which it may use"]);
}

#[test]
fn the_line_of_a_manifest_is_given() {
    let folder = tempfile::tempdir().unwrap();
    let manifest = "[package]\nname = \"b\"\n\n[dependencies]\na.workspace = true\n";
    std::fs::write(folder.path().join("Cargo.toml"), manifest).unwrap();
    let mut workspace = workspace(&[("a", &[]), ("b", &["a"])]);
    workspace.root = folder.path().to_owned();
    workspace.packages[1].directory = folder.path().to_owned();
    let found = crates::problems(&workspace, &[row("a", &[]), row("b", &[])]);
    assert!(
        found[0]
            .to_string()
            .starts_with("Cargo.toml:5: b may not depend on a\n")
    );
}

#[test]
fn a_long_file_has_a_reason_in_its_head() {
    let problem = |text: &str| sizes::problem(Path::new("x.rs"), text);
    let code = |lines: usize| "fn f();\n".repeat(lines);
    assert_eq!(problem(&code(MOST_LINES)), None);
    let found = problem(&code(MOST_LINES + 1)).unwrap();
    assert_eq!(found.what, "401 lines, where 400 are allowed");

    let reason = |text: &str| format!("//! A table.\n//!\n{REASON}{text}\n");
    assert_eq!(
        problem(&(reason(" it is one table.") + &code(MOST_LINES))),
        None
    );
    let found = problem(&(reason("") + &code(MOST_LINES))).unwrap();
    assert!(found.to_string().starts_with("x.rs:3: an empty reason\n"));
    let found = problem(&(reason(" it was one.") + &code(1))).unwrap();
    assert!(
        found
            .to_string()
            .starts_with("x.rs:3: a reason for more than 400 lines")
    );

    // A reason further down is none.
    let found = problem(&(code(MOST_LINES) + &reason(" it is one table."))).unwrap();
    assert_eq!(found.what, "403 lines, where 400 are allowed");
}

#[test]
fn unsafe_code_is_found_in_syntax_and_in_macros() {
    let text = r#"#![forbid(unsafe_code)]
//! unsafe
// unsafe
const TEXT: &str = "unsafe";
fn f() {
    unsafe { g() }
}
macro_rules! m { () => {
    unsafe fn h() {}
} }
"#;
    let found = unsafe_code::in_file(Path::new("x.rs"), text).unwrap();
    let places: Vec<_> = found
        .iter()
        .map(|problem| problem.place.as_ref().unwrap().to_string())
        .collect();
    assert_eq!(places, ["x.rs:6", "x.rs:9"]);
}

#[test]
fn the_workspace_is_what_cargo_says() {
    let workspace = Workspace::own().unwrap();
    let own = workspace
        .packages
        .iter()
        .find(|package| package.name == "residual-check")
        .unwrap();
    assert_eq!(own.directory, Path::new(env!("CARGO_MANIFEST_DIR")));
    assert_eq!(own.directory, workspace.root.join("check"));
    // For tests, too.
    assert!(own.dependencies.iter().any(|name| name == "tempfile"));
    let mut kinds: Vec<_> = own.targets.iter().map(|target| &*target.kind).collect();
    kinds.sort_unstable();
    assert_eq!(kinds, ["bin", "lib", "test", "test"]);
}

#[test]
fn tests_that_cargo_does_not_run_are_found() {
    let folder = tempfile::tempdir().unwrap();
    let test = "fn f() {}\n#[test]\nfn t() {}\n";
    for (file, text) in [
        ("src/lib.rs", "mod a;"),
        ("src/a.rs", test),
        ("src/main.rs", test),
        ("tests/t.rs", test),
    ] {
        let path = folder.path().join(file);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    let places = |library: bool, program: bool| {
        let targets = [
            ("lib", "src/lib.rs", library),
            ("bin", "src/main.rs", program),
            ("test", "tests/t.rs", true),
        ];
        let mut workspace = workspace(&[("p", &[])]);
        workspace.root = folder.path().to_owned();
        workspace.packages[0].directory = folder.path().to_owned();
        workspace.packages[0].targets = targets
            .map(|(kind, source, is_tested)| Target {
                kind: kind.to_owned(),
                source: folder.path().join(source),
                is_tested,
            })
            .into();
        let found = idle_tests::problems(&workspace).unwrap();
        let places = found.iter().map(|problem| problem.place.as_ref());
        places
            .map(|place| place.unwrap().to_string())
            .collect::<Vec<_>>()
    };
    assert!(places(true, true).is_empty());
    assert_eq!(places(true, false), ["src/main.rs:2"]);
    assert_eq!(places(false, false), ["src/a.rs:2", "src/main.rs:2"]);
}
