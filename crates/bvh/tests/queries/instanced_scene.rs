//! Scenes of instances, and what `f64` says about them in the world's space.

use fearless_simd::{Level, dispatch};
use glam::{Affine3A, DAffine3, DMat3, DVec3, Mat3, Quat, Vec3};
use residual_bvh::{
    AllHits, BuildQuality, Bvh, Culling, HitFilter, Instance, InstanceHit, InstancedBvh, Ray,
    Watertight, any_instance_hit, build, closest_instance_hit,
};

use crate::mesh::{Mesh, jittered_icosphere, soup};
use crate::random::Random;
use crate::runner::same;

/// One scene in hierarchies of several widths.
pub(crate) struct Scene {
    pub(crate) meshes: Vec<Mesh>,
    pub(crate) instances: Vec<Instance>,
    pub(crate) w2: InstancedBvh<2, 4>,
    pub(crate) w8: InstancedBvh<8>,
    pub(crate) w16: InstancedBvh<16, 8>,
}

pub(crate) fn instanced<const N: usize, const P: usize>(
    meshes: &[Mesh],
    instances: &[Instance],
) -> InstancedBvh<N, P> {
    InstancedBvh::new(meshes.iter().map(object).collect(), instances).expect("sound transforms")
}

pub(crate) fn object<const N: usize, const P: usize>(mesh: &Mesh) -> Bvh<N, P> {
    build(&mesh.positions, &mesh.triangles, None, BuildQuality::Medium)
}

pub(crate) fn closest(bvh: &InstancedBvh<8>, ray: &Ray) -> InstanceHit {
    dispatch!(Level::new(), simd => closest_instance_hit(simd, Watertight, bvh, ray, &AllHits))
}

impl Scene {
    pub(crate) fn new(meshes: Vec<Mesh>, instances: Vec<Instance>) -> Scene {
        Scene {
            w2: instanced(&meshes, &instances),
            w8: instanced(&meshes, &instances),
            w16: instanced(&meshes, &instances),
            meshes,
            instances,
        }
    }

    /// Every width's and query's answer, which must be the same.
    pub(crate) fn closest<F: HitFilter>(&self, ray: &Ray, filter: &F) -> InstanceHit {
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
    pub(crate) fn target(&self, random: &mut Random) -> [f32; 3] {
        let instance = &self.instances[random.below(self.instances.len())];
        let mesh = &self.meshes[instance.bvh];
        let [a, b, c] = mesh
            .vertices(random.below(mesh.triangles.len()))
            .map(Vec3::from);
        let point = 0.3 * a + 0.3 * b + 0.4 * c;
        instance.object_to_world.transform_point3(point).to_array()
    }
}

pub(crate) fn same_hit(a: &InstanceHit, b: &InstanceHit) -> bool {
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
pub(crate) fn check_in_world<F: HitFilter>(scene: &Scene, ray: &Ray, filter: &F) -> bool {
    let front_only = matches!(F::CULLING, Culling::Back);
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
pub(crate) fn transform(kind: &str, random: &mut Random) -> Affine3A {
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

pub(crate) const KINDS: [&str; 6] = ["rigid", "mirrored", "sheared", "scaled", "flat", "far"];

pub(crate) fn scene(kinds: &[&str], count: usize, random: &mut Random) -> Scene {
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
