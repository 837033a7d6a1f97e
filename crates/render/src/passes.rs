//! A render in passes: how many samples at a time, until when, whatever device takes them.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use residual_accuracy::{Convergence, Measured};

pub use crate::film::Pass;
use crate::film::{Film, SampleSet, Sampling};
use crate::tracer::{PathOrigin, TracerOptions};

/// Passes grow until one takes about this long, so that progress is shown, time limits are kept and a wish to stop is
/// heard.
const PASS_TIME: Duration = Duration::from_millis(250);
/// Most samples a pixel in one pass.
pub const MAX_PASS: u32 = 16;

/// What is to be rendered, and when to stop.
#[derive(Clone, Debug)]
pub struct RenderOptions {
    /// Width and height of the image in pixels.
    pub size: [u32; 2],
    /// Samples a pixel; `None` leaves the end to `time`.
    pub samples: Option<u32>,
    /// Stop after the pass in which this much time has gone by.
    pub time: Option<Duration>,
    /// Stop as soon as the relative error is below this one with 97.5 % confidence: the root of the relative mean squared
    /// error, as in 0.01 for 1 %.
    pub error: Option<f64>,
    /// How samples are spread over the image.
    pub sampling: Sampling,
    /// Most vertices a path may have; 1 is emission seen directly, 2 adds direct light.
    pub max_depth: u32,
    /// First vertex at which Russian roulette may end a path.
    pub roulette_from: u32,
    /// Seed of the random numbers.
    pub seed: u32,
    /// How far occluders count for ambient occlusion, and where the depth view turns black, in units of the scene.
    pub reach: f32,
}

impl Default for RenderOptions {
    /// 64 samples of 640 × 480 pixels, paths of at most 8 vertices.
    fn default() -> Self {
        Self {
            size: [640, 480],
            samples: Some(64),
            time: None,
            error: None,
            sampling: Sampling::Uniform,
            max_depth: 8,
            roulette_from: 2,
            seed: 0,
            reach: f32::MAX,
        }
    }
}

impl RenderOptions {
    /// What the tracer is told of the paths from the camera in a set of samples.
    pub fn tracer(&self, set: SampleSet) -> TracerOptions {
        TracerOptions {
            image: self.size,
            seed: set.seed(self.seed),
            max_depth: self.max_depth,
            roulette_from: self.roulette_from,
            reach: self.reach,
            origin: PathOrigin::Camera,
        }
    }
}

/// How far a render has come.
#[derive(Clone, Copy, Debug)]
pub struct Progress<'a> {
    /// Samples a pixel so far.
    pub samples: u32,
    /// Since the start of rendering.
    pub elapsed: Duration,
    /// The image so far.
    pub film: &'a Film,
    /// Its error after some of these samples, and how it falls.
    pub convergence: &'a Convergence,
}

/// What was done.
#[derive(Clone, Debug)]
pub struct RenderReport {
    /// Rays and stage times, over all passes.
    pub counters: Counters,
    /// Time on the clock.
    pub elapsed: Duration,
    /// The error on the way and at the end.
    pub convergence: Convergence,
}

/// What was done, and how long each stage took: thread seconds of processors, or seconds of a GPU.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Counters {
    /// Rays that begin paths: from the camera, or from lights.
    pub camera_rays: u64,
    /// Rays that continue paths.
    pub bounce_rays: u64,
    /// Rays towards lights; of light paths, towards the camera.
    pub shadow_rays: u64,
    /// Contributions of light paths to pixels.
    pub splats: u64,
    /// Seconds: making camera rays.
    pub emit: f64,
    /// Seconds: closest hits of camera rays.
    pub trace_camera: f64,
    /// Seconds: closest hits of continued paths.
    pub trace_bounce: f64,
    /// Seconds: occlusion, and adding what is not occluded.
    pub trace_shadow: f64,
    /// Seconds: sorting by program.
    pub sort: f64,
    /// Seconds: shading, and writing down the paths and shadow rays that go on, which compacts them.
    pub shade: f64,
    /// Seconds: adding samples to the film.
    pub film: f64,
}

impl Counters {
    /// The stages with their seconds (thesis, Figure 3.3).
    pub fn stages(&self) -> [(&'static str, f64); 7] {
        [
            ("emit", self.emit),
            ("trace_camera", self.trace_camera),
            ("trace_bounce", self.trace_bounce),
            ("trace_shadow", self.trace_shadow),
            ("sort", self.sort),
            ("shade", self.shade),
            ("film", self.film),
        ]
    }
}

impl Counters {
    /// Adds rays of another device, whose time is not this one's.
    pub fn count_rays_of(&mut self, o: &Self) {
        self.camera_rays += o.camera_rays;
        self.bounce_rays += o.bounce_rays;
        self.shadow_rays += o.shadow_rays;
        self.splats += o.splats;
    }
}

impl std::ops::AddAssign for Counters {
    fn add_assign(&mut self, o: Self) {
        self.count_rays_of(&o);
        self.emit += o.emit;
        self.trace_camera += o.trace_camera;
        self.trace_bounce += o.trace_bounce;
        self.trace_shadow += o.trace_shadow;
        self.sort += o.sort;
        self.shade += o.shade;
        self.film += o.film;
    }
}

/// Adds the film's error, if it has one.
fn measure(convergence: &mut Convergence, film: &Film, elapsed: Duration) {
    if let Some(error) = film.error() {
        convergence.add(Measured {
            samples: film.samples(),
            seconds: elapsed.as_secs_f64(),
            error,
        });
    }
}

/// Renders into a film until the options say stop. `pass` adds a pass of samples; it may fail, and the film is then what
/// there was before. `progress`, called after each pass, may break: the film is then what there is so far.
pub fn render_passes<E>(
    options: &RenderOptions,
    film: &mut Film,
    mut pass: impl FnMut(&mut Film, Pass) -> Result<Counters, E>,
    mut progress: impl FnMut(Progress<'_>) -> ControlFlow<()>,
) -> (RenderReport, Result<(), E>) {
    let start = Instant::now();
    let mut counters = Counters::default();
    let mut convergence = Convergence::default();
    let target = options.error.map(|error| error * error);
    let (mut done, mut size) = (0, 1);
    let mut outcome = Ok(());
    loop {
        let left = options
            .samples
            .map_or(u32::MAX, |samples| samples.saturating_sub(done));
        let late = options.time.is_some_and(|time| start.elapsed() >= time);
        let estimate = convergence.last().map(|last| last.error.relmse.high);
        let precise = target
            .zip(estimate)
            .is_some_and(|(target, high)| high <= target);
        if left == 0 || (late && done > 0) || precise {
            break;
        }
        let next = Pass {
            first: done,
            count: size.min(left),
        };
        let pass_start = Instant::now();
        match pass(film, next) {
            Ok(did) => counters += did,
            Err(error) => {
                outcome = Err(error);
                break;
            }
        }
        done += next.count;
        if convergence.is_due(u64::from(done), target) {
            measure(&mut convergence, film, start.elapsed());
        }
        let so_far = Progress {
            samples: done,
            elapsed: start.elapsed(),
            film,
            convergence: &convergence,
        };
        if progress(so_far).is_break() {
            break;
        }
        if pass_start.elapsed() < PASS_TIME {
            // To powers of two, at which well-distributed points are complete.
            size = done.min(MAX_PASS);
        }
    }
    let last = convergence.last().map_or(0, |last| last.samples);
    if film.samples() > last {
        measure(&mut convergence, film, start.elapsed());
    }
    let report = RenderReport {
        counters,
        elapsed: start.elapsed(),
        convergence,
    };
    (report, outcome)
}
