//! Adapters are held to the suite that says what every operation of a domain gives.

use residual_device_wgpu::{Dialect, Gpu, Mode, Question, list_adapters};
use residual_wgsl::Arithmetic;

use crate::machine;

/// A probe at the start asks few questions; the whole suite must not say otherwise. Of adapters whose probe is not exact, it is
/// reported what they get wrong.
#[test]
fn the_probe_speaks_for_the_whole_suite() {
    let Some(machine) = machine() else {
        return;
    };
    let all = machine
        .gpu
        .ask(&Question::all(), machine.probe.dialect)
        .unwrap_or_else(|error| panic!("{error}"));
    println!(
        "{}, {:?}: {all}",
        machine.gpu.adapter, machine.probe.dialect
    );
    assert!(all.tallies().iter().all(|tally| tally.asked > 0));
    if machine.probe.is_exact() {
        assert!(all.are_exact(), "{all}");
    } else {
        println!("skipped: the adapter is not exact");
    }
}

/// A software driver runs on the processor, and is to compute as it does: what else is tested here rests on it.
#[test]
fn software_drivers_are_exact() {
    let mut found = false;
    for adapter in list_adapters() {
        let probe = Gpu::open(Some(&adapter.name)).and_then(|gpu| gpu.probe());
        let probe = probe.unwrap_or_else(|error| panic!("{adapter}: {error}"));
        println!("{adapter}: {:?}: {}", probe.dialect, probe.answers);
        if adapter.is_software() {
            found = true;
            assert!(probe.is_exact(), "{adapter}: {}", probe.answers);
        }
    }
    if !found {
        println!("skipped: no software driver");
    }
}

/// The questions can be answered wrongly: compilers that may contract do so, and are found out. An adapter that does not is
/// reported.
#[test]
fn liberties_are_found_out() {
    let Some(machine) = machine() else {
        return;
    };
    let plain = Dialect {
        mode: Mode::Plain,
        arithmetic: Arithmetic::default(),
    };
    let answers = machine
        .gpu
        .ask(&Question::all(), plain)
        .unwrap_or_else(|error| panic!("{error}"));
    println!("{}, plain WGSL: {answers}", machine.gpu.adapter);
    let wrong = answers.tallies().iter().filter(|tally| tally.wrong > 0);
    if machine.gpu.adapter.name.contains("llvmpipe") {
        assert!(wrong.count() > 0, "llvmpipe reassociates");
    }
    for tally in answers.tallies() {
        assert!(tally.wrong <= tally.asked, "{tally:?}");
    }
}
