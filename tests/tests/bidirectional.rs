//! Paths from both ends, and paths from lights alone, find the image that the path tracer finds: with every material, texture, light
//! and camera there is.

use glam::{Affine3A, Vec3};
use rayon::prelude::*;
use residual_device_cpu::LaneCount;
use residual_render::tracer::{AnyMis, AnySharing, TracerNode};
use residual_scenegen::desc::{InstanceDesc, MaterialDesc, MeshDesc, PunctualKind, SceneDesc};
use residual_scenegen::plan::{CullingRule, Plan, PlanOptions, plan};
use residual_tests::fixtures::{color, material, matte, sheet};
use residual_tests::tiny::{self, SIZE, Tiny};
use residual_tests::{Look, Prepared};

/// Renders of a scene, which differ by their seeds.
const SEEDS: u32 = 16;
/// Blocks of the image, across and down.
const BLOCKS: [usize; 2] = [3, 3];
const BLOCK: [usize; 2] = [7, 5];

/// Point lights that paths from the camera cannot find by way of glass and mirrors become squares that they find by chance.
fn with_lamps(scene: &SceneDesc) -> SceneDesc {
    let mut scene = scene.clone();
    for light in std::mem::take(&mut scene.lights) {
        let PunctualKind::Point { position } = light.kind else {
            continue;
        };
        let corner = position - Vec3::new(0.3, 0.0, 0.3);
        scene.meshes.push(MeshDesc {
            material: scene.materials.len(),
            ..sheet(corner.to_array(), [0.6, 0.0, 0.0], [0.0, 0.0, 0.6])
        });
        scene.materials.push(MaterialDesc {
            emission: color([9.0, 7.0, 6.0]),
            double_sided: true,
            ..material("lamp", matte([0.5; 3]))
        });
        scene.instances.push(InstanceDesc {
            name: "lamp".to_owned(),
            mesh: scene.meshes.len() - 1,
            transform: Affine3A::IDENTITY,
        });
    }
    scene
}

fn planned(scene: &SceneDesc, options: &PlanOptions, tracer: TracerNode) -> Plan {
    let options = PlanOptions {
        tracer,
        // Light paths need surfaces that block light from both sides.
        culling: CullingRule::None,
        ..options.clone()
    };
    plan(scene, &options).unwrap()
}

/// Scenes of which paths from lights alone do not find everything: what is seen in a mirror or through smooth glass.
const SEEN_IN_MIRRORS: &[&str] = &[
    "thin_glass",
    "solid_glass",
    "tinted_glass",
    "milk",
    "drink",
    "prism",
    "tinted_prism",
    "mirror",
    "diffuse_and_mirror",
];

/// Mean of each block and channel over the seeds, and its standard error.
fn blocks(plan: &Plan, samples: u32) -> Vec<[f64; 2]> {
    let prepared = Prepared::new(plan, LaneCount::native());
    let renders: Vec<Vec<f64>> = (0..SEEDS)
        .map(|seed| {
            let look = Look {
                seed,
                ..Look::new(SIZE, samples)
            };
            let film = prepared.interpret(&look);
            assert_eq!(film.invalid_samples(), 0);
            let image = film.image();
            let mean = |k: usize| {
                let (block, channel) = (k / 3, k % 3);
                let [x, y] = [block % BLOCKS[0] * BLOCK[0], block / BLOCKS[0] * BLOCK[1]];
                let rows = (y..y + BLOCK[1]).flat_map(|y| {
                    let row = &image[y * SIZE[0] as usize..];
                    row[x..x + BLOCK[0]]
                        .iter()
                        .map(move |pixel| f64::from(pixel[channel]))
                });
                rows.sum::<f64>() / (BLOCK[0] * BLOCK[1]) as f64
            };
            (0..3 * BLOCKS[0] * BLOCKS[1]).map(mean).collect()
        })
        .collect();
    let n = f64::from(SEEDS);
    (0..renders[0].len())
        .map(|k| {
            let mean = renders.iter().map(|r| r[k]).sum::<f64>() / n;
            let squares: f64 = renders.iter().map(|r| (r[k] - mean).powi(2)).sum();
            [mean, (squares / (n - 1.0) / n).sqrt()]
        })
        .collect()
}

/// The largest difference, in standard errors.
fn difference(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    let z = |([a, ea], [b, eb]): (&[f64; 2], &[f64; 2])| {
        // Rounding alone is no difference.
        (a - b).abs() / (ea.hypot(*eb) + 1e-5 * a.max(*b) + 1e-9)
    };
    a.iter().zip(b).map(z).fold(0.0, f64::max)
}

/// What is wrong with the images of a scene.
fn failures(tiny: &Tiny) -> Vec<String> {
    let has_mirrors = SEEN_IN_MIRRORS.contains(&tiny.name);
    let scene = match has_mirrors {
        true => with_lamps(&tiny.scene),
        false => tiny.scene.clone(),
    };
    let image = |tracer, samples| blocks(&planned(&scene, &tiny.options, tracer), samples);
    let paths = image(TracerNode::Path(AnyMis::PowerHeuristic), 64);
    let both = image(TracerNode::Bidirectional(AnySharing::Combined), 32);
    let check = |what: &str, other: &[[f64; 2]]| {
        let z = difference(&paths, other);
        let mean = |blocks: &[[f64; 2]]| blocks.iter().map(|[mean, _]| mean).sum::<f64>();
        let ratio = mean(other) / mean(&paths);
        let message = format!("{} {what}: {z:.1} standard errors, {ratio:.4}", tiny.name);
        println!("{message}");
        // Of some 3,000 blocks, with 16 seeds each.
        (z > 7.0).then_some(message)
    };
    let from_both = check("from both ends", &both);
    // Paths from lights read textures as they are, where others are filtered. Directions below a mapped normal that was tilted
    // for light's way are in no sample of theirs.
    let differs = ["mipmaps", "normal_map"].contains(&tiny.name);
    let from_lights = (!has_mirrors && !differs).then(|| {
        let light = image(TracerNode::Bidirectional(AnySharing::LightPathsOnly), 64);
        check("from lights", &light)
    });
    from_both.into_iter().chain(from_lights.flatten()).collect()
}

#[test]
fn all_strategies_find_the_same_image() {
    // Their images are single tiles, which keep one processor busy.
    let failures: Vec<_> = tiny::all().par_iter().flat_map(failures).collect();
    assert!(failures.is_empty(), "{failures:#?}");
}
