//! The price list: each effect can be taken out, what is put in without use changes nothing, and the command says so.

use std::path::Path;
use std::process::Command;

use residual_scenegen::ablation::{instead, without};
use residual_scenegen::desc::WarningKind;
use residual_scenegen::effects::{Effect, Effects};
use residual_scenegen::plan::plan;
use residual_tests::tiny;

#[test]
fn effects_can_be_taken_out() {
    let mut taken_out = 0;
    for tiny in tiny::all() {
        let options = tiny.options.clone();
        let before = Effects::of(&plan(&tiny.scene, &options).unwrap());
        for effect in before.iter() {
            let changed = without(effect, &tiny.scene, &options);
            assert_eq!(changed.is_some(), instead(effect).is_some(), "{effect}");
            let Some((scene, options)) = changed else {
                continue;
            };
            scene.validate().unwrap();
            let after = plan(&scene, &options).unwrap();
            // A scene without lights gets a sky; textures have other uses, which are effects of their own.
            let others = [
                Effect::NormalMaps,
                Effect::CoatNormalMaps,
                Effect::TexturedEmission,
                Effect::AlphaMasks,
                Effect::AlphaBlending,
            ];
            let stays = match effect {
                Effect::Environment => after
                    .warnings
                    .iter()
                    .any(|warning| warning.kind == WarningKind::NoLight),
                Effect::Textures => others.iter().any(|other| before.has(*other)),
                _ => false,
            };
            let is_in = Effects::of(&after).has(effect);
            assert_eq!(is_in, stays, "{}: {effect}", tiny.name);
            taken_out += 1;
        }
    }
    assert!(taken_out > 30, "{taken_out}");
}

#[test]
fn the_command_measures_them() {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/textured.gltf");
    let output = Command::new(env!("CARGO_BIN_EXE_residual-tests"))
        .arg("inspect")
        .arg(scene)
        .args(["--measure", "--json", "--tier", "interpreted"])
        .args(["--size", "40x30", "--spp", "1", "--rounds", "2"])
        .output()
        .unwrap();
    assert!(output.status.success());
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let prices = report["prices"].as_array().unwrap();
    let number = |price: &serde_json::Value, name: &str| price[name].as_f64().unwrap();
    let (called_for, others): (Vec<_>, Vec<_>) =
        prices.iter().partition(|price| price["in"] == true);
    assert!(called_for.len() > 8 && others.len() >= 2);
    for price in called_for {
        let effect = price["effect"].as_str().unwrap();
        assert_eq!(report["effects"][effect]["in"], true);
        assert!(
            number(price, "flip") > 0.0 && number(price, "relmse") > 0.0,
            "{price}"
        );
    }
    for price in others {
        assert_eq!(
            (number(price, "flip"), number(price, "relmse")),
            (0.0, 0.0),
            "{price}"
        );
    }
}
