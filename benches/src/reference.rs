//! The answers that contenders are checked against.

use residual_bvh::{AllHits, BuildQuality, Bvh, Hit, Kernel as _, Ray, Single, Watertight, build};

use crate::mesh::Mesh;

/// Nearest hits by a kernel that the other answers are compared with, and from which rays are made.
pub struct Reference(Bvh<8>);

impl Reference {
    /// Builds its hierarchy, quickly.
    pub fn new(mesh: &Mesh) -> Reference {
        Reference(build(
            &mesh.positions,
            &mesh.triangles,
            None,
            BuildQuality::Fast,
        ))
    }

    /// The nearest hits.
    pub fn closest(&self, rays: &[Ray]) -> Vec<Hit> {
        let mut hits = vec![Hit::miss(0.0); rays.len()];
        fearless_simd::dispatch!(fearless_simd::Level::new(), simd => Single.closest_hits(simd, Watertight, self.0.view(), rays, &mut hits, &AllHits));
        hits
    }
}
