//! `cargo xtask bench shading`: what shading takes per kind of program, specialised and interpreted.

use crate::measure::Pinned;
use crate::shading::table::{interface_table, kind_table};
use crate::shading::{plan, shading};
use anyhow::Result;
use residual_device_cpu::TileRenderer;
use residual_driver::compile;

use super::args::ShadingArgs;

pub(super) fn run(args: &ShadingArgs) -> Result<()> {
    let plan = plan();
    let compiled = args
        .lanes
        .iter()
        .map(|&lanes| Ok((lanes, compile(&plan, lanes)?)))
        .collect::<Result<Vec<_>>>()?;
    let renderers: Vec<_> = compiled
        .iter()
        .map(|(lanes, renderer)| (*lanes, renderer as &dyn TileRenderer))
        .collect();
    let _pinned = Pinned::new();
    let (kinds, interfaces) = shading(&plan, &renderers, args.rounds as usize);
    if args.json {
        kinds.iter().for_each(|row| println!("{}", row.to_json()));
        interfaces
            .iter()
            .for_each(|row| println!("{}", row.to_json()));
    } else {
        println!("{}\n{}", kind_table(&kinds), interface_table(&interfaces));
    }
    Ok(())
}
