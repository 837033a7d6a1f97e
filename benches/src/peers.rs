//! obvhs' own kernels, as a yardstick that needs nothing installed.
//!
//! CWBVH clamps `tmin` to 10⁻⁴, and neither is watertight.

use glam::Vec3A;
use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::ray::{Ray as ObvhsRay, RayHit};
use obvhs::rt_triangle::RtTriangle;
use obvhs::triangle::Triangle;
use residual_bvh::{Hit, Ray};

use crate::contender::Stream;
use crate::mesh::Mesh;

/// obvhs' binary hierarchy, built with its preset `very_slow_build`.
pub fn bvh2(mesh: &Mesh) -> Stream {
    let bvh = build_bvh2_from_tris(
        &triangles(mesh),
        BvhBuildParams::very_slow_build(),
        &mut Default::default(),
    );
    stream(mesh, bvh)
}

/// obvhs' compressed eight-wide hierarchy, built with its preset `very_slow_build`.
pub fn cwbvh(mesh: &Mesh) -> Stream {
    let bvh = build_cwbvh_from_tris(
        &triangles(mesh),
        BvhBuildParams::very_slow_build(),
        &mut Default::default(),
    );
    stream(mesh, bvh)
}

fn triangles(mesh: &Mesh) -> Vec<Triangle> {
    let corner = |vertex: u32| Vec3A::from(mesh.positions[vertex as usize]);
    let triangle = |&[a, b, c]: &[u32; 3]| Triangle {
        v0: corner(a),
        v1: corner(b),
        v2: corner(c),
    };
    mesh.triangles.iter().map(triangle).collect()
}

/// The two hierarchies' methods have the same names, but no trait.
trait Traverse: 'static {
    fn prim_ids(&self) -> &[u32];
    fn closest(&self, ray: ObvhsRay, hit: &mut RayHit, triangles: &[RtTriangle]);
    fn is_clear(&self, ray: ObvhsRay, triangles: &[RtTriangle]) -> bool;
}

macro_rules! implement_traverse {
    ($($bvh:ty)*) => {$(
        impl Traverse for $bvh {
            fn prim_ids(&self) -> &[u32] {
                &self.primitive_indices
            }
            #[inline(always)]
            fn closest(&self, ray: ObvhsRay, hit: &mut RayHit, triangles: &[RtTriangle]) {
                self.ray_traverse(ray, hit, |ray, index| triangles[index].intersect(ray));
            }
            #[inline(always)]
            fn is_clear(&self, ray: ObvhsRay, triangles: &[RtTriangle]) -> bool {
                self.ray_traverse_miss(ray, |ray, index| triangles[index].intersect(ray))
            }
        }
    )*};
}
implement_traverse!(Bvh2 CwBvh);

fn stream<B: Traverse>(mesh: &Mesh, bvh: B) -> Stream {
    let all = triangles(mesh);
    let in_order = bvh
        .prim_ids()
        .iter()
        .map(|&prim| (&all[prim as usize]).into());
    let shared = std::rc::Rc::new((in_order.collect::<Vec<RtTriangle>>(), bvh));
    let for_any = shared.clone();
    Stream::new(
        move |rays, hits| {
            let (triangles, bvh) = &*shared;
            for (ray, hit) in rays.iter().zip(hits) {
                let mut found = RayHit::none();
                bvh.closest(convert(ray), &mut found, triangles);
                *hit = match found.primitive_id {
                    u32::MAX => Hit::miss(ray.tmax),
                    index => Hit {
                        t: found.t,
                        u: 0.0,
                        v: 0.0,
                        prim: bvh.prim_ids()[index as usize],
                    },
                };
            }
        },
        move |rays, occluded| {
            let (triangles, bvh) = &*for_any;
            for (ray, occluded) in rays.iter().zip(occluded) {
                *occluded = !bvh.is_clear(convert(ray), triangles);
            }
        },
    )
}

#[inline(always)]
fn convert(ray: &Ray) -> ObvhsRay {
    ObvhsRay::new(ray.org.into(), ray.dir.into(), ray.tmin, ray.tmax)
}
