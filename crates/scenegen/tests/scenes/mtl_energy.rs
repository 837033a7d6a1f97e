//! Surfaces of MTL files reflect no more than arrives.

use crate::common::gltf_text::warns;
use crate::common::obj_text::{material, mirror, phong};

/// What MTL adds may reflect more than arrives.
#[test]
fn mirrors_conserve_energy() {
    let (material, scene) = material("Kd 0.5 0.5 1\nKs 1 0 1\nmap_Ks white.png\nillum 3");
    let [diffuse, reflectance] = mirror(&material);
    assert_eq!(diffuse.factor, [0.25, 0.25, 0.5]);
    assert_eq!(reflectance.factor, [0.5, 0.0, 0.5]);
    assert!(reflectance.texture.is_some());
    assert!(warns(&scene, "m", "reflect 2 times what arrives"));
}

/// The colours of a material, and whether a warning says that they were too much.
fn check_colors(statements: &str, diffuse: [f32; 3], specular: [f32; 3], is_scaled: bool) {
    let (material, scene) = material(statements);
    let found = phong(&material);
    for (found, expected) in [
        (found.diffuse.factor, diffuse),
        (found.specular.factor, specular),
    ] {
        let mut pairs = found.iter().zip(expected);
        assert!(
            pairs.all(|(a, b)| (a - b).abs() < 1e-6),
            "{statements}: {found:?}"
        );
    }
    assert_eq!(
        warns(&scene, "m", "times what arrives"),
        is_scaled,
        "{statements}: {:?}",
        scene.warnings
    );
}

#[test]
fn surfaces_that_reflect_no_more_than_arrives_stay_as_they_are() {
    for (statements, diffuse, specular) in [
        (
            "Kd 1 1 1\nKs 1 1 1\nNs 9\nmap_Kd kd.png",
            [1.0; 3],
            [1.0; 3],
        ),
        ("Kd 0.9 0.9 0.9\nKs 0.1 0.1 0.1\nNs 9", [0.9; 3], [0.1; 3]),
        ("Kd 1 0 0\nKs 0 1 1\nNs 9", [1.0, 0.0, 0.0], [0.0, 1.0, 1.0]),
        ("Kd 1 1 1\nKs 1 1 1\nillum 1", [1.0; 3], [0.0; 3]),
    ] {
        check_colors(statements, diffuse, specular, false);
    }
}

#[test]
fn highlights_give_way_to_the_colour_underneath() {
    for (statements, diffuse, specular) in [
        // What Blender wrote for decades.
        (
            "Ns 96.078431\nKa 1 1 1\nKd 0.8 0.8 0.8\nKs 0.5 0.5 0.5\nNi 1\nd 1\nillum 2",
            [0.8; 3],
            [0.2; 3],
        ),
        (
            "Kd 0.64 0.64 0.64\nKs 0.5 0.5 0.5\nNs 96",
            [0.64; 3],
            [0.36; 3],
        ),
        (
            "Kd 0.6 0.3 0.3\nKs 0.6 0.6 0.6\nNs 0",
            [0.6, 0.3, 0.3],
            [0.4; 3],
        ),
        // The hue of the highlight stays.
        (
            "Kd 0.5 0.5 0.75\nKs 0.5 1 0.5\nNs 9",
            [0.5, 0.5, 0.75],
            [0.25, 0.5, 0.25],
        ),
        (
            "Kd 0.25 0.25 0.25\nKs 1 1 1\nNs 9\nmap_Ks white.png",
            [0.25; 3],
            [0.75; 3],
        ),
    ] {
        check_colors(statements, diffuse, specular, true);
    }
}

/// 4 % of the light, as plastic does.
#[test]
fn white_surfaces_stay_shiny() {
    let divided = |[r, g, b]: [f32; 3], sum: f32| [r / sum, g / sum, b / sum];
    for (statements, diffuse, specular, sum) in [
        (
            "Kd 1 0 0\nKs 1 1 1\nNs 0\nTf 0 0 0",
            [1.0, 0.0, 0.0],
            [0.04; 3],
            1.04,
        ),
        (
            "Kd 1 1 1\nKs 0.5 0.5 0.5\nNs 9\nmap_Kd white.png",
            [1.0; 3],
            [0.04; 3],
            1.04,
        ),
        (
            "Kd 0.98 0.98 0.98\nKs 1 0.5 0\nNs 9",
            [0.98; 3],
            [0.04, 0.02, 0.0],
            1.02,
        ),
        // A highlight that is less to begin with.
        (
            "Kd 1 1 1\nKs 0.02 0.02 0.02\nNs 9",
            [1.0; 3],
            [0.02; 3],
            1.02,
        ),
        ("Kd 2 1 0", [2.0, 1.0, 0.0], [0.0; 3], 2.0),
        ("Kd 2 1 0\nKs 1 1 1\nNs 9", [2.0, 1.0, 0.0], [0.04; 3], 2.04),
    ] {
        check_colors(
            statements,
            divided(diffuse, sum),
            divided(specular, sum),
            true,
        );
    }
    let (_, scene) = material("Kd 2 1 0\nKs 1 1 1\nNs 9");
    let message = "Kd and Ks reflect 3 times what arrives; Ks is multiplied by 0.04, both are divided by 2.04";
    assert!(warns(&scene, "m", message), "{:?}", scene.warnings);
}
