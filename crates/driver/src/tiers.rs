//! Tiers: interpreted from the first second, compiled as soon as the compiler is done.

use std::cell::RefCell;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use anyhow::{Result, bail};
use residual_device_cpu::plugin::LoadedRenderer;
use residual_device_cpu::{Interpreter, LaneCount, TileRenderer};
use residual_frontend::process_time;
use residual_frontend::stats::TierReport;
use residual_render::passes::Progress;
use residual_scenegen::plan::Plan;

use crate::compile::{Compiler, Origin};

/// A compiled renderer, or why there is none, and how long that took.
struct Compilation {
    result: Result<(LoadedRenderer, Origin)>,
    time: Duration,
}

/// The renderers of a scene. One thread calls [`Tiers::compile`], another renders and asks [`Tiers::choose`].
pub struct Tiers<'a> {
    plan: &'a Plan,
    lanes: LaneCount,
    interpreter: Interpreter,
    compiler: Compiler,
    compilation: OnceLock<Compilation>,
}

/// What the tiers did, as far as it is known between passes.
#[derive(Default)]
pub struct Ledger(RefCell<Entries>);

#[derive(Default)]
struct Entries {
    /// Samples a pixel so far, and CPU time when the pass under way began.
    samples: u32,
    began: Duration,
    is_compiled: bool,
    compiled_from: Option<u32>,
    interpreted: Work,
    specialized: Work,
}

/// Samples a pixel, and the CPU time that they took.
#[derive(Clone, Copy, Default)]
struct Work {
    samples: u32,
    cpu: Duration,
}

impl Work {
    fn seconds_per_sample(self) -> Option<f64> {
        (self.samples > 0).then(|| self.cpu.as_secs_f64() / f64::from(self.samples))
    }
}

impl<'a> Tiers<'a> {
    /// The interpreter is ready; nothing is compiled yet.
    pub fn new(plan: &'a Plan, lanes: LaneCount) -> Self {
        Self {
            plan,
            lanes,
            interpreter: Interpreter::new(plan.structure.clone()),
            compiler: Compiler::default(),
            compilation: OnceLock::new(),
        }
    }

    /// Compiles. Runs beside everything else.
    pub fn compile(&self) {
        self.compilation.get_or_init(|| {
            let start = Instant::now();
            let result = self.compiler.compile(self.plan, self.lanes);
            let time = start.elapsed();
            Compilation { result, time }
        });
    }

    /// To be called when [`Tiers::compile`] has returned, where nothing is to be interpreted.
    ///
    /// # Errors
    /// If compilation has failed.
    pub fn expect_compiled(&self) -> Result<()> {
        match self.compilation.get() {
            Some(Compilation {
                result: Err(error), ..
            }) => bail!("{error:#}"),
            _ => Ok(()),
        }
    }

    /// The renderer of the next pass.
    pub fn choose(&self, ledger: &Ledger) -> &dyn TileRenderer {
        let mut entries = ledger.0.borrow_mut();
        entries.began = process_time();
        match self.compilation.get() {
            Some(Compilation {
                result: Ok((renderer, _)),
                ..
            }) => {
                entries.is_compiled = true;
                let samples = entries.samples;
                entries.compiled_from.get_or_insert(samples);
                renderer
            }
            _ => &self.interpreter,
        }
    }

    /// To be called when rendering is over: a compiler that still runs comes too late, and one that failed is told of.
    pub fn end(&self) {
        if self.compilation.get().is_none() {
            self.compiler.give_up();
        }
    }

    /// How long compiling took, as far as it went.
    pub fn compile_time(&self) -> Duration {
        let compilation = self.compilation.get();
        compilation.map_or(Duration::ZERO, |compilation| compilation.time)
    }

    /// Why there is no compiled renderer, if the compiler is to blame.
    pub fn failure(&self) -> Option<&anyhow::Error> {
        let error = self.compilation.get()?.result.as_ref().err();
        error.filter(|_| !self.compiler.was_given_up())
    }

    /// What was used, and when compiling paid for itself on so many threads.
    pub fn report(&self, ledger: &Ledger, threads: usize) -> TierReport {
        let entries = ledger.0.borrow();
        TierReport {
            tier: match entries.compiled_from {
                Some(_) => "specialized",
                None => "interpreted",
            },
            compiled_from: entries.compiled_from,
            break_even: entries.break_even(self.compile_time(), threads),
        }
    }
}

impl Ledger {
    /// To be called after each pass.
    pub fn add(&self, progress: &Progress<'_>) {
        let mut entries = self.0.borrow_mut();
        let work = Work {
            samples: progress.samples - entries.samples,
            cpu: process_time() - entries.began,
        };
        entries.samples = progress.samples;
        let sum = match entries.is_compiled {
            true => &mut entries.specialized,
            false => &mut entries.interpreted,
        };
        sum.samples += work.samples;
        sum.cpu += work.cpu;
    }
}

impl Entries {
    /// Samples a pixel after which the time that compiling took is saved: none where only one tier was at work, or
    /// nothing is saved.
    fn break_even(&self, compile: Duration, threads: usize) -> Option<f64> {
        let interpreted = self.interpreted.seconds_per_sample()?;
        let saved = interpreted - self.specialized.seconds_per_sample()?;
        let samples = compile.as_secs_f64() * threads as f64 / saved;
        (saved > 0.0).then_some(samples)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn compiling_pays_after_what_it_took_over_what_it_saves() {
        let work = |samples, seconds| Work {
            samples,
            cpu: Duration::from_secs(seconds),
        };
        let entries = |interpreted, specialized| Entries {
            interpreted,
            specialized,
            ..Entries::default()
        };
        let break_even = |entries: Entries| entries.break_even(Duration::from_secs(6), 2);
        // 3 s a sample against 1 s, on two threads: 6 s of both are saved after 6 samples.
        assert_eq!(break_even(entries(work(2, 6), work(4, 4))), Some(6.0));
        assert_eq!(break_even(entries(work(2, 6), work(4, 12))), None);
        assert_eq!(break_even(entries(work(0, 0), work(4, 12))), None);
        assert_eq!(break_even(entries(work(4, 12), work(0, 0))), None);
    }
}
