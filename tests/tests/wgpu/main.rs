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
use std::sync::atomic::{AtomicUsize, Ordering};

use residual_device_wgpu::{Error, Gpu, Mapping, Probe};

const MAPPINGS: [Mapping; 2] = [Mapping::Wavefront, Mapping::Megakernel];

/// The adapter of all tests, opened and probed.
struct Machine {
    gpu: Gpu,
    probe: Probe,
}

impl Machine {
    /// Of scenes that are much alike, every `step`-th is enough: software drivers take seconds to compile the kernels of each.
    fn step(&self) -> usize {
        if self.gpu.adapter.is_software() { 4 } else { 1 }
    }

    /// Scenes of more programs are left to other adapters: software drivers take minutes to compile theirs.
    fn most_programs(&self) -> usize {
        match self.gpu.adapter.is_software() {
            true => 10,
            false => usize::MAX,
        }
    }

    /// The mappings with which one of many scenes is rendered: the steps of paths are the same in both, so that software drivers
    /// have every eighth in both.
    fn mappings(&self, index: usize) -> &'static [Mapping] {
        let step = if self.gpu.adapter.is_software() { 8 } else { 1 };
        if index.is_multiple_of(step) {
            &MAPPINGS
        } else {
            &[Mapping::Wavefront]
        }
    }
}

/// The adapter; prints that the test is skipped where there is none.
fn machine() -> Option<&'static Machine> {
    // A device does one thing at a time, and compiling kernels is what software drivers do most: two of them, in turns.
    static MACHINES: [OnceLock<Option<Machine>>; 2] = [const { OnceLock::new() }; 2];
    static NEXT: AtomicUsize = AtomicUsize::new(0);
    let next = NEXT.fetch_add(1, Ordering::Relaxed) % MACHINES.len();
    let machine = MACHINES[next].get_or_init(|| match Gpu::open(None) {
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
