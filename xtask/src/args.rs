//! Arguments.

use std::ffi::OsString;
use std::path::PathBuf;
use std::str::FromStr;

use anyhow::{Result, ensure};
use clap::{Args, Parser, Subcommand};
use residual_device_cpu::LaneCount;
use residual_frontend::options::Size;
use residual_render::layer::{Layer, Layers};
use residual_render::tracer::TracerNode;
use residual_scenegen::plan::{Aperture, Focus, Optics};

use crate::choices::{
    CullingArg, DeviceArg, LightPlacesArg, LightsArg, MappingArg, MisArg, SamplerArg,
    SpecializeArg, StudioArg, TargetArg, TexturesArg, TierArg, TracerArg, ViewArg,
};
use crate::compare::args::CompareArgs;
use crate::numbers::finite;
use crate::time::TimeArgs;

/// Generates a renderer for a scene, and renders it.
#[derive(Parser)]
#[command(
    name = "cargo xtask",
    bin_name = "cargo xtask",
    version,
    arg_required_else_help = true
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Subcommand)]
pub(crate) enum Command {
    /// Render a scene to an image
    Render(RenderArgs),
    /// Show what a scene calls for, and the programs made for it
    Inspect(InspectArgs),
    /// Print the renderer that is generated for a scene
    Emit(EmitArgs),
    /// Make a program that renders one scene, and needs nothing else
    Build(BuildArgs),
    /// Compiled renderers that are kept
    #[command(subcommand)]
    Cache(CacheCommand),
    /// Compare two images
    Compare(CompareArgs),
    /// Measure what accuracy costs in time, and write a report
    #[command(disable_help_flag = true)]
    Accuracy(PassedOn),
    /// List the GPUs and what their arithmetic is like
    Adapters,
    /// Measure speed
    #[command(disable_help_flag = true)]
    Bench(PassedOn),
    /// Check the workspace as continuous integration does, but for the tests
    #[command(disable_help_flag = true)]
    Check(PassedOn),
}

/// Which scene, and how it is read.
#[derive(Args, Clone)]
pub(crate) struct SceneArgs {
    /// glTF (.gltf, .glb) or OBJ file
    #[arg(value_name = "SCENE")]
    pub(crate) scene: PathBuf,
    /// Environment image (.hdr, .exr, .png), latitude-longitude
    #[arg(long, value_name = "FILE")]
    pub(crate) env: Option<PathBuf>,
    /// Factor on the environment's radiance
    #[arg(long, value_name = "X", default_value_t = 1.0, requires = "env", allow_negative_numbers = true, value_parser = non_negative)]
    pub(crate) env_strength: f32,
    /// Turn of the environment about +Y
    #[arg(long, value_name = "DEGREES", default_value_t = 0.0, requires = "env", allow_negative_numbers = true, value_parser = finite::<f32>)]
    pub(crate) env_rotate: f32,
    /// Angle of the disc that a directional light of the scene is in the sky, from edge to edge: 0.526 is the sun's
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, value_parser = sun_angle)]
    pub(crate) sun_angle: Option<f32>,
    /// Radius of the spheres that point and spot lights of the scene are, in units of the scene
    #[arg(long, value_name = "X", allow_negative_numbers = true, value_parser = non_negative)]
    pub(crate) light_radius: Option<f32>,
    /// When a studio lights the scene: soft boxes before grey walls
    #[arg(long, value_enum, default_value_t = StudioArg::Auto)]
    pub(crate) studio: StudioArg,
    /// Add a checkered ground below the scene
    #[arg(long)]
    pub(crate) ground: bool,
    /// Show this set of a glTF file's materials (KHR_materials_variants)
    #[arg(long, value_name = "NAME")]
    pub(crate) variant: Option<String>,
    #[command(flatten)]
    pub(crate) time: TimeArgs,
    /// Fail where the scene cannot be rendered faithfully, instead of warning
    #[arg(long)]
    pub(crate) strict: bool,
    /// The scene's camera of this name or number
    #[arg(long, value_name = "NAME|INDEX", conflicts_with_all = ["eye", "dir", "up", "fov"])]
    pub(crate) camera: Option<String>,
    /// Place of the eye
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub(crate) eye: Option<Triple>,
    /// Direction of view
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub(crate) dir: Option<Direction>,
    /// Which way is up in the image
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub(crate) up: Option<Direction>,
    /// Vertical field of view
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, value_parser = field_of_view)]
    pub(crate) fov: Option<f32>,
    /// Depth of field: how far the lens is open, as an f-number of 35 mm film for scenes in metres, or as its diameter in
    /// units of the scene
    #[arg(
        long,
        value_name = "f/N|DIAMETER",
        allow_negative_numbers = true,
        conflicts_with = "panorama"
    )]
    pub(crate) aperture: Option<Aperture>,
    /// Distance at which all is sharp, in units of the scene; auto: that of what is in the middle of the image
    #[arg(
        long,
        value_name = "DISTANCE|auto",
        default_value = "auto",
        requires = "aperture",
        allow_negative_numbers = true
    )]
    pub(crate) focus: Focus,
    /// All directions around the eye, as a latitude-longitude image; best twice as wide as high
    #[arg(long, conflicts_with = "fov")]
    pub(crate) panorama: bool,
    /// Width and height of the image in pixels
    #[arg(long, value_name = "WxH", default_value = "640x480")]
    pub(crate) size: Size,
    /// Which surfaces are seen from behind
    #[arg(long, value_enum, default_value_t = CullingArg::Gltf)]
    pub(crate) culling: CullingArg,
    /// Where random numbers come from
    #[arg(long, value_enum, default_value_t = SamplerArg::Sobol)]
    pub(crate) sampler: SamplerArg,
    /// At which resolution colours are read from textures whose samplers ask for mipmaps
    #[arg(long, value_enum, default_value_t = TexturesArg::Full)]
    pub(crate) textures: TexturesArg,
    /// How often each light is picked
    #[arg(long, value_enum, default_value_t = LightsArg::Auto)]
    pub(crate) lights: LightsArg,
    /// Where on emitting triangles light samples lie
    #[arg(long, value_enum, default_value_t = LightPlacesArg::Auto)]
    pub(crate) light_places: LightPlacesArg,
    /// How --tracer path weighs light that is found by sampling lights and by following the BSDF [default: power]
    #[arg(long, value_enum)]
    pub(crate) mis: Option<MisArg>,
    /// What is computed along rays
    #[arg(long, value_enum, default_value_t = TracerArg::Path)]
    pub(crate) tracer: TracerArg,
    /// What --tracer debug shows [default: normals]
    #[arg(long, value_enum)]
    pub(crate) view: Option<ViewArg>,
    /// Layers of an EXR beside radiance, with commas between them: albedo, normal, depth, position, object_index,
    /// material_index, sample_count, variance, standard_error; crypto_object and crypto_material, ids of names (Cryptomatte)
    #[arg(long, value_name = "LAYER", value_delimiter = ',')]
    pub(crate) aov: Vec<Layer>,
    /// When a material's numbers are known to the compiler
    #[arg(long, value_enum, default_value_t = SpecializeArg::Structure)]
    pub(crate) specialize: SpecializeArg,
}

impl SceneArgs {
    /// What is computed along rays.
    pub(crate) fn tracer(&self) -> TracerNode {
        let view = self.view.unwrap_or(ViewArg::Normals);
        self.tracer.node(view, self.mis.unwrap_or(MisArg::Power))
    }

    /// Options that say something of a tracer are for that tracer.
    pub(crate) fn check_tracer(&self) -> Result<()> {
        ensure!(
            self.mis.is_none() || self.tracer == TracerArg::Path,
            "--mis: it is for --tracer path, whose light is found in two ways; leave it out"
        );
        ensure!(
            self.view.is_none() || self.tracer == TracerArg::Debug,
            "--view: it is for --tracer debug; add that, or leave it out"
        );
        Ok(())
    }

    /// What is put before the camera's eye.
    pub(crate) fn optics(&self) -> Optics {
        let focus = self.focus;
        match self.aperture {
            Some(aperture) => Optics::ThinLens { aperture, focus },
            None if self.panorama => Optics::Panorama,
            None => Optics::Projection,
        }
    }

    /// The layers of the image.
    pub(crate) fn layers(&self) -> Layers {
        self.aov.iter().copied().collect()
    }
}

#[derive(Args)]
pub(crate) struct RenderArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    #[command(flatten)]
    pub(crate) render: residual_frontend::options::RenderArgs,
    /// What renders
    #[arg(long, value_enum, default_value_t = DeviceArg::Cpu)]
    pub(crate) device: DeviceArg,
    /// How a GPU's work is divided into kernels
    #[arg(long, value_enum, default_value_t = MappingArg::Wavefront)]
    pub(crate) mapping: MappingArg,
    /// The GPU whose name contains this, or its number; cargo xtask adapters lists them [default: the fastest kind]
    #[arg(long, value_name = "NAME|INDEX")]
    pub(crate) adapter: Option<String>,
    /// How the renderer is made from the scene
    #[arg(long, value_enum, default_value_t = TierArg::Auto)]
    pub(crate) tier: TierArg,
    /// Paths that the compiled renderer shades at once: 1, 4, 8 or 16; the image does not depend on it [default: what
    /// suits the machine]
    #[arg(long, value_name = "N")]
    pub(crate) lanes: Option<LaneCount>,
}

#[derive(Args)]
pub(crate) struct InspectArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// One JSON object on standard output
    #[arg(long)]
    pub(crate) json: bool,
    /// Measure what each effect costs in time, and what the image would be without it
    #[arg(long)]
    pub(crate) measure: bool,
    /// Measured rounds
    #[arg(long, value_name = "N", default_value_t = 7, value_parser = clap::value_parser!(u32).range(2..=1000), requires = "measure")]
    pub(crate) rounds: u32,
    /// Samples per pixel in a round
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..), requires = "measure")]
    pub(crate) spp: u32,
    /// How the renderers are made that are compared
    #[arg(long, value_enum, default_value_t = TierArg::Specialized, requires = "measure")]
    pub(crate) tier: TierArg,
}

#[derive(Args)]
pub(crate) struct EmitArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// Language
    #[arg(long, value_enum)]
    pub(crate) target: TargetArg,
    /// Directory for the file; without it, standard output
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
    /// Paths shaded at once: 1, 4, 8 or 16 [default: what suits the machine]
    #[arg(long, value_name = "N")]
    pub(crate) lanes: Option<LaneCount>,
}

#[derive(Args)]
pub(crate) struct BuildArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// The program
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Build for this processor (x86-64-v3, …) instead of this machine's; the first time takes minutes
    #[arg(long, value_name = "CPU")]
    pub(crate) target_cpu: Option<String>,
    /// Paths shaded at once: 1, 4, 8 or 16 [default: what suits the machine, or 8 with --target-cpu]
    #[arg(long, value_name = "N")]
    pub(crate) lanes: Option<LaneCount>,
}

#[derive(Clone, Copy, Subcommand)]
pub(crate) enum CacheCommand {
    /// Show them
    List,
    /// Remove them
    Clear,
}

/// Arguments of a command that is a program of its own.
#[derive(Args)]
pub(crate) struct PassedOn {
    /// What is to be done; --help lists it
    #[arg(
        value_name = "ARGS",
        trailing_var_arg = true,
        allow_hyphen_values = true
    )]
    pub(crate) args: Vec<OsString>,
}

/// Three numbers with commas between them. In 64 bits, since scenes may lie far from the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Triple(pub(crate) [f64; 3]);

impl FromStr for Triple {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Vec<f64> = text
            .split(',')
            .map(|part| finite(part.trim()))
            .collect::<Result<_, _>>()?;
        let three = <[f64; 3]>::try_from(numbers);
        three
            .map(Self)
            .map_err(|_| "expected three numbers, as in 1,0.5,-2".to_owned())
    }
}

/// Three numbers that are not all zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Direction(pub(crate) [f64; 3]);

impl FromStr for Direction {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let Triple(numbers) = text.parse()?;
        match numbers == [0.0; 3] {
            true => Err("zero is no direction".to_owned()),
            false => Ok(Self(numbers)),
        }
    }
}

fn non_negative(text: &str) -> Result<f32, String> {
    let number: f32 = finite(text)?;
    if number >= 0.0 {
        Ok(number)
    } else {
        Err("expected a number that is not negative".to_owned())
    }
}

fn sun_angle(text: &str) -> Result<f32, String> {
    let degrees: f32 = finite(text)?;
    match (0.0..=180.0).contains(&degrees) {
        true => Ok(degrees),
        false => Err("expected an angle from 0 to 180 degrees".to_owned()),
    }
}

fn field_of_view(text: &str) -> Result<f32, String> {
    let degrees: f32 = finite(text)?;
    let fits = degrees > 0.0 && degrees < 180.0;
    if fits {
        Ok(degrees)
    } else {
        Err("expected an angle between 0 and 180 degrees".to_owned())
    }
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
    fn values_parse() {
        assert_eq!("1,-2.5, 3".parse(), Ok(Triple([1.0, -2.5, 3.0])));
        assert!("1,2".parse::<Triple>().is_err() && "1,2,nan".parse::<Triple>().is_err());
        assert!(
            "0,0,-0".parse::<Direction>().is_err() && "0,1e-300,0".parse::<Direction>().is_ok()
        );
        assert!(field_of_view("180").is_err());
        assert!(sun_angle("180").is_ok() && sun_angle("-1").is_err() && sun_angle("181").is_err());
    }
}
