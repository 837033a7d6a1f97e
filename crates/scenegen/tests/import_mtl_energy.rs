//! Surfaces of MTL files reflect no more than arrives.

use residual_scenegen::desc::SurfaceDesc;

mod common;

use common::gltf_text::warns;
use common::obj_text::{material, phong};

/// What MTL adds may reflect more than arrives.
#[test]
fn mirrors_conserve_energy() {
    let (material, scene) = material("Kd 0.5 0.5 1\nKs 1 0 1\nmap_Ks white.png\nillum 3");
    let SurfaceDesc::Mirror {
        diffuse,
        reflectance,
    } = &material.surface
    else {
        panic!("{material:?}")
    };
    assert_eq!(diffuse.factor, [0.25, 0.25, 0.5]);
    assert_eq!(reflectance.factor, [0.5, 0.0, 0.5]);
    assert!(reflectance.texture.is_some());
    assert!(warns(&scene, "m", "reflect 2 times what arrives"));
}

#[test]
fn highlights_conserve_energy() {
    for (statements, diffuse, specular) in [
        (
            "Kd 0.6 0.3 0.3\nKs 0.6 0.6 0.6\nNs 0",
            [0.5, 0.25, 0.25],
            [0.5; 3],
        ),
        (
            "Kd 1 0 0\nKs 1 1 1\nNs 0\nTf 0 0 0",
            [0.5, 0.0, 0.0],
            [0.5; 3],
        ),
        ("Kd 2 1 0", [1.0, 0.5, 0.0], [0.0; 3]),
        (
            "Kd 1 1 1\nKs 1 1 1\nNs 9\nmap_Kd white.png",
            [0.5; 3],
            [0.5; 3],
        ),
        // What the images leave is no more than 1.
        (
            "Kd 1 1 1\nKs 1 1 1\nNs 9\nmap_Kd kd.png",
            [1.0; 3],
            [1.0; 3],
        ),
        ("Kd 0.9 0.9 0.9\nKs 0.1 0.1 0.1\nNs 9", [0.9; 3], [0.1; 3]),
        ("Kd 1 1 1\nKs 1 1 1\nillum 1", [1.0; 3], [0.0; 3]),
    ] {
        let (material, scene) = material(statements);
        let found = phong(&material);
        for (found, expected) in [
            (found.diffuse.factor, diffuse),
            (found.specular.factor, specular),
        ] {
            let is_close = found
                .iter()
                .zip(expected)
                .all(|(a, b)| (a - b).abs() < 1e-6);
            assert!(is_close, "{statements}: {found:?}");
        }
        let is_scaled = diffuse[0] == 0.5 || statements == "Kd 2 1 0";
        assert_eq!(
            warns(&scene, "m", "times what arrives"),
            is_scaled,
            "{:?}",
            scene.warnings
        );
    }
}
