//! What the build script and the program have to agree on.

use residual_scenegen::plan::PlanOptions;

/// The scene.
pub(crate) const SCENE: &str =
    concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/cornell-box.gltf");

/// How it is planned.
pub(crate) fn plan_options() -> PlanOptions {
    PlanOptions {
        size: [256, 256],
        ..PlanOptions::default()
    }
}
