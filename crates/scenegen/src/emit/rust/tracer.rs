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
    writeln!(out, "\n    /// Layers beside radiance: {names}.")?;
    writeln!(
        out,
        "    pub const LAYERS: Layers = Layers::from_bits({:#b});",
        layers.bits()
    )
}

/// The associated type of the tracer.
pub(super) fn associated_type(out: &mut String, structure: &Structure) -> fmt::Result {
    let sampler = Code::word(format!("{:?}", structure.sampler));
    let tracer = Code::generic(name(structure.tracer), [Code::word("D"), sampler]);
    let tracer = match structure.layers {
        Layers::NONE => tracer,
        layers => {
            let layers = Code::word(format!("ConstLayers<{:#b}>", layers.bits()));
            Code::generic("Layered", [tracer, layers])
        }
    };
    let start = "    type Tracer = ";
    writeln!(out, "{start}{};", tracer.lines(4, start.len(), 1))
}

/// The method that gives the tracer.
pub(super) fn method(out: &mut String, structure: &Structure) -> fmt::Result {
    let mut fields = vec![
        ("sampler", Code::word(format!("{:?}", structure.sampler))),
        ("settings", Code::word("settings")),
    ];
    if let TracerNode::Debug(view) = structure.tracer {
        fields.push(("view", Code::word(format!("DebugView::{view:?}"))));
    }
    let tracer = Code::literal(name(structure.tracer), fields);
    let tracer = match structure.layers {
        Layers::NONE => tracer,
        _ => Code::literal(
            "Layered",
            [("tracer", tracer), ("layers", Code::word("ConstLayers"))],
        ),
    };
    writeln!(
        out,
        "    #[inline(always)]\n    fn tracer(&self, settings: Settings<D>) -> Self::Tracer {{\n        {}\n    }}",
        tracer.lines(8, 8, 0)
    )
}

fn name(tracer: TracerNode) -> &'static str {
    match tracer {
        TracerNode::Path => "PathTracer",
        TracerNode::AmbientOcclusion => "AmbientOcclusion",
        TracerNode::Debug(_) => "Debug",
    }
}
