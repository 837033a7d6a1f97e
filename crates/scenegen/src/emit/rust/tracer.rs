//! The tracer of a scene as Rust, and the layers that it fills.

use std::fmt::{self, Write as _};

use residual_render::layer::Layers;
use residual_render::program::Structure;
use residual_render::tracer::TracerNode;

use super::layout::Code;

/// The constant with the layers.
pub(super) fn layers(out: &mut String, layers: Layers) -> fmt::Result {
    let names: Vec<_> = layers.iter().map(|layer| layer.name()).collect();
    let names = match names.is_empty() {
        true => "none".to_owned(),
        false => names.join(", "),
    };
    writeln!(
        out,
        "\n    /// The layers that are filled beside radiance: {names}."
    )?;
    writeln!(
        out,
        "    pub const LAYERS: Layers = Layers::from_bits({:#b});",
        layers.bits()
    )
}

/// The associated type of the tracer.
pub(super) fn associated_type(out: &mut String, structure: &Structure) -> fmt::Result {
    let name = name(structure.tracer);
    writeln!(out, "    type Tracer = {name}<D, {:?}>;", structure.sampler)
}

/// The methods that give the tracer and its layers.
pub(super) fn methods(out: &mut String, structure: &Structure) -> fmt::Result {
    let mut fields = vec![
        ("sampler", Code::word(format!("{:?}", structure.sampler))),
        ("settings", Code::word("settings")),
    ];
    if let TracerNode::Debug(view) = structure.tracer {
        fields.push(("view", Code::word(format!("DebugView::{view:?}"))));
    }
    let tracer = Code::literal(name(structure.tracer), fields).lines(8, 8, 0);
    writeln!(
        out,
        "    #[inline(always)]\n    fn tracer(&self, settings: Settings<D>) -> Self::Tracer {{\n        {tracer}\n    }}"
    )?;
    writeln!(
        out,
        "    #[inline(always)]\n    fn layers(&self) -> Layers {{\n        Self::LAYERS\n    }}"
    )
}

fn name(tracer: TracerNode) -> &'static str {
    match tracer {
        TracerNode::Path => "PathTracer",
        TracerNode::AmbientOcclusion => "AmbientOcclusion",
        TracerNode::Debug(_) => "Debug",
    }
}
