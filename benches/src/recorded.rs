//! Rays of a real render, recorded on their way to the hierarchy: those that paths are followed by from surface to surface, and
//! those towards lights.

use std::ops::ControlFlow;
use std::sync::Mutex;

use anyhow::{Context, Result};
use residual_bvh::{Hit, Ray};
use residual_device_cpu::traversal::AlphaFilter;
use residual_device_cpu::{AnyBvh, CpuDevice, Interpreter, SceneView, Traversal, Width};
use residual_frontend::hierarchy_quality;
use residual_render::passes::RenderOptions;
use residual_scenegen::plan::{CullingRule, PlanOptions, plan};

use crate::rays::{RayKind, RaySet};
use crate::scene::Scene;

/// The rays of one sample of each pixel, by paths of at most 8 vertices: whole streams, spread over the render, until there are
/// about as many rays as pixels. Scenes that were not read from a file have none.
pub fn recorded_sets(scene: &Scene, size: [u32; 2]) -> Result<Vec<RaySet>> {
    let Some(description) = &scene.description else {
        return Ok(Vec::new());
    };
    let options = PlanOptions {
        size,
        culling: CullingRule::None,
        ..PlanOptions::default()
    };
    let plan = plan(description, &options).with_context(|| scene.name.clone())?;
    let quality = hierarchy_quality(plan.data.triangle_count());
    let recorder = Recorder {
        bvh: AnyBvh::build(&plan.data, Width::Native, quality),
        streams: Mutex::default(),
    };
    let interpreter = Interpreter::new(plan.structure.clone());
    let view = SceneView {
        buffers: plan.data.buffers(),
        traversal: &recorder,
    };
    let options = RenderOptions {
        size,
        samples: Some(1),
        max_depth: 8,
        ..RenderOptions::default()
    };
    // One thread, so that streams come in turns.
    CpuDevice::new(1)?.render(
        || &interpreter,
        &view,
        &options,
        |_| ControlFlow::Continue(()),
    );
    let streams = recorder.streams.into_inner().expect("no panic");
    let wanted = size[0] as usize * size[1] as usize;
    let set = |kind, streams: Vec<Vec<Ray>>| {
        let rays = thinned(streams, wanted);
        let hits = scene.reference.closest(&rays);
        RaySet {
            kind,
            hits: hits.iter().filter(|hit| hit.is_hit()).count(),
            rays,
        }
    };
    Ok(vec![
        set(RayKind::Bounce, streams.bounces),
        set(RayKind::Shadow, streams.shadows),
    ])
}

/// Every so many streams, so that about `wanted` rays are left.
fn thinned(streams: Vec<Vec<Ray>>, wanted: usize) -> Vec<Ray> {
    let all: usize = streams.iter().map(Vec::len).sum();
    let step = (all / wanted.max(1)).max(1);
    streams.into_iter().step_by(step).flatten().collect()
}

/// The streams of a render.
#[derive(Default)]
struct Streams {
    bounces: Vec<Vec<Ray>>,
    shadows: Vec<Vec<Ray>>,
    /// Whether camera rays come next: a device traces those that go on, then those that are new.
    camera_is_next: bool,
}

struct Recorder {
    bvh: AnyBvh,
    streams: Mutex<Streams>,
}

impl Traversal for Recorder {
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit], alpha: Option<&AlphaFilter<'_>>) {
        self.bvh.closest_hits(rays, hits, alpha);
        let mut streams = self.streams.lock().expect("no panic");
        if !streams.camera_is_next {
            streams.bounces.push(rays.to_vec());
        }
        streams.camera_is_next = !streams.camera_is_next;
    }

    fn any_hits(&self, rays: &[Ray], occluded: &mut [bool], alpha: Option<&AlphaFilter<'_>>) {
        self.bvh.any_hits(rays, occluded, alpha);
        let mut streams = self.streams.lock().expect("no panic");
        streams.shadows.push(rays.to_vec());
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn bounces_and_shadows_of_a_box() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/cornell-box.gltf");
        let scene = Scene::load(&path).expect("the scene of the repository");
        let sets = recorded_sets(&scene, [48, 48]).expect("a plan");
        let [bounces, shadows] = &sets[..] else {
            panic!("two kinds")
        };
        assert_eq!(bounces.kind, RayKind::Bounce);
        assert_eq!(shadows.kind, RayKind::Shadow);
        for set in &sets {
            assert!(set.rays.len() > 500 && set.rays.iter().all(Ray::is_valid));
            // None from the camera.
            let eye = scene.view.eye.to_array();
            assert!(set.rays.iter().all(|ray| ray.org != eye));
        }
        // Shadow rays end at lights, bounces where they meet something.
        assert!(shadows.rays.iter().all(|ray| ray.tmax.is_finite()));
        assert!(shadows.hits < shadows.rays.len());
        assert!(2 * bounces.hits > bounces.rays.len());
    }
}
