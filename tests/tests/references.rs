//! Means of whole images against Cycles 5.0, rendered from the same files (`refs/cycles` of the shared scenes).
//!
//! Lambertian scenes must agree within noise. Elsewhere the models differ: Blender's Principled BSDF layers coats
//! over bases with its own albedo scaling where glTF's appendix B mixes by Fresnel; it has other Fresnel terms for
//! metals; and it sees textures with mipmaps. Tolerances are the measured difference plus noise, so that a change of
//! any formula that matters is seen.

use rayon::prelude::*;
use residual_device_cpu::LaneCount;
use residual_scenegen::plan::{CameraChoice, CullingRule, PlanOptions, View, plan};
use residual_tests::pictures::{mean, ratios, read_exr, within};
use residual_tests::{Look, Prepared, read_scene, scenes};
use serde_json::Value;

/// A reference, how many samples a pixel we take, and how far each channel's mean may be off.
struct Reference {
    scene: &'static str,
    folder: &'static str,
    samples: u32,
    tolerance: f64,
}

const REFERENCES: &[Reference] = &[
    Reference {
        scene: "cornell-generated.glb",
        folder: "interiors",
        samples: 48,
        tolerance: 0.008,
    },
    Reference {
        scene: "cornell-box.glb",
        folder: "interiors",
        samples: 48,
        tolerance: 0.006,
    },
    Reference {
        scene: "room.glb",
        folder: "bench",
        samples: 24,
        tolerance: 0.015,
    },
    Reference {
        scene: "living-room-grey-white.glb",
        folder: "interiors",
        samples: 32,
        tolerance: 0.02,
    },
    Reference {
        scene: "bedroom.glb",
        folder: "interiors",
        samples: 24,
        tolerance: 0.025,
    },
    Reference {
        scene: "staircase2-modern-hall.glb",
        folder: "interiors",
        samples: 48,
        tolerance: 0.05,
    },
    Reference {
        scene: "teapot-full.glb",
        folder: "interiors",
        samples: 24,
        tolerance: 0.03,
    },
    Reference {
        scene: "sponza-crytek.glb",
        folder: "bench",
        samples: 96,
        tolerance: 0.15,
    },
];

fn vector(entry: &Value, name: &str) -> [f64; 3] {
    let numbers = entry[name]
        .as_array()
        .unwrap()
        .iter()
        .map(|n| n.as_f64().unwrap());
    numbers.collect::<Vec<_>>().try_into().unwrap()
}

#[test]
fn means_agree_with_cycles() {
    let Some(scenes) = scenes() else { return };
    let folder = scenes.join("refs/cycles");
    let index = std::fs::read_to_string(folder.join("index.jsonl")).unwrap();
    let entries: Vec<Value> = index
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    println!(
        "{:<32} {:>4} {:>8} {:>8} {:>8}  tolerance",
        "scene", "spp", "red", "green", "blue"
    );
    // Importing and planning keep one processor busy.
    let off = REFERENCES.par_iter().filter_map(|reference| {
        let entry = entries
            .iter()
            .find(|entry| entry["scene"] == reference.scene)
            .unwrap();
        let size = ["width", "height"].map(|name| entry[name].as_u64().unwrap() as u32);
        let environment = entry["env"]
            .as_str()
            .map(|file| scenes.join("env").join(file));
        let scene = read_scene(
            &scenes.join(reference.folder).join(reference.scene),
            environment,
        )
        .unwrap();
        let view = View {
            eye: Some(vector(entry, "eye")),
            dir: Some(vector(entry, "dir")),
            up: Some(vector(entry, "up")),
            fov: Some(entry["yfov_deg"].as_f64().unwrap() as f32),
        };
        let options = PlanOptions {
            size,
            camera: CameraChoice::View(view),
            culling: CullingRule::None,
            ..PlanOptions::default()
        };
        let plan = plan(&scene, &options).unwrap();
        let look = Look {
            max_depth: entry["depth"].as_u64().unwrap() as u32,
            ..Look::new(size, reference.samples)
        };
        let film = Prepared::new(&plan, LaneCount::native()).interpret(&look);
        assert_eq!(film.invalid_samples(), 0, "{}", reference.scene);

        let file = folder.join(reference.scene).with_extension("exr");
        let theirs = mean(&read_exr(&file).unwrap().1);
        let stated = entry["mean"]
            .as_array()
            .unwrap()
            .iter()
            .map(|c| c.as_f64().unwrap());
        assert!(
            stated
                .zip(theirs)
                .all(|(stated, read)| (stated - read).abs() < 1e-4),
            "{}",
            reference.scene
        );
        let ratios = ratios(film.mean(), theirs);
        let [r, g, b] = ratios;
        let Reference {
            scene,
            samples,
            tolerance,
            ..
        } = reference;
        println!("{scene:<32} {samples:>4} {r:>8.4} {g:>8.4} {b:>8.4}  {tolerance}");
        (!within(ratios, *tolerance)).then_some((reference.scene, ratios))
    });
    let off: Vec<_> = off.collect();
    assert!(off.is_empty(), "ours over theirs: {off:#?}");
}
