//! `cargo xtask build`: a program that renders one scene, with the scene's data in it.

use anyhow::{Result, ensure};
use residual_driver::standalone::{self, StandaloneOptions};
use residual_frontend::note;
use residual_frontend::output::{check_place, write_executable};
use residual_frontend::stats::mib;

use crate::args::BuildArgs;
use crate::scene;
use crate::time::Exposure;

pub(crate) fn run(args: &BuildArgs) -> Result<()> {
    check_place(&args.output)?;
    let (plan, _) = scene::load(&args.scene, Exposure::default())?;
    ensure!(
        plan.motion.is_none(),
        "--shutter: a program has the scene at one moment in it; leave --shutter out, or use cargo xtask render"
    );
    let options = StandaloneOptions {
        size: args.scene.size.0,
        lanes: args.lanes,
        target_cpu: args.target_cpu.clone(),
    };
    let program = standalone::build(&plan, &options)?;
    write_executable(&args.output, &program.executable)?;
    note!(
        "{}: {:.1} MiB, of which {:.1} MiB are the scene's data",
        args.output.display(),
        mib(program.executable.len()),
        mib(program.data_bytes)
    );
    Ok(())
}
