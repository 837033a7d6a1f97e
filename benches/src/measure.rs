//! The clock and the rounds.

use std::time::Duration;

use residual_bvh::Ray;

use crate::contender::Prepared;

/// What [`interleaved`] found out.
pub struct Measured {
    /// Of every contender (outer) in every round (inner).
    pub seconds: Vec<Vec<f64>>,
    /// How many rays hit something, for every contender.
    pub hits: Vec<usize>,
}

/// Rays that are traced between two looks at the clock: few enough to stay in the second-level cache, where a renderer
/// that works in tiles has them, too. Out of memory a call of `rtcIntersect1` that hits nothing takes twice as long.
pub const BATCH: usize = 2048;

/// Measures contenders. A round runs all of them once on all rays, each time beginning with another one; a first round,
/// which warms caches and pages, does not count.
pub fn interleaved(
    contenders: &mut [Box<dyn Prepared + '_>],
    rays: &[Ray],
    rounds: usize,
) -> Measured {
    let count = contenders.len();
    let mut seconds = vec![Vec::with_capacity(rounds); count];
    let mut hits = vec![0; count];
    for round in 0..=rounds {
        for turn in 0..count {
            let index = (round + turn) % count;
            let contender = &mut contenders[index];
            let mut time = Duration::ZERO;
            hits[index] = 0;
            for batch in rays.chunks(BATCH) {
                contender.load(batch);
                let start = thread_time();
                contender.run();
                time += thread_time() - start;
                hits[index] += contender.hits();
            }
            if round > 0 {
                seconds[index].push(time.as_secs_f64());
            }
        }
    }
    Measured { seconds, hits }
}

/// CPU time of this thread; wall-clock time where the system does not tell.
pub fn thread_time() -> Duration {
    #[cfg(unix)]
    {
        let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
        Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
    }
    #[cfg(not(unix))]
    {
        residual_frontend::process_time()
    }
}

/// CPU time of all processes that this one started and waited for, and of theirs; none where the system does not tell.
pub fn children_time() -> Option<Duration> {
    #[cfg(target_os = "linux")]
    {
        // proc_pid_stat(5): cutime and cstime are the fields 16 and 17; the second is a name, which may hold anything.
        let text = std::fs::read_to_string("/proc/self/stat").ok()?;
        let fields = text.rsplit_once(')')?.1.split_whitespace();
        let ticks: Vec<f64> = fields
            .skip(16 - 3)
            .take(2)
            .map(|field| field.parse().ok())
            .collect::<Option<_>>()?;
        let seconds = ticks.iter().sum::<f64>() / rustix::param::clock_ticks_per_second() as f64;
        Some(Duration::from_secs_f64(seconds))
    }
    #[cfg(not(target_os = "linux"))]
    {
        None
    }
}

/// Keeps the thread on the processor it is on, until dropped; does nothing where the system has no such call.
pub struct Pinned {
    #[cfg(target_os = "linux")]
    before: Option<rustix::thread::CpuSet>,
}

impl Pinned {
    /// Pins the calling thread.
    #[cfg(target_os = "linux")]
    pub fn new() -> Pinned {
        use rustix::thread::{CpuSet, sched_getaffinity, sched_getcpu, sched_setaffinity};
        let before = sched_getaffinity(None).ok();
        let mut one = CpuSet::new();
        one.set(sched_getcpu());
        // A container may forbid it; the measurement is then noisier, not wrong.
        let _ = sched_setaffinity(None, &one);
        Pinned { before }
    }

    /// Does nothing on this system.
    #[cfg(not(target_os = "linux"))]
    pub fn new() -> Pinned {
        Pinned {}
    }
}

impl Default for Pinned {
    fn default() -> Pinned {
        Pinned::new()
    }
}

#[cfg(target_os = "linux")]
impl Drop for Pinned {
    fn drop(&mut self) {
        if let Some(before) = &self.before {
            let _ = rustix::thread::sched_setaffinity(None, before);
        }
    }
}
