//! `cargo xtask bench coverage`: whether the stated error of a render is true.

use std::collections::BTreeSet;

use anyhow::{Context, Result, ensure};
use residual_render::film::TileRect;
use residual_scenegen::import::{ImportOptions, import};
use residual_scenegen::plan::{PlanOptions, plan};

use super::args::CoverageArgs;
use super::scenes::scenes_or_own;
use crate::coverage::{Subject, coverage, table};

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
        let whole = TileRect {
            x: 0,
            y: 0,
            width: size[0],
            height: size[1],
        };
        let is_within = |part: &TileRect| {
            part.x.saturating_add(part.width) <= size[0]
                && part.y.saturating_add(part.height) <= size[1]
        };
        ensure!(
            args.crop.iter().all(is_within),
            "--crop: not within {} x {} pixels",
            size[0],
            size[1]
        );
        let parts: Vec<_> = [whole].into_iter().chain(args.crop).collect();
        let subject = Subject {
            plan: &plan,
            size,
            sampling: args.sampling,
            parts: &parts,
        };
        let rows = coverage(&subject, &samples, args.runs, args.threads, progress)?;
        if args.json {
            rows.iter().for_each(|row| println!("{}", row.to_json()));
        } else {
            println!(
                "{}, {} x {} pixels, {:?}, {}, {} renders\n\n{}",
                plan.name,
                size[0],
                size[1],
                args.sampler,
                args.sampling,
                args.runs,
                table(&rows)
            );
        }
    }
    Ok(())
}
