//! `inspect`.

use std::path::Path;

use residual_scenegen::effects::{Effect, Effects};
use residual_scenegen::plan::{BindingTimes, PlanOptions, plan};
use residual_tests::read_scene;
use serde_json::{Value, json};

use super::{good, run, statistics, workplace};

#[test]
fn inspect_speaks_json() {
    let folder = workplace();
    let report = statistics(&good(run(&folder, &["inspect", "triangle.obj", "--json"])));
    assert_eq!(
        (&report["scene"], &report["triangles"]),
        (&json!("triangle"), &json!(1))
    );
    assert_eq!(report["effects"]["environment"]["in"], true);
    assert_eq!(report["effects"]["spot lights"]["in"], false);
    let reasons = report["effects"]["diffuse reflection"]["called_for_by"]
        .as_array()
        .unwrap();
    assert_eq!(reasons.len(), 1, "{reasons:?}");
    assert_eq!(report["programs"].as_array().unwrap().len(), 1);
    let text = String::from_utf8(good(run(&folder, &["inspect", "triangle.obj"])).stdout).unwrap();
    assert!(
        text.contains("effects in:") && text.contains("effects out:"),
        "{text}"
    );
}

/// The report says what the plan and its effects say.
#[test]
fn the_report_is_the_plan() {
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/textured.gltf");
    let report = statistics(&good(run(&workplace(), &["inspect", scene, "--json"])));
    let scene = read_scene(Path::new(scene), None).unwrap();
    let plan = plan(&scene, &PlanOptions::default()).unwrap();
    let effects = Effects::of(&plan);
    assert_eq!(
        report["effects"].as_object().unwrap().len(),
        Effect::ALL.len()
    );
    for &effect in Effect::ALL {
        let row = &report["effects"][effect.to_string()];
        assert_eq!(row["in"], effects.has(effect), "{effect}");
        assert_eq!(
            row["called_for_by"],
            json!(effects.reasons(effect)),
            "{effect}"
        );
        assert_eq!(
            row["changes_nothing"],
            json!(effects.dismissed(effect)),
            "{effect}"
        );
        let callers = row["called_for_by"].as_array().unwrap();
        assert_eq!(row["in"], !callers.is_empty(), "{effect}");
    }
    for decision in plan.decisions() {
        assert_eq!(report["plan"][decision.about], decision.text);
    }
    for more in ["lanes", "hierarchy"] {
        assert!(report["plan"][more].is_string(), "{more}");
    }
    let programs = report["programs"].as_array().unwrap();
    assert_eq!(programs.len(), plan.structure.programs.len());
    for ((row, program), materials) in programs
        .iter()
        .zip(&plan.structure.programs)
        .zip(&plan.materials)
    {
        let names: Vec<_> = materials.iter().map(|material| &material.name).collect();
        assert_eq!(row["materials"], json!(names));
        let times = BindingTimes::of(program);
        for (name, count) in [
            ("constants", times.constants),
            ("parameters", times.parameters),
            ("images", times.images),
            ("vertices", times.vertices),
        ] {
            assert_eq!(row[name], json!(count), "{names:?}: {name}");
        }
    }

    // And what the file says.
    let row = |effect: Effect| &report["effects"][effect.to_string()]["called_for_by"];
    let callers = [
        ("wood", "wood-normal"),
        ("wood", "wood"),
        ("inlaid tile", "tile"),
        ("inlaid tile", "tile-surface"),
        ("leaf", "leaf"),
    ];
    let textures = row(Effect::Textures).as_array().unwrap();
    for (material, image) in callers {
        let caller = json!(format!("material {material:?}, image {image:?}"));
        assert!(textures.contains(&caller), "{caller}: {textures:?}");
    }
    assert_eq!(textures.len(), callers.len(), "{textures:?}");
    assert_eq!(row(Effect::NormalMaps), &json!(["material \"wood\""]));
    assert_eq!(row(Effect::AlphaMasks), &json!(["material \"leaf\""]));
    assert_eq!(row(Effect::VertexColors), &json!(["material \"glaze\""]));
    let program = |name: &str| {
        let has = |row: &&Value| row["materials"].as_array().unwrap().contains(&json!(name));
        programs.iter().find(has).unwrap()
    };
    // Base colour and normal map; base colour, metallic and roughness; base colour and alpha.
    for (name, images) in [("wood", 2), ("inlaid tile", 3), ("leaf", 2), ("copper", 0)] {
        assert_eq!(program(name)["images"], images, "{name}");
    }
    assert_eq!(program("glaze")["vertices"], 1);
}
