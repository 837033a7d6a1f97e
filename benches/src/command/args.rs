//! Arguments.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use residual_device_cpu::LaneCount;
use residual_frontend::options::Size;
use residual_render::film::{Sampling, TileRect};
use residual_render::sampler::AnySampler;

use crate::isa::Isa;
use crate::ours::{Kernel, Precision};
use crate::rays::RayKind;

/// Measures speed.
#[derive(Parser)]
#[command(
    name = "cargo xtask bench",
    bin_name = "cargo xtask bench",
    version,
    arg_required_else_help = true
)]
pub(super) struct Cli {
    #[command(subcommand)]
    pub(super) command: Command,
}

#[derive(Subcommand)]
pub(super) enum Command {
    /// Ray queries, beside Embree's (set RESIDUAL_EMBREE_LIB) and obvhs'
    Traversal(TraversalArgs),
    /// Whole renders: specialized and interpreted, with our traversal and with Embree's (set RESIDUAL_EMBREE_LIB)
    Render(RenderBenchArgs),
    /// Shading alone, per kind of program: specialized and interpreted, with constants and with textures
    Shading(ShadingArgs),
    /// How soon a scene's renderer is ready: planning, emission, compiling, and from the cache. And the size of our code
    Compile(CompileBenchArgs),
    /// How true the stated error of renders is: many short ones of different seeds, beside the mean of all
    Coverage(CoverageArgs),
    /// What accuracy costs: relative mean squared error and CPU seconds of renders, beside Mitsuba's (pip install mitsuba numpy)
    Error(ErrorArgs),
}

#[derive(Args)]
pub(super) struct ErrorArgs {
    /// glTF (.gltf, .glb) or OBJ file; may be given more than once [default: those in scenes/]
    #[arg(long, value_name = "FILE")]
    pub(super) scene: Vec<PathBuf>,
    /// Environment image (.hdr, .exr, .png), latitude-longitude; without one, scenes without a light stand in the studio
    #[arg(long, value_name = "FILE")]
    pub(super) env: Option<PathBuf>,
    /// One JSON object a line on standard output
    #[arg(long)]
    pub(super) json: bool,
    /// Images of each renderer, sampler and number of samples, each with its own seed
    #[arg(long, value_name = "N", default_value_t = 9, value_parser = clap::value_parser!(u32).range(3..=10_000))]
    pub(super) runs: u32,
    /// Samples per pixel, with commas between them; Mitsuba's samplers like 4, 16, 64, 256, …
    #[arg(long, value_name = "N", value_delimiter = ',', default_value = "16,64,256", value_parser = clap::value_parser!(u32).range(1..=65536))]
    pub(super) spp: Vec<u32>,
    /// Image size
    #[arg(long, value_name = "WxH", default_value = "256x256")]
    pub(super) size: Size,
    /// Most vertices of a path
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(super) max_depth: u32,
    /// Our tier
    #[arg(long, value_enum, default_value_t = TierArg::Specialized)]
    pub(super) tier: TierArg,
    /// Our samplers, with commas between them
    #[arg(long, value_name = "SAMPLER", value_delimiter = ',', default_value = "sobol,independent", value_parser = sampler)]
    pub(super) sampler: Vec<AnySampler>,
    /// How our samples are spread over the image, with commas between them: uniform, adaptive
    #[arg(
        long,
        value_name = "SAMPLING",
        value_delimiter = ',',
        default_value = "uniform"
    )]
    pub(super) sampling: Vec<Sampling>,
    /// Threads of each renderer; 0 is one for each processor
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(super) threads: usize,
    /// The renderer beside ours
    #[arg(long, value_enum, default_value_t = PeerArg::Mitsuba)]
    pub(super) peer: PeerArg,
    /// The Python that has Mitsuba
    #[arg(long, value_name = "PROGRAM", default_value = "python3")]
    pub(super) python: PathBuf,
    /// Mitsuba's variant [default: llvm_ad_rgb, or scalar_rgb without LLVM]
    #[arg(long, value_name = "NAME")]
    pub(super) variant: Option<String>,
    /// Folder for the converged images, as PNG and EXR
    #[arg(long, value_name = "FOLDER")]
    pub(super) pictures: Option<PathBuf>,
}

/// How we render.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum TierArg {
    /// Without a compiler
    Interpreted,
    /// Compiled before the first image
    Specialized,
}

impl TierArg {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Interpreted => "interpreted",
            Self::Specialized => "specialized",
        }
    }
}

/// Whom we are measured beside.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum PeerArg {
    /// Mitsuba 3, where Python has it
    Mitsuba,
    /// Nobody
    None,
}

#[derive(Args)]
pub(super) struct CoverageArgs {
    /// glTF (.gltf, .glb) or OBJ file; may be given more than once [default: those in scenes/]
    #[arg(long, value_name = "FILE")]
    pub(super) scene: Vec<PathBuf>,
    /// One JSON object a line on standard output
    #[arg(long)]
    pub(super) json: bool,
    /// Renders, each with its own seed
    #[arg(long, value_name = "N", default_value_t = 200, value_parser = clap::value_parser!(u32).range(3..=100_000))]
    pub(super) runs: u32,
    /// Samples per pixel at which the error is looked at, with commas between them
    #[arg(long, value_name = "N", value_delimiter = ',', default_value = "16,64,256", value_parser = clap::value_parser!(u32).range(4..=65536))]
    pub(super) spp: Vec<u32>,
    /// Image size
    #[arg(long, value_name = "WxH", default_value = "128x96")]
    pub(super) size: Size,
    /// Random numbers
    #[arg(long, value_name = "SAMPLER", default_value = "sobol", value_parser = sampler)]
    pub(super) sampler: AnySampler,
    /// How samples are spread over the image: uniform, adaptive
    #[arg(long, value_name = "SAMPLING", default_value_t = Sampling::Uniform)]
    pub(super) sampling: Sampling,
    /// Look at the error of this part of the image, too: left, top, width, height
    #[arg(long, value_name = "X,Y,W,H", value_parser = crop)]
    pub(super) crop: Option<TileRect>,
    /// Threads; 0 is one for each processor
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(super) threads: usize,
}

fn crop(text: &str) -> Result<TileRect, String> {
    let numbers: Option<Vec<u32>> = text
        .split(',')
        .map(|part| part.trim().parse().ok())
        .collect();
    match numbers.as_deref() {
        Some(&[x, y, width, height]) if width > 0 && height > 0 => Ok(TileRect {
            x,
            y,
            width,
            height,
        }),
        _ => Err("expected left, top, width and height in pixels, as in 32,16,64,48".to_owned()),
    }
}

fn sampler(name: &str) -> Result<AnySampler, String> {
    match name {
        "sobol" => Ok(AnySampler::Sobol),
        "independent" => Ok(AnySampler::Independent),
        _ => Err("there are sobol and independent".to_owned()),
    }
}

#[derive(Args)]
pub(super) struct CompileBenchArgs {
    /// glTF (.gltf, .glb) or OBJ file; may be given more than once [default: those in scenes/]
    #[arg(long, value_name = "FILE")]
    pub(super) scene: Vec<PathBuf>,
    /// One JSON object a line on standard output
    #[arg(long)]
    pub(super) json: bool,
    /// Measured rounds
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(super) rounds: u32,
}

#[derive(Args)]
pub(super) struct ShadingArgs {
    /// One JSON object a line on standard output
    #[arg(long)]
    pub(super) json: bool,
    /// Paths shaded at once, with commas between them
    #[arg(
        long,
        value_name = "N",
        value_delimiter = ',',
        default_value = "1,4,8,16"
    )]
    pub(super) lanes: Vec<LaneCount>,
    /// Measured rounds
    #[arg(long, value_name = "N", default_value_t = 15, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(super) rounds: u32,
}

#[derive(Args)]
pub(super) struct RenderBenchArgs {
    /// glTF (.gltf, .glb) or OBJ file; may be given more than once [default: those in scenes/]
    #[arg(long, value_name = "FILE")]
    pub(super) scene: Vec<PathBuf>,
    /// One JSON object a line on standard output
    #[arg(long)]
    pub(super) json: bool,
    /// Measured rounds
    #[arg(long, value_name = "N", default_value_t = 7, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(super) rounds: u32,
    /// Samples per pixel in a round
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..))]
    pub(super) spp: u32,
    /// Width and height of the image
    #[arg(long, value_name = "WxH", default_value = "512x512")]
    pub(super) size: Size,
    /// Most vertices of a path
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(super) max_depth: u32,
    /// Threads; 0 is one for each processor
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(super) threads: usize,
    /// Paths shaded at once, with commas between them [default: what suits the machine]
    #[arg(long, value_name = "N", value_delimiter = ',')]
    pub(super) lanes: Vec<LaneCount>,
}

#[derive(Args)]
pub(super) struct TraversalArgs {
    /// glTF (.gltf, .glb) or OBJ file; may be given more than once [default: those in scenes/]
    #[arg(long, value_name = "FILE")]
    pub(super) scene: Vec<PathBuf>,
    /// One JSON object a line on standard output
    #[arg(long)]
    pub(super) json: bool,
    /// Measured rounds [default: 11]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(super) rounds: Option<u32>,
    /// Width and height of the image of primary rays [default: 512x512]
    #[arg(long, value_name = "WxH")]
    pub(super) size: Option<Size>,
    /// Our kernels, with commas between them
    #[arg(long, value_enum, value_delimiter = ',')]
    pub(super) kernel: Vec<Kernel>,
    /// Our node widths, with commas between them
    #[arg(long, value_name = "N", value_delimiter = ',')]
    pub(super) width: Vec<usize>,
    /// Our precisions, with commas between them
    #[arg(long, value_enum, value_delimiter = ',')]
    pub(super) precision: Vec<Precision>,
    /// Kinds of rays, with commas between them
    #[arg(long, value_enum, value_delimiter = ',')]
    pub(super) rays: Vec<RayKind>,
    /// Instruction set; Embree is limited to the same [default: the one this program was built for]
    #[arg(long, value_enum)]
    pub(super) isa: Option<Isa>,
    /// 3 rounds of 256x256 without obvhs and builds, which --kernel and --width leave out, too
    #[arg(long)]
    pub(super) quick: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_are_consistent() {
        use clap::CommandFactory;
        Cli::command().debug_assert();
    }
}
