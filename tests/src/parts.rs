//! Tracing without a hierarchy of the scene, to compare with.

use residual_bvh::{BuildQuality, Bvh, Culling, Hit, HitFilter, MarkedHits, Ray, build};
use residual_device_cpu::Traversal;
use residual_device_cpu::traversal::AlphaFilter;
use residual_render::scene_data::SceneData;

/// Triangles in parts, in the order of their numbers. Every ray is traced against every part by itself.
pub struct Parts {
    parts: Vec<Bvh<2, 1>>,
    /// Triangles of each but the last.
    length: usize,
}

impl Parts {
    /// Most parts. If there are no more triangles, tracing is brute force; if there are, tests cannot wait for it.
    pub const MOST: usize = 32;

    /// Cuts up a scene's triangles.
    pub fn new(data: &SceneData) -> Self {
        let (positions, triangles) = (data.positions(), data.triangles());
        let length = triangles.len().div_ceil(Self::MOST).max(1);
        let part = |(triangles, sides): (&[_], _)| {
            build(&positions, triangles, Some(sides), BuildQuality::Fast)
        };
        let sides = data.single_sided.chunks(length);
        Self {
            parts: triangles.chunks(length).zip(sides).map(part).collect(),
            length,
        }
    }

    /// Parts with the number of their first triangle.
    fn parts(&self) -> impl Iterator<Item = (u32, &Bvh<2, 1>)> {
        let firsts = (0..).step_by(self.length);
        firsts.zip(&self.parts)
    }
}

/// The hit as one of the whole scene.
fn of_scene(first: u32, hit: &Hit) -> Hit {
    Hit {
        prim: first + hit.prim,
        ..*hit
    }
}

/// What alpha leaves of a part.
struct Covered<'a> {
    first: u32,
    alpha: &'a AlphaFilter<'a>,
}

impl HitFilter for Covered<'_> {
    const CULLING: Culling = Culling::PerTriangle;
    const REJECTS: bool = true;

    fn accept(&self, ray: &Ray, hit: &Hit) -> bool {
        (self.alpha)(ray, &of_scene(self.first, hit))
    }
}

impl Traversal for Parts {
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit], alpha: Option<&AlphaFilter<'_>>) {
        for (ray, nearest) in rays.iter().zip(hits) {
            *nearest = Hit::miss(ray.tmax);
            for (first, part) in self.parts() {
                let hit = match alpha {
                    Some(alpha) => part.closest_hit_filtered(ray, &Covered { first, alpha }),
                    None => part.closest_hit_filtered(ray, &MarkedHits),
                };
                // Of several at the same distance the smallest number, that is the first, stays.
                if hit.is_hit() && (!nearest.is_hit() || hit.t < nearest.t) {
                    *nearest = of_scene(first, &hit);
                }
            }
        }
    }

    fn any_hits(&self, rays: &[Ray], occluded: &mut [bool], alpha: Option<&AlphaFilter<'_>>) {
        for (ray, occluded) in rays.iter().zip(occluded) {
            *occluded = self.parts().any(|(first, part)| match alpha {
                Some(alpha) => part.any_hit_filtered(ray, &Covered { first, alpha }),
                None => part.any_hit_filtered(ray, &MarkedHits),
            });
        }
    }
}
