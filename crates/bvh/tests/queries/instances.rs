//! Two-level hierarchies against `f64` in the world's space, and against themselves (B-10, B-11).

use fearless_simd::{Level, dispatch};
use glam::{Affine3A, DAffine3, DMat3, DVec3, Mat3, Quat, Vec3};
use residual_bvh::{
    AllHits, Bounds, BuildQuality, Bvh, FrontHits, Hit, HitFilter, Instance, InstanceFault,
    InstanceHit, InstancedBvh, Ray, Watertight, any_instance_hit, build, closest_instance_hit,
};

use crate::mesh::{Mesh, jittered_icosphere, soup};
use crate::runner::{Holes, Random, Widths, aimed, same, trials};

/// One scene in hierarchies of several widths.
struct Scene {
    meshes: Vec<Mesh>,
    instances: Vec<Instance>,
    w2: InstancedBvh<2, 4>,
    w8: InstancedBvh<8>,
    w16: InstancedBvh<16, 8>,
}

fn instanced<const N: usize, const P: usize>(
    meshes: &[Mesh],
    instances: &[Instance],
) -> InstancedBvh<N, P> {
    InstancedBvh::new(meshes.iter().map(object).collect(), instances).expect("sound transforms")
}

fn object<const N: usize, const P: usize>(mesh: &Mesh) -> Bvh<N, P> {
    build(&mesh.positions, &mesh.triangles, None, BuildQuality::Medium)
}

fn closest(bvh: &InstancedBvh<8>, ray: &Ray) -> InstanceHit {
    dispatch!(Level::new(), simd => closest_instance_hit(simd, Watertight, bvh, ray, &AllHits))
}

impl Scene {
    fn new(meshes: Vec<Mesh>, instances: Vec<Instance>) -> Scene {
        Scene {
            w2: instanced(&meshes, &instances),
            w8: instanced(&meshes, &instances),
            w16: instanced(&meshes, &instances),
            meshes,
            instances,
        }
    }

    /// Every width's and query's answer, which must be the same.
    fn closest<F: HitFilter>(&self, ray: &Ray, filter: &F) -> InstanceHit {
        let (w2, w8, w16) = (&self.w2, &self.w8, &self.w16);
        let (hits, any) = dispatch!(Level::new(), simd => (
            [
                closest_instance_hit(simd, Watertight, w2, ray, filter),
                closest_instance_hit(simd, Watertight, w8, ray, filter),
                closest_instance_hit(simd, Watertight, w16, ray, filter),
            ],
            [
                any_instance_hit(simd, Watertight, w2, ray, filter),
                any_instance_hit(simd, Watertight, w8, ray, filter),
                any_instance_hit(simd, Watertight, w16, ray, filter),
            ],
        ));
        for hit in &hits {
            assert!(same_hit(hit, &hits[0]), "{ray:x?}: {hits:?}");
        }
        assert_eq!(hits.map(|hit| hit.is_hit()), any, "{ray:?}");
        hits[0]
    }

    /// A point of a random instance, in the world.
    fn target(&self, random: &mut Random) -> [f32; 3] {
        let instance = &self.instances[random.below(self.instances.len())];
        let mesh = &self.meshes[instance.bvh];
        let [a, b, c] = mesh
            .vertices(random.below(mesh.triangles.len()))
            .map(Vec3::from);
        let point = 0.3 * a + 0.3 * b + 0.4 * c;
        instance.object_to_world.transform_point3(point).to_array()
    }
}

fn same_hit(a: &InstanceHit, b: &InstanceHit) -> bool {
    same(&a.hit, &b.hit) && a.instance == b.instance
}

/// A triangle of the scene as `f64` has it met by a ray, and how far `f32` may err.
struct Meeting {
    t: f64,
    tolerance: f64,
    /// Whether the ray passes inside; unknown if that is within the roundings.
    inside: Option<bool>,
    front: bool,
    instance: usize,
    prim: usize,
}

fn meet(scene: &Scene, ray: &Ray, instance: usize, prim: usize) -> Option<Meeting> {
    let Instance {
        bvh,
        object_to_world,
    } = &scene.instances[instance];
    let [a, b, c] = scene.meshes[*bvh]
        .vertices(prim)
        .map(|vertex| DVec3::from(vertex.map(f64::from)));
    let linear = DMat3::from_cols_array(&object_to_world.matrix3.to_cols_array().map(f64::from));
    let translation = DVec3::from(object_to_world.translation.to_array().map(f64::from));
    let inverse = DAffine3::from_mat3_translation(linear, translation).inverse();
    let [org, dir] = [ray.org, ray.dir].map(|x| DVec3::from(x.map(f64::from)));
    let (o, d) = (
        inverse.transform_point3(org),
        inverse.transform_vector3(dir),
    );
    let normal = (b - a).cross(c - a);
    let slope = normal.dot(d);
    let t = normal.dot(a - o) / slope;
    let p = o + t * d;
    let weights = [(b, c), (c, a), (a, b)]
        .map(|(from, to)| (to - from).cross(p - from).dot(normal) / normal.length_squared());
    // How far the point at `t` may be from its place, and what that does.
    let magnitude = inverse.matrix3;
    let magnitude = DMat3::from_cols(
        magnitude.x_axis.abs(),
        magnitude.y_axis.abs(),
        magnitude.z_axis.abs(),
    );
    let path = (org - translation).abs() + t.abs() * dir.abs();
    let corner = a.abs().max(b.abs()).max(c.abs());
    let error = 16.0 * 2f64.powi(-24) * (magnitude * path + corner).length();
    let margins = [(b, c), (c, a), (a, b)]
        .map(|(from, to)| error * (to - from).cross(d).length() / slope.abs());
    let clearly = |outside: f64| {
        move |(weight, margin): (f64, f64)| outside * weight > margin && margin < 0.25
    };
    let mut pairs = weights.into_iter().zip(margins);
    let inside = if pairs.clone().all(clearly(1.0)) {
        Some(true)
    } else if pairs.any(clearly(-1.0)) {
        Some(false)
    } else {
        None
    };
    (t > 0.0).then_some(Meeting {
        t,
        tolerance: error * normal.length() / slope.abs(),
        inside,
        front: slope < 0.0,
        instance,
        prim,
    })
}

/// Holds a ray against `f64`, if that is sure of the answer. Returns whether it is.
fn check_in_world<F: HitFilter>(scene: &Scene, ray: &Ray, filter: &F, front_only: bool) -> bool {
    let mut meetings: Vec<Meeting> = (0..scene.instances.len())
        .flat_map(|instance| {
            let mesh = &scene.meshes[scene.instances[instance].bvh];
            (0..mesh.triangles.len()).filter_map(move |prim| meet(scene, ray, instance, prim))
        })
        .filter(|meeting| meeting.inside != Some(false) && (meeting.front || !front_only))
        .collect();
    meetings.sort_by(|a, b| a.t.total_cmp(&b.t));
    let hit = scene.closest(ray, filter);
    let Some(first) = meetings.first() else {
        assert!(!hit.is_hit(), "{ray:?}: {hit:?}");
        return true;
    };
    let behind = |other: &Meeting| other.t - other.tolerance > first.t + first.tolerance;
    if first.inside.is_none() || !meetings[1..].iter().all(behind) {
        return false;
    }
    assert_eq!(
        (hit.instance as usize, hit.hit.prim as usize),
        (first.instance, first.prim),
        "{ray:?}: {hit:?}"
    );
    let error = (f64::from(hit.hit.t) - first.t).abs();
    assert!(
        error <= first.tolerance,
        "{ray:?}: {hit:?}, {} ± {}",
        first.t,
        first.tolerance
    );
    true
}

fn rotation(random: &mut Random) -> Mat3 {
    let [x, y, z] = random.in_cube(1.0);
    let w = 2.0 * random.unit() - 1.0;
    Mat3::from_quat(Quat::from_xyzw(x, y, z, w).normalize())
}

/// Every kind of transform, by name.
fn transform(kind: &str, random: &mut Random) -> Affine3A {
    let spread = random
        .in_cube(4.0)
        .map(|x| x * if kind == "flat" { 20.0 } else { 1.0 });
    let mut place = Vec3::from(spread);
    let log = |random: &mut Random, range: f32| 10f32.powf(range * (2.0 * random.unit() - 1.0));
    let linear = match kind {
        "rigid" => rotation(random),
        "mirrored" => rotation(random) * Mat3::from_diagonal(Vec3::new(-1.0, 1.0, 1.0)),
        "sheared" => {
            let [a, b, c] = random.in_cube(3.0);
            let shear = Mat3::from_cols_array(&[1.0, 0.0, 0.0, a, 1.0, 0.0, b, c, 1.0]);
            rotation(random) * shear * rotation(random)
        }
        "scaled" => {
            let scale = Vec3::from([0; 3].map(|_| log(random, 3.0)));
            rotation(random) * Mat3::from_diagonal(scale)
        }
        "flat" => Mat3::from_diagonal(Vec3::new(10.0, 10.0, -1e-3)) * rotation(random),
        "far" => {
            place += Vec3::new(1e4, -1e4, 1e4);
            rotation(random)
        }
        _ => unreachable!("{kind}"),
    };
    Affine3A::from_mat3_translation(linear, place)
}

const KINDS: [&str; 6] = ["rigid", "mirrored", "sheared", "scaled", "flat", "far"];

fn scene(kinds: &[&str], count: usize, random: &mut Random) -> Scene {
    let meshes = vec![
        jittered_icosphere(0, random),
        soup(40, 0.5, random),
        soup(3, 1.0, random),
    ];
    let instances = (0..count)
        .map(|i| Instance {
            bvh: random.below(3),
            object_to_world: transform(kinds[i % kinds.len()], random),
        })
        .collect();
    Scene::new(meshes, instances)
}

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
            check_in_world(&scene, &ray, &FrontHits, true);
            sure += usize::from(check_in_world(&scene, &ray, &AllHits, false));
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
