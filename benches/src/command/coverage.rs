//! `cargo xtask bench coverage`: whether the stated error of a render is true.

use std::collections::BTreeSet;

use anyhow::{Context, Result};
use residual_scenegen::import::{ImportOptions, import};
use residual_scenegen::plan::{PlanOptions, plan};

use super::args::CoverageArgs;
use super::scenes::scenes_or_own;
use crate::coverage::{coverage, table};

pub(super) fn run(args: &CoverageArgs) -> Result<()> {
    let samples: Vec<u32> = BTreeSet::from_iter(args.spp.iter().copied())
        .into_iter()
        .collect();
    for path in scenes_or_own(&args.scene)? {
        let scene = import(&path, &ImportOptions::default())?;
        let options = PlanOptions {
            size: args.size.0,
            sampler: args.sampler,
            ..PlanOptions::default()
        };
        let plan = plan(&scene, &options).with_context(|| path.display().to_string())?;
        let progress = |done| {
            if done % 10 == 0 {
                eprintln!("{}: {done} of {} renders", plan.name, args.runs);
            }
        };
        let size = args.size.0;
        let rows = coverage(&plan, size, &samples, args.runs, args.threads, progress)?;
        if args.json {
            rows.iter().for_each(|row| println!("{}", row.to_json()));
        } else {
            println!(
                "{}, {} x {} pixels, {:?}, {} renders\n\n{}",
                plan.name,
                size[0],
                size[1],
                args.sampler,
                args.runs,
                table(&rows)
            );
        }
    }
    Ok(())
}
