//! A renderer's structure as WGSL: the functions of its formulas, and the kernels that call them.
//!
//! Every function is recorded from the formulas of `residual-render` (thesis, section 3.1): [`SceneFunctions`] has what a
//! structure calls for, [`Module`] the text around it. Written by hand are traversal and scheduling only (section 4.1), in
//! `wgsl/`; [`KernelSet`] has the kernels of a scene.
//!
//! Printed text keeps the contract of [`Domain`](residual_render::domain::Domain) as far as WGSL allows, and an
//! [`Arithmetic`] says how operations are spelled that adapters round differently.

mod arithmetic;
mod bindings;
mod calls;
mod functions;
mod hit_functions;
mod kernel_set;
mod kernels;
mod module;
mod names;
mod print;
mod rays_kernel;
mod recorded;
mod sections;
mod shade_kernel;

pub use arithmetic::{Arithmetic, Division, Fma, SquareRoot};
pub use bindings::Binding;
pub use functions::{ProgramFunctions, SceneFunctions};
pub use kernel_set::{KernelSet, KernelTexts, Mapping};
pub use kernels::{Kernels, STACK, Traits, WORKGROUP};
pub use module::Module;
pub use rays_kernel::rays_kernel;
pub use recorded::Recorded;

use residual_render::domain::tape::Function;
use residual_render::program::Structure;
use residual_render::tracer::PathOrigin;

/// The functions of a scene in one text: `emit`, for each program `program_K_step` and `_alpha_test`, and `miss`; where paths begin at
/// lights, too, those of theirs, named `light_emit` and so on. What the scene does not call for is not there.
pub fn scene_module(structure: &Structure) -> String {
    let mut module = Module::new(Arithmetic::default());
    add_functions(&mut module, structure, PathOrigin::Camera);
    if structure.tracer.has_light_paths() {
        module.heading("Paths from lights");
        add_functions(&mut module, structure, PathOrigin::Lights);
    }
    module.finish()
}

/// The functions of paths that begin at one end.
fn add_functions(module: &mut Module, structure: &Structure, origin: PathOrigin) {
    let functions = SceneFunctions::of(structure, origin);
    module.add(&functions.emit);
    for program in &functions.programs {
        module.heading(&program.description);
        for function in program.step.iter().chain(&program.alpha_test) {
            module.add(function);
        }
    }
    if let Some(miss) = &functions.miss {
        module.add(miss);
    }
}

/// One recorded function as a text of its own, several outputs in the structure `result`, with what it refers to.
pub fn function_module(function: &Function, result: &'static str) -> String {
    let mut module = Module::new(Arithmetic::default());
    let comment = function.name.replace('_', " ");
    module.add(&Recorded {
        function: function.clone(),
        result,
        comment,
    });
    module.finish()
}
