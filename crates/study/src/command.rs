//! The command line: `cargo xtask accuracy` has cargo build and run it.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result};
use clap::{Parser, ValueEnum};
use indicatif::ProgressBar;
use residual_frontend::options::Size;
use residual_frontend::progress::bar_of;
use residual_frontend::{note, out};
use residual_scenegen::import::{ImportOptions, import};
use residual_scenegen::plan::CameraChoice;

use crate::configuration::{Extent, Tier};
use crate::findings::Findings;
use crate::reference::ReferenceOptions;
use crate::report;
use crate::study::{self, Step, StudyOptions};

/// Measures what accuracy costs in time, and writes a report.
///
/// A study that is stopped goes on where it was when it is started again with the same arguments.
#[derive(Parser)]
#[command(
    name = "cargo xtask accuracy",
    bin_name = "cargo xtask accuracy",
    version
)]
struct Cli {
    /// glTF (.gltf, .glb) or OBJ file
    #[arg(value_name = "SCENE")]
    scene: PathBuf,
    /// Folder for the report and for all that was measured [default: accuracy-SCENE]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Two minutes: a small image, few samples and seeds, and the configurations that matter most
    #[arg(long)]
    quick: bool,
    /// Width and height of the image in pixels [default: 192x144, or 96x72 with --quick]
    #[arg(long, value_name = "WxH")]
    size: Option<Size>,
    /// Runs of each configuration, each with its own seed [default: 15, or 8 with --quick]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(3..=1000))]
    seeds: Option<u32>,
    /// Samples per pixel at the end of a run, a power of two [default: 256, or 64 with --quick]
    #[arg(long, value_name = "N", value_parser = samples)]
    spp: Option<u32>,
    /// Samples per pixel of the reference, in units of those of a run [default: 64, or 32 with --quick]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(4..=4096))]
    reference: Option<u32>,
    /// The scene's camera of this name or number
    #[arg(long, value_name = "NAME|INDEX")]
    camera: Option<String>,
    /// How renderers are made
    #[arg(long, value_enum, default_value_t = TierArg::Specialized)]
    tier: TierArg,
    /// Threads of the measured runs; 0 is one for each processor. The reference has all
    #[arg(long, value_name = "N", default_value_t = 1)]
    threads: usize,
    /// No progress
    #[arg(short, long)]
    quiet: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum TierArg {
    /// Without a compiler
    Interpreted,
    /// Compiled for the scene
    Specialized,
}

fn samples(text: &str) -> Result<u32, String> {
    let number = text.parse::<u32>().ok();
    let fits = |n: &u32| n.is_power_of_two() && (4..=65_536).contains(n);
    number
        .filter(fits)
        .ok_or_else(|| "expected a power of two from 4 to 65536".to_owned())
}

/// Seeds of each strategy of a reference.
const REFERENCE_SEEDS: u32 = 8;

impl Cli {
    fn folder(&self) -> PathBuf {
        self.output.clone().unwrap_or_else(|| {
            let mut name = std::ffi::OsString::from("accuracy-");
            name.push(self.scene.file_stem().unwrap_or_default());
            PathBuf::from(name)
        })
    }

    fn options(&self) -> StudyOptions {
        let (extent, size, seeds, most, reference, aimed_rays) = match self.quick {
            true => (Extent::Quick, [96, 72], 8, 64, 32, 1_000_000),
            false => (Extent::Full, [192, 144], 15, 256, 64, 10_000_000),
        };
        let most = self.spp.unwrap_or(most);
        let reference = self.reference.unwrap_or(reference);
        let strategies = crate::reference::STRATEGIES.len() as u32;
        StudyOptions {
            folder: self.folder(),
            size: self.size.map_or(size, |size| size.0),
            camera: match &self.camera {
                Some(name) => CameraChoice::Named(name.clone()),
                None => CameraChoice::Default,
            },
            seeds: self.seeds.unwrap_or(seeds),
            counts: (0..=most.trailing_zeros())
                .map(|power| 1 << power)
                .collect(),
            reference: ReferenceOptions {
                seeds: REFERENCE_SEEDS,
                samples: (reference * most).div_ceil(REFERENCE_SEEDS * strategies),
            },
            extent,
            tier: match self.tier {
                TierArg::Interpreted => Tier::Interpreted,
                TierArg::Specialized => Tier::Specialized,
            },
            threads: self.threads,
            aimed_rays,
        }
    }
}

/// The command line: status 0, 1 for a failed job, 2 for bad usage.
pub fn main() -> ExitCode {
    // Bad usage ends in clap, with status 2.
    match run(&Cli::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            note!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(args: &Cli) -> Result<()> {
    let folder = args.folder();
    let scene = import(&args.scene, &ImportOptions::default())?;
    for warning in &scene.warnings {
        note!(
            "warning: {}: {}: {}",
            args.scene.display(),
            warning.place,
            warning.message
        );
    }
    let bar = if args.quiet {
        ProgressBar::hidden()
    } else {
        bar_of(1)
    };
    let study = study::run(&scene, &args.options(), |step| match step {
        Step::Begins(what) => bar.set_message(what),
        Step::Rendered { samples, of } => {
            bar.set_length(of);
            bar.set_position(samples);
        }
    })
    .with_context(|| args.scene.display().to_string())?;
    bar.finish_and_clear();
    report::write(&folder, &study, &Findings::of(&study)?)?;
    for agreement in &study.reference.agreements {
        if !agreement.holds() {
            let [first, second] = &agreement.between;
            note!("warning: {first} and {second} disagree about the reference");
        }
    }
    out!("{}", folder.join(report::FILES[0]).display());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_are_consistent() {
        use clap::CommandFactory;
        Cli::command().debug_assert();
    }

    #[test]
    fn references_have_more_samples_than_runs() {
        let cli = Cli::parse_from(["accuracy", "a.glb", "--quick", "--spp", "16"]);
        let options = cli.options();
        assert_eq!(options.counts, [1, 2, 4, 8, 16]);
        let ReferenceOptions { seeds, samples } = options.reference;
        assert_eq!(2 * seeds * samples, 32 * 16);
        assert!(Cli::try_parse_from(["accuracy", "a.glb", "--spp", "5"]).is_err());
    }
}
