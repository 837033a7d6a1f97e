//! The GPU device: its samples have the processor's bits where the adapter computes as the processor does, and agree with
//! them in the mean elsewhere; what it runs is sound.
//!
//! Tests run on the adapter that renders by default. A software driver will do: `VK_DRIVER_FILES` names its JSON file. Without
//! any adapter they say so; what needs none is tested all the same.

mod arithmetic;
mod errors;
mod kernels;
mod meshes;
mod parity;
mod plain;
mod rays;
mod reads;
mod recorded;
mod subject;

use std::sync::OnceLock;

use residual_device_wgpu::{Error, Gpu, Probe};

/// The adapter of all tests, opened and probed once.
struct Machine {
    gpu: Gpu,
    probe: Probe,
}

/// The adapter; prints that the test is skipped where there is none.
fn machine() -> Option<&'static Machine> {
    static MACHINE: OnceLock<Option<Machine>> = OnceLock::new();
    let machine = MACHINE.get_or_init(|| match Gpu::open(None) {
        Ok(gpu) => {
            let probe = gpu.probe().unwrap_or_else(|error| panic!("{error}"));
            Some(Machine { gpu, probe })
        }
        Err(Error::NoAdapter) => None,
        Err(error) => panic!("{error}"),
    });
    if machine.is_none() {
        println!("skipped: no graphics adapter");
    }
    machine.as_ref()
}

/// The adapter, if it computes as the processor does; prints that the test is skipped where it does not.
fn exact_machine() -> Option<&'static Machine> {
    let machine = machine()?;
    let Machine { gpu, probe } = machine;
    if !probe.is_exact() {
        println!("skipped: {}: {}", gpu.adapter, probe.answers);
        return None;
    }
    Some(machine)
}
