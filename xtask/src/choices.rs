//! What arguments choose among.

use clap::ValueEnum;
use residual_render::tracer::{AnyMis, AnySharing, DebugView, TracerNode};

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum CullingArg {
    /// Single-sided surfaces are seen, block and emit from their front only
    Gltf,
    /// Both sides of every surface block light
    None,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum StudioArg {
    /// Where the scene has no lamp
    Auto,
    /// Whatever lights it has
    Always,
    /// Not at all
    Never,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ShutterPositionArg {
    /// It opens at the moment
    Start,
    /// The moment is in the middle
    Center,
    /// It closes at the moment
    End,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum SamplerArg {
    /// Owen-scrambled Sobol points
    Sobol,
    /// Independent random numbers
    Independent,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum TexturesArg {
    /// At that of their images
    Full,
    /// At that of what is seen through a pixel, or by way of another surface
    Filtered,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum LightsArg {
    /// From a tree where there are many and it pays, mixed elsewhere
    Auto,
    /// Half of the picks by power, half evenly by kind
    Mixed,
    /// By power
    Power,
    /// Each as often as any other
    Uniform,
    /// From a tree, by what may arrive at the point
    Tree,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum LightPlacesArg {
    /// By solid angle where triangles are so near that it pays, by area elsewhere
    Auto,
    /// Evenly by area
    Area,
    /// Evenly by solid angle
    SolidAngle,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum MisArg {
    /// By the power heuristic
    Power,
    /// By the balance heuristic
    Balance,
    /// By sampling lights alone, where it can find them: for comparison
    Lights,
    /// By following the BSDF alone, where it can find them: for comparison
    Bsdf,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum TracerArg {
    /// Light along paths from the camera
    Path,
    /// Light along paths from both ends: caustics
    Bidirectional,
    /// Light along paths from lights alone: for comparison
    Light,
    /// Ambient occlusion: how open the surroundings are within --reach
    Ao,
    /// What --view says of what is seen first
    Debug,
}

impl TracerArg {
    /// The tracer, with what a debug picture shows.
    pub(crate) fn node(self, view: ViewArg, mis: MisArg) -> TracerNode {
        match self {
            Self::Path => TracerNode::Path(match mis {
                MisArg::Power => AnyMis::PowerHeuristic,
                MisArg::Balance => AnyMis::BalanceHeuristic,
                MisArg::Lights => AnyMis::LightsOnly,
                MisArg::Bsdf => AnyMis::BsdfOnly,
            }),
            Self::Bidirectional => TracerNode::Bidirectional(AnySharing::Combined),
            Self::Light => TracerNode::Bidirectional(AnySharing::LightPathsOnly),
            Self::Ao => TracerNode::AmbientOcclusion,
            Self::Debug => TracerNode::Debug(match view {
                ViewArg::Normals => DebugView::Normals,
                ViewArg::Uv => DebugView::TextureCoordinates,
                ViewArg::Programs => DebugView::Programs,
                ViewArg::Depth => DebugView::Depth,
                ViewArg::Cost => DebugView::TraversalCost,
            }),
        }
    }
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ViewArg {
    /// Shading normals
    Normals,
    /// Texture coordinates
    Uv,
    /// A colour for each material program
    Programs,
    /// Distance from the eye, up to --reach
    Depth,
    /// Nodes and triangles that rays visit, as a heat map
    Cost,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum SpecializeArg {
    /// 0 and 1 are constants, other numbers parameters
    Structure,
    /// All numbers are constants
    Constants,
    /// Nothing is compiled: as --tier interpreted
    None,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum TierArg {
    /// Start interpreted, swap to the compiled renderer when it is ready
    Auto,
    /// Without a compiler
    Interpreted,
    /// Compiled before the first ray
    Specialized,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum DeviceArg {
    /// The processor
    Cpu,
    /// A GPU, or a software driver for one
    Wgpu,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum MappingArg {
    /// A kernel for each kind of work, between which paths wait in queues
    Wavefront,
    /// One kernel, in which a thread follows a path to its end
    Megakernel,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum TargetArg {
    /// A module for the CPU device
    Rust,
    /// Functions for a GPU device
    Wgsl,
}
