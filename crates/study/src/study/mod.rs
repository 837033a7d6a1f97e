//! A study: everything that is to be measured, and is not in the journal yet, is measured.
//!
//! Round by round all configurations are rendered with one seed, each round beginning with another, so that what drifts (clock rates,
//! temperature, other programs) drifts for all.

mod options;

use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use residual_accuracy::luminance;
use residual_accuracy::sweep::{FailureRate, Measurement};
use residual_device_cpu::CpuDevice;
use residual_frontend::input;
use residual_frontend::pictures::{self, Picture};
use residual_scenegen::desc::SceneDesc;
use residual_scenegen::plan::{CullingRule, PlanOptions, plan};
use serde_json::{Value, json};

pub use options::StudyOptions;

use self::options::configurations;
use crate::configuration::Configuration;
use crate::findings::{Crop, Measured, Provenance, Study, equal_time_samples};
use crate::journal::Journal;
use crate::measure;
use crate::prepared::{Preparation, Prepared};
use crate::probe::misses::Target;
use crate::probe::sums::Sums;
use crate::provenance;
use crate::reference::{REFERENCE_DEPTH, Reference, ReferenceOptions, STRATEGIES};
use residual_variants::TraversalPrecision;

/// How far a study has come.
#[derive(Clone, Debug)]
pub enum Step {
    /// Something starts that takes its time.
    Begins(String),
    /// A number of samples a pixel were rendered, of all that are to be rendered.
    Rendered {
        /// So far, with what the journal had.
        samples: u64,
        /// In all, as far as it is known.
        of: u64,
    },
}

/// A hash as text.
fn key(of: impl Hash) -> String {
    let mut hasher = DefaultHasher::new();
    of.hash(&mut hasher);
    format!("{:016x}", hasher.finish())
}

/// Measures what is missing, and gives all that was measured.
///
/// # Errors
/// If the scene cannot be planned, a renderer not be compiled, a file not be read or written, or an image is not finite.
pub fn run(
    scene: &SceneDesc,
    options: &StudyOptions,
    mut report: impl FnMut(Step),
) -> Result<Study> {
    fs::create_dir_all(options.folder.join("images"))
        .with_context(|| format!("making the folder {}", options.folder.display()))?;
    let baseline = options.baseline();
    let planned = plan(scene, &baseline.plan)?;
    let structure = format!("{:?}", planned.structure);
    let ReferenceOptions { seeds, samples } = options.reference;
    let strategies: Vec<&str> = STRATEGIES.iter().map(|strategy| strategy.name).collect();
    let reference_key = key((
        planned.data.to_bytes(),
        structure,
        options.size,
        [REFERENCE_DEPTH, seeds, samples],
        strategies,
    ));
    let tier = format!("{:?}", options.tier);
    let study_key = key((&reference_key, &options.counts, options.threads, tier));
    let mut work = Work {
        journal: Journal::open(&options.folder.join("journal.jsonl"), study_key)?,
        options,
        preparation: Preparation::new(scene),
        done: 0,
        report: &mut report,
    };
    let reference = work.reference(&reference_key)?;
    let mean = reference
        .image
        .iter()
        .map(|rgb| luminance(*rgb))
        .sum::<f64>()
        / reference.image.len() as f64;
    let device = CpuDevice::new(options.threads).context("starting threads")?;
    let measured = work.rounds(&device, &reference, mean)?;
    let misses = work.misses(scene)?;
    let sums = work.sums(mean)?;
    let crops = work.crops(&device, &reference, mean, &measured)?;
    let provenance = work.provenance();
    Ok(Study {
        scene: planned.name.clone(),
        triangles: planned.data.triangle_count(),
        threads: device.threads(),
        tier: options.tier,
        seeds: (1..=options.seeds).collect(),
        reference,
        measured,
        misses,
        sums,
        crops,
        provenance,
    })
}

struct Work<'a, R> {
    journal: Journal,
    options: &'a StudyOptions,
    preparation: Preparation<'a>,
    done: u64,
    report: &'a mut R,
}

impl<R: FnMut(Step)> Work<'_, R> {
    fn advance(&mut self, samples: u64) {
        self.done += samples;
        let (samples, of) = (self.done, self.options.work());
        (self.report)(Step::Rendered { samples, of });
    }

    fn reference(&mut self, key: &str) -> Result<Reference> {
        let path = self.options.folder.join("reference.exr");
        let ReferenceOptions { seeds, samples } = self.options.reference;
        if let Some(reference) = Reference::load(&path, key)? {
            self.advance(u64::from(seeds * samples) * STRATEGIES.len() as u64);
            return Ok(reference);
        }
        (self.report)(Step::Begins("reference".to_owned()));
        let prepared = STRATEGIES
            .iter()
            .map(|strategy| {
                let mut setup = self.options.baseline();
                setup.render.max_depth = REFERENCE_DEPTH;
                (strategy.change)(&mut setup);
                Ok((strategy.name, self.preparation.prepare(&setup, 0.0)?))
            })
            .collect::<Result<Vec<_>>>()?;
        let strategies: Vec<_> = prepared.iter().map(|(name, p)| (*name, p)).collect();
        let all = CpuDevice::new(0).context("starting threads")?;
        let options = self.options;
        let reference =
            Reference::render(&strategies, &all, options.size, options.reference, || {
                self.advance(u64::from(samples));
            });
        reference.store(&path, key)?;
        Ok(reference)
    }

    /// All runs, from the journal or rendered.
    fn rounds(
        &mut self,
        device: &CpuDevice,
        reference: &Reference,
        mean: f64,
    ) -> Result<Vec<Measured>> {
        let options = self.options;
        let chosen: Vec<_> = configurations(options).collect();
        let mut measured: Vec<Measured> = chosen.iter().map(|c| Measured::none(c)).collect();
        let mut prepared: Vec<Option<Prepared>> = chosen.iter().map(|_| None).collect();
        for seed in 1..=options.seeds {
            for turn in 0..chosen.len() {
                let index = (seed as usize + turn) % chosen.len();
                let configuration = chosen[index];
                let (runs, image) = match self.recorded(configuration, seed, reference.size) {
                    Some(run) => run,
                    None => {
                        if prepared[index].is_none() {
                            let name = configuration.name;
                            (self.report)(Step::Begins(name.to_owned()));
                            let setup = options.setup(configuration);
                            let ready = self.preparation.prepare(&setup, mean)?;
                            // Caches are warmed before anything is measured.
                            ready.render(device, 0, &options.counts[..1], |_| {});
                            prepared[index] = Some(ready);
                        }
                        let ready = prepared[index].as_ref().expect("it was just made");
                        let run = measure::run(ready, device, seed, &options.counts, reference)
                            .with_context(|| configuration.name.to_owned())?;
                        store(
                            &self.image_path(configuration, seed),
                            reference.size,
                            &run.image,
                        )?;
                        self.record(
                            &run_name(configuration, seed),
                            json!({
                                "measured": measure::to_json(&run.measured),
                            }),
                        )?;
                        (run.measured, run.image)
                    }
                };
                measured[index].runs.push(runs);
                measured[index].images.push(image);
                self.advance(u64::from(options.most_samples()));
            }
        }
        Ok(measured)
    }

    fn recorded(
        &self,
        configuration: &Configuration,
        seed: u32,
        size: [usize; 2],
    ) -> Option<(Vec<Measurement>, Vec<[f32; 3]>)> {
        let entry = self.journal.get(&run_name(configuration, seed))?;
        let run = measure::from_json(&entry["measured"])?;
        let image = input::read(&self.image_path(configuration, seed)).ok()?;
        (image.size == size).then_some((run, image.pixels))
    }

    fn image_path(&self, configuration: &Configuration, seed: u32) -> PathBuf {
        let name = format!("{}-{seed}.exr", configuration.name);
        self.options.folder.join("images").join(name)
    }

    /// Adds an entry, with where and when it was measured.
    fn record(&mut self, name: &str, mut entry: Value) -> Result<()> {
        entry["machine"] = provenance::machine().into();
        entry["commit"] = provenance::commit().into();
        self.journal.add(name, entry)
    }

    fn misses(&mut self, scene: &SceneDesc) -> Result<Vec<(TraversalPrecision, FailureRate)>> {
        let rays = self.options.aimed_rays;
        let mut target = None;
        let mut found = Vec::new();
        for precision in [
            TraversalPrecision::Fast,
            TraversalPrecision::Watertight,
            TraversalPrecision::Exact,
        ] {
            let name = format!("{rays} aimed rays {precision:?}");
            if self.journal.get(&name).is_none() {
                let target = match &target {
                    Some(target) => target,
                    None => {
                        (self.report)(Step::Begins("rays aimed at edges".to_owned()));
                        let two_sided = PlanOptions {
                            culling: CullingRule::None,
                            ..self.options.baseline().plan
                        };
                        target.insert(Target::new(&plan(scene, &two_sided)?.data))
                    }
                };
                let rate = target.misses(precision, rays);
                let counts = rate.map(|rate| json!([rate.failures, rate.trials]));
                self.record(&name, json!({ "failures": counts }))?;
            }
            let counts = &self.journal.get(&name).expect("it was just added")["failures"];
            if let (Some(failures), Some(trials)) = (counts[0].as_u64(), counts[1].as_u64()) {
                found.push((precision, FailureRate { failures, trials }));
            }
        }
        Ok(found)
    }

    fn sums(&mut self, mean: f64) -> Result<Option<Sums>> {
        if self.journal.get("sums").is_none() {
            (self.report)(Step::Begins("sums".to_owned()));
            let prepared = self.preparation.prepare(&self.options.baseline(), mean)?;
            let sums = Sums::of(&prepared.samples(64));
            self.record("sums", json!({ "sums": sums.map(|sums| sums.to_json()) }))?;
        }
        let entry = self.journal.get("sums").expect("it was just added");
        Ok(Sums::from_json(&entry["sums"]))
    }

    /// Images of all configurations after the same time.
    fn crops(
        &mut self,
        device: &CpuDevice,
        reference: &Reference,
        mean: f64,
        measured: &[Measured],
    ) -> Result<Vec<Crop>> {
        let mut crops = Vec::new();
        for (measured, samples) in measured.iter().zip(equal_time_samples(measured)) {
            let configuration = measured.configuration;
            let name = format!("crop {} {samples}", configuration.name);
            let path = self.options.folder.join("images");
            let path = path.join(format!("{}-equal-time.exr", configuration.name));
            let recorded = self
                .journal
                .get(&name)
                .map(|entry| entry["seconds"].as_f64());
            let image = input::read(&path)
                .ok()
                .filter(|image| image.size == reference.size);
            let (seconds, image) = match (recorded.flatten(), image) {
                (Some(seconds), Some(image)) => (seconds, image.pixels),
                _ => {
                    (self.report)(Step::Begins(format!(
                        "{} at equal time",
                        configuration.name
                    )));
                    let setup = self.options.setup(configuration);
                    let prepared = self.preparation.prepare(&setup, mean)?;
                    let (mut seconds, mut image) = (0.0, Vec::new());
                    prepared.render(device, self.options.seeds + 1, &[samples], |so_far| {
                        (seconds, image) = (so_far.seconds, so_far.film.image());
                    });
                    store(&path, reference.size, &image)?;
                    self.record(&name, json!({ "seconds": seconds }))?;
                    (seconds, image)
                }
            };
            crops.push(Crop {
                configuration,
                samples,
                seconds,
                error: measure::error(reference, &image)?,
                image,
            });
        }
        Ok(crops)
    }

    /// Machines and commits of all that was measured.
    fn provenance(&self) -> Provenance {
        let all = |field: &str| {
            let values = self
                .journal
                .entries()
                .filter_map(|entry| entry[field].as_str());
            let set: std::collections::BTreeSet<&str> = values.collect();
            set.into_iter().map(str::to_owned).collect()
        };
        Provenance {
            machines: all("machine"),
            commits: all("commit"),
        }
    }
}

fn run_name(configuration: &Configuration, seed: u32) -> String {
    format!("run {} {seed}", configuration.name)
}

fn store(path: &Path, size: [usize; 2], image: &[[f32; 3]]) -> Result<()> {
    let channel = |k: usize| image.iter().map(|rgb| rgb[k]).collect();
    let picture = Picture {
        size,
        colors: Vec::new(),
        channels: vec![("R", channel(0)), ("G", channel(1)), ("B", channel(2))],
        comment: None,
    };
    pictures::write(path, &picture)
}
