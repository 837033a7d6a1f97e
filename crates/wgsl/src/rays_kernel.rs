//! Ray queries alone.

use crate::arithmetic::Arithmetic;
use crate::kernels::{STACK, TRAVERSAL, WORKGROUP};
use crate::module::Module;
use crate::sections::sections;

const RAYS: &str = include_str!("wgsl/rays.wgsl");

/// `trace_rays`: ray queries, apart from any scene.
pub fn rays_kernel(arithmetic: Arithmetic, f64: bool) -> String {
    let mut module = Module::new(arithmetic);
    module.add_text(&format!(
        "const WORKGROUP: u32 = {WORKGROUP}u;\nconst STACK: u32 = {STACK}u;\n"
    ));
    module.add_text(&sections(
        TRAVERSAL,
        &[if f64 { "f64" } else { "f32" }, "sided"],
    ));
    module.add_text(RAYS);
    module.finish()
}
