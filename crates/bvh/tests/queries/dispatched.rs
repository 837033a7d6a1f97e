//! The methods that need no knowledge of SIMD give the kernels' answers.

use glam::{Affine3A, Vec3};
use residual_bvh::{
    AllHits, BuildQuality, Bvh, FrontHits, HasKernels, Hit, Instance, InstanceHit, InstancedBvh,
    Ray, build,
};

use crate::mesh::{Mesh, soup};
use crate::oracle::closest_hit_of_all;
use crate::random::Random;
use crate::runner::{aimed, same, trials};

fn agree<const N: usize, const P: usize>(mesh: &Mesh, rays: &[Ray])
where
    Bvh<N, P>: HasKernels<N, P>,
{
    let bvh: Bvh<N, P> = build(&mesh.positions, &mesh.triangles, None, BuildQuality::Medium);
    let mut hits = vec![Hit::miss(0.0); rays.len()];
    let mut occluded = vec![false; rays.len()];
    bvh.closest_hits(rays, &mut hits);
    bvh.any_hits(rays, &mut occluded);
    for ((ray, hit), &occluded) in rays.iter().zip(&hits).zip(&occluded) {
        let expected = closest_hit_of_all(mesh, ray, &AllHits);
        assert!(same(hit, &expected), "{ray:?}: {hit:?}, {expected:?}");
        assert!(same(&bvh.closest_hit(ray), &expected));
        assert_eq!((occluded, bvh.any_hit(ray)), (hit.is_hit(), hit.is_hit()));
        let expected = closest_hit_of_all(mesh, ray, &FrontHits);
        assert!(same(&bvh.closest_hit_filtered(ray, &FrontHits), &expected));
        assert_eq!(bvh.any_hit_filtered(ray, &FrontHits), expected.is_hit());
    }
    let count = occluded.iter().filter(|&&is| is).count();
    assert!(count > rays.len() / 4, "{count} of {}", rays.len());

    let away = Instance {
        bvh: 0,
        object_to_world: Affine3A::from_translation(Vec3::splat(100.0)),
    };
    let here = Instance {
        object_to_world: Affine3A::IDENTITY,
        ..away
    };
    let scene = InstancedBvh::new(vec![bvh], &[away, here]).expect("sound transforms");
    let mut answers = vec![InstanceHit::miss(0.0); rays.len()];
    scene.closest_hits(rays, &mut answers);
    scene.any_hits(rays, &mut occluded);
    for (ray, answer) in rays.iter().zip(&answers) {
        assert_eq!(*answer, scene.closest_hit(ray));
    }
    for ((answer, hit), &occluded) in answers.iter().zip(&hits).zip(&occluded) {
        assert!(same(&answer.hit, hit) || answer.instance == 0);
        assert_eq!(occluded, answer.is_hit());
    }
}

#[test]
fn methods_agree_with_kernels() {
    let mut random = Random::new(110);
    let mesh = soup(300, 0.3, &mut random);
    let rays: Vec<Ray> = (0..trials(2000))
        .map(|_| aimed(random.in_cube(2.0), mesh.edge_point(&mut random)))
        .collect();
    agree::<2, 1>(&mesh, &rays);
    agree::<4, 4>(&mesh, &rays);
    agree::<8, 8>(&mesh, &rays);
    agree::<16, 4>(&mesh, &rays);
}

#[test]
#[should_panic(expected = "a hit for each ray")]
fn hits_must_be_as_many_as_rays() {
    let bvh: Bvh<8> = build(&[], &[], None, BuildQuality::Fast);
    bvh.closest_hits(&[aimed([0.0; 3], [1.0; 3])], &mut []);
}
