//! Two-level hierarchies against `f64` in the world's space, and against themselves (B-10, B-11).

use glam::{Affine3A, Mat3, Vec3};
use residual_bvh::{
    AllHits, Bounds, BuildQuality, Bvh, FrontHits, Hit, Instance, InstanceFault, InstanceHit,
    InstancedBvh, Ray,
};

use crate::instanced_scene::{
    KINDS, Scene, check_in_world, closest, instanced, object, same_hit, scene, transform,
};
use crate::mesh::{Mesh, jittered_icosphere, soup};
use crate::random::Random;
use crate::runner::{Holes, Widths, aimed, same, trials};

/// The instances and triangles that `f64` finds, at its distances.
#[test]
fn instances_are_where_they_belong() {
    for (seed, kind) in KINDS.into_iter().enumerate() {
        let mut random = Random::new(70 + seed as u64);
        let scene = scene(&[kind], 24, &mut random);
        let (mut sure, count) = (0, trials(2000));
        for _ in 0..count {
            let target = scene.target(&mut random);
            let offset = random.in_cube(10.0);
            let ray = aimed([0, 1, 2].map(|axis| target[axis] + offset[axis]), target);
            check_in_world(&scene, &ray, &FrontHits);
            sure += usize::from(check_in_world(&scene, &ray, &AllHits));
        }
        assert!(sure > count / 4, "{kind}: {sure} of {count}");
    }
}

/// The answer is the best of what each instance gives alone, whatever the tree and however far the
/// ray comes from, bit for bit.
#[test]
fn no_answer_depends_on_the_tree() {
    let mut random = Random::new(80);
    for round in 0..6 {
        let mut scene = scene(&KINDS[..5], 60, &mut random);
        for i in 0..10 {
            // Ties: the smaller index wins.
            scene.instances.push(scene.instances[i]);
        }
        let scene = Scene::new(scene.meshes, scene.instances);
        let alone: Vec<InstancedBvh<8>> = scene
            .instances
            .iter()
            .map(|&instance| instanced(&scene.meshes, &[instance]))
            .collect();
        let distance = 10f32.powi(round);
        let mut hits = 0;
        for _ in 0..trials(1000) {
            let mut ray = aimed(random.in_cube(distance), scene.target(&mut random));
            if random.below(3) == 0 {
                (ray.tmin, ray.tmax) = (random.unit(), 1.0 + 0.2 * random.unit());
            }
            let mut best = InstanceHit::miss(ray.tmax);
            for (index, bvh) in alone.iter().enumerate() {
                let hit = closest(bvh, &ray);
                if hit.is_hit() && (!best.is_hit() || hit.hit.t < best.hit.t) {
                    best = InstanceHit {
                        instance: index as u32,
                        ..hit
                    };
                }
            }
            let hit = scene.closest(&ray, &AllHits);
            assert!(same_hit(&hit, &best), "{ray:?}: {hit:?}, {best:?}");
            scene.closest(&ray, &FrontHits);
            scene.closest(&ray, &Holes);
            hits += usize::from(hit.is_hit());
        }
        assert!(hits > trials(1000) / 4, "{hits}");
    }
}

/// A closed mesh has no holes, however it is transformed and wherever the ray comes from.
#[test]
fn closed_meshes_stay_closed() {
    let mut random = Random::new(81);
    for kind in KINDS {
        let mesh = jittered_icosphere(2, &mut random);
        let object_to_world = transform(kind, &mut random);
        let instances = vec![Instance {
            bvh: 0,
            object_to_world,
        }];
        let scene = Scene::new(vec![mesh], instances);
        for _ in 0..trials(5000) {
            let [from, to] = [random.in_cube(0.2), scene.meshes[0].edge_point(&mut random)]
                .map(|point| object_to_world.transform_point3(point.into()).to_array());
            let ray = aimed(from, to);
            assert!(scene.closest(&ray, &AllHits).is_hit(), "{kind}: {ray:?}");
        }
    }
}

/// One instance where the object is: the object's own answers, bit for bit.
#[test]
fn the_identity_changes_nothing() {
    let mut random = Random::new(82);
    for mesh in [
        soup(200, 0.4, &mut random),
        soup(50, 1e-3, &mut random),
        jittered_icosphere(2, &mut random),
    ] {
        let identity = Instance {
            bvh: 0,
            object_to_world: Affine3A::IDENTITY,
        };
        let plain = Widths::new(&mesh, BuildQuality::Medium);
        let scene = Scene::new(vec![mesh], vec![identity]);
        for i in 0..trials(20_000) {
            let org = random.in_cube(if i % 2 == 0 { 2.0 } else { 1000.0 });
            let ray = aimed(org, scene.meshes[0].edge_point(&mut random));
            let hit = scene.closest(&ray, &AllHits);
            assert!(same(&hit.hit, &plain.closest(&ray, &AllHits)), "{ray:?}");
            assert_eq!(hit.instance, if hit.is_hit() { 0 } else { Hit::NONE });
        }
    }
}

/// Fronts are the object's: a mirror takes them along.
#[test]
fn mirrors_take_fronts_along() {
    let mut mesh = Mesh::default();
    mesh.push([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]]);
    for (scale, front) in [
        (Vec3::ONE, 1.0),
        (Vec3::new(-1.0, 1.0, 1.0), 1.0),
        (-Vec3::Z + Vec3::X + Vec3::Y, -1.0),
    ] {
        let instance = Instance {
            bvh: 0,
            object_to_world: Affine3A::from_scale(scale),
        };
        let scene = Scene::new(vec![mesh.clone()], vec![instance]);
        for side in [1.0, -1.0] {
            let ray = aimed([0.0, 0.0, side], [0.0; 3]);
            assert!(scene.closest(&ray, &AllHits).is_hit());
            assert_eq!(
                scene.closest(&ray, &FrontHits).is_hit(),
                side == front,
                "{scale}"
            );
        }
    }
}

#[test]
fn nothing_is_never_hit() {
    let ray = aimed([0.0; 3], [1.0, 2.0, 3.0]);
    let zero = Scene::new(vec![], vec![]);
    assert!(!zero.closest(&ray, &AllHits).is_hit());
    assert_eq!(zero.w8.bounds(), Bounds::EMPTY);
    let empty = Instance {
        bvh: 0,
        object_to_world: Affine3A::IDENTITY,
    };
    let scene = Scene::new(vec![Mesh::default()], vec![empty; 100]);
    assert!(!scene.closest(&ray, &AllHits).is_hit());
    assert_eq!(scene.w8.bounds(), Bounds::EMPTY);

    // Between instances of something, too; and rays that are not valid.
    let mut random = Random::new(83);
    let full = Instance { bvh: 1, ..empty };
    let meshes = vec![Mesh::default(), jittered_icosphere(1, &mut random)];
    let scene = Scene::new(meshes, vec![empty, full, empty]);
    assert_eq!(scene.closest(&ray, &AllHits).instance, 1);
    for dir in [[0.0; 3], [f32::NAN; 3], [f32::INFINITY, 0.0, 0.0]] {
        let hit = scene.closest(&Ray { dir, ..ray }, &AllHits);
        assert!(same_hit(&hit, &InstanceHit::miss(ray.tmax)));
    }
}

#[test]
fn transforms_without_inverse_are_refused() {
    let bad = |linear: Mat3, place: Vec3, bvh: usize| {
        let good = Instance {
            bvh: 0,
            object_to_world: Affine3A::IDENTITY,
        };
        let bad = Instance {
            bvh,
            object_to_world: Affine3A::from_mat3_translation(linear, place),
        };
        let error = InstancedBvh::<8>::new(vec![object(&Mesh::default())], &[good, bad])
            .expect_err("a bad instance");
        assert_eq!(error.instance, 1);
        assert!(error.to_string().starts_with("instance 1: "));
        error.fault
    };
    let singular = Mat3::from_cols_array(&[1.0, 2.0, 3.0, 0.1, 0.2, 0.3, 0.0, 1.0, 7.0]);
    let (unit, origin) = (Mat3::IDENTITY, Vec3::ZERO);
    for linear in [Mat3::ZERO, Mat3::from_diagonal(Vec3::new(1.0, 0.0, 1.0)), {
        let mut linear = singular;
        linear.y_axis = singular.x_axis * 0.25;
        linear
    }] {
        assert_eq!(bad(linear, origin, 0), InstanceFault::NotInvertible);
    }
    assert_eq!(bad(unit * f32::NAN, origin, 0), InstanceFault::NotFinite);
    assert_eq!(bad(unit * 1e-40, origin, 0), InstanceFault::NotFinite);
    assert_eq!(
        bad(unit, Vec3::splat(f32::INFINITY), 0),
        InstanceFault::NotFinite
    );
    assert_eq!(bad(unit, origin, 3), InstanceFault::NoSuchObject { bvh: 3 });
}

/// An instance costs no more than 128 bytes, whatever the width; the mesh is stored once.
#[test]
fn instances_are_small() {
    let mut random = Random::new(84);
    for count in [64, 3000] {
        let scene = scene(&KINDS[..4], count, &mut random);
        fn each<const N: usize, const P: usize>(bvh: &InstancedBvh<N, P>) -> usize {
            let objects: usize = bvh.objects().iter().map(Bvh::memory_bytes).sum();
            bvh.memory_bytes() - objects
        }
        let sizes = [
            each(&scene.w2),
            each(&instanced::<4, 4>(&scene.meshes, &scene.instances)),
            each(&scene.w8),
            each(&scene.w16),
        ];
        println!(
            "{count} instances: {:?} bytes each",
            sizes.map(|size| size as f64 / count as f64)
        );
        assert!(sizes.iter().all(|&size| size <= 128 * count), "{sizes:?}");
    }
}

/// Many instances, also all at one place, or each within the other.
#[test]
fn many_instances() {
    let mut random = Random::new(85);
    let mesh = jittered_icosphere(0, &mut random);
    let count = trials(100_000);
    let shrinking = |i: usize| Affine3A::from_scale(Vec3::splat(0.999f32.powi(i as i32 % 20_000)));
    let random_places: Vec<Affine3A> = (0..count)
        .map(|_| Affine3A::from_translation(random.in_cube(100.0).into()))
        .collect();
    for (name, place) in [
        (
            "one place",
            &(|_| Affine3A::IDENTITY) as &dyn Fn(usize) -> Affine3A,
        ),
        ("nested", &shrinking),
        ("spread", &|i| random_places[i]),
    ] {
        let instances: Vec<Instance> = (0..count)
            .map(|i| Instance {
                bvh: 0,
                object_to_world: place(i),
            })
            .collect();
        let object: Bvh<8> = object(&mesh);
        let start = std::time::Instant::now();
        let bvh = InstancedBvh::new(vec![object], &instances).expect("sound transforms");
        println!(
            "{count} instances, {name}: {:.3} s",
            start.elapsed().as_secs_f64()
        );
        for _ in 0..50 {
            let ray = aimed(random.in_cube(0.1), mesh.edge_point(&mut random));
            let hit = closest(&bvh, &ray);
            assert!(hit.is_hit() || name == "spread");
            if name == "one place" {
                assert_eq!(hit.instance, 0);
            }
        }
    }
}
