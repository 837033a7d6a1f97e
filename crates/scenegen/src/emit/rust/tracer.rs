//! The tracer of a scene as Rust, and the layers that it fills.

use std::fmt::{self, Write as _};

use residual_render::layer::Layers;
use residual_render::program::Structure;
use residual_render::tracer::{AnyMis, TracerNode};

use super::layout::{Code, Name};
use super::module::Module;

/// The constant with the layers.
pub(super) fn layers(out: &mut Module, layers: Layers) -> fmt::Result {
    out.import("layer", &["Layers"]);
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

fn sampler(structure: &Structure) -> Code {
    Code::Word(Name::of("sampler", format!("{:?}", structure.sampler)))
}

fn weights(mis: AnyMis) -> Code {
    Code::Word(Name::of("tracer", format!("{mis:?}")))
}

/// The associated type of the tracer.
pub(super) fn associated_type(out: &mut Module, structure: &Structure) -> fmt::Result {
    let mut parameters = vec![Code::word("D"), sampler(structure)];
    if let TracerNode::Path(mis) = structure.tracer {
        parameters.push(weights(mis));
    }
    let mut tracer = Code::generic(name(structure.tracer), parameters);
    if structure.between.absorption {
        tracer = Code::generic(Name::of("tracer", "Absorbing"), [tracer]);
    }
    if structure.between.dispersion {
        let parameters = [tracer, sampler(structure)];
        tracer = Code::generic(Name::of("tracer", "Dispersing"), parameters);
    }
    let tracer = match structure.layers {
        Layers::NONE => tracer,
        layers => {
            let layers = format!("ConstLayers<{:#b}>", layers.bits());
            let layers = Code::Word(Name::of("tracer", layers));
            Code::generic(Name::of("tracer", "Layered"), [tracer, layers])
        }
    };
    let start = "    type Tracer = ";
    let tracer = out.lines(&tracer, 4, start.len(), 1);
    writeln!(out, "{start}{tracer};")
}

/// The method that gives the tracer.
pub(super) fn method(out: &mut Module, structure: &Structure) -> fmt::Result {
    out.import("tracer", &["Settings"]);
    let mut fields = vec![
        ("sampler", sampler(structure)),
        ("settings", Code::word("settings")),
    ];
    match structure.tracer {
        TracerNode::Path(mis) => fields.push(("mis", weights(mis))),
        TracerNode::AmbientOcclusion => {}
        TracerNode::Debug(view) => {
            let view = Name::of("tracer", format!("DebugView::{view:?}"));
            fields.push(("view", Code::Word(view)));
        }
    }
    let mut tracer = Code::literal(name(structure.tracer), fields);
    if structure.between.absorption {
        tracer = Code::literal(Name::of("tracer", "Absorbing"), [("tracer", tracer)]);
    }
    if structure.between.dispersion {
        let fields = [("tracer", tracer), ("sampler", sampler(structure))];
        tracer = Code::literal(Name::of("tracer", "Dispersing"), fields);
    }
    let tracer = match structure.layers {
        Layers::NONE => tracer,
        _ => {
            let layers = Code::Word(Name::of("tracer", "ConstLayers"));
            let fields = [("tracer", tracer), ("layers", layers)];
            Code::literal(Name::of("tracer", "Layered"), fields)
        }
    };
    let tracer = out.lines(&tracer, 8, 8, 0);
    writeln!(
        out,
        "    #[inline(always)]\n    fn tracer(&self, settings: Settings<D>) -> Self::Tracer {{\n        {tracer}\n    }}"
    )
}

fn name(tracer: TracerNode) -> Name {
    let name = match tracer {
        TracerNode::Path(_) => "PathTracer",
        TracerNode::AmbientOcclusion => "AmbientOcclusion",
        TracerNode::Debug(_) => "Debug",
    };
    Name::of("tracer", name)
}
