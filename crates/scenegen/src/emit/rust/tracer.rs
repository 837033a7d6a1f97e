//! The tracer of a scene as Rust, and the layers that it fills.

use std::fmt::{self, Write as _};

use residual_render::layer::Layers;
use residual_render::program::Structure;
use residual_render::tracer::{AnyMis, AnySharing, MatterNode, MediaNode, TracerNode};

use super::layout::{Code, Name};
use super::module::Module;

/// The constants with what the device has to know: the layers, and whether there are light paths.
pub(super) fn constants(out: &mut Module, structure: &Structure) -> fmt::Result {
    let layers = structure.layers;
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
    )?;
    if structure.tracer.has_light_paths() {
        writeln!(
            out,
            "\n    /// Paths begin at lights, too.\n    pub const HAS_LIGHT_PATHS: bool = true;"
        )?;
    }
    Ok(())
}

fn sampler(structure: &Structure) -> Code {
    Code::Word(Name::of("sampler", format!("{:?}", structure.sampler)))
}

fn weights(mis: AnyMis) -> Code {
    Code::Word(Name::of("tracer", format!("{mis:?}")))
}

fn sharing(sharing: AnySharing) -> Code {
    Code::Word(Name::of("tracer", format!("{sharing:?}")))
}

fn camera(structure: &Structure) -> Code {
    Code::Word(Name::of("camera", format!("{:?}", structure.camera)))
}

fn nesting(media: MediaNode) -> Code {
    Code::Word(Name::of("tracer", format!("{:?}", media.nesting)))
}

/// What media do, as a type.
fn matter_type(structure: &Structure, media: MediaNode) -> Code {
    let name = Name::of("tracer", format!("{:?}", media.matter));
    match media.matter {
        MatterNode::Absorption => Code::Word(name),
        MatterNode::AbsorptionAndScattering => Code::generic(name, [sampler(structure)]),
    }
}

/// What media do, as a value.
fn matter(structure: &Structure, media: MediaNode) -> Code {
    let name = Name::of("tracer", format!("{:?}", media.matter));
    match media.matter {
        MatterNode::Absorption => Code::Word(name),
        MatterNode::AbsorptionAndScattering => {
            Code::literal(name, [("sampler", sampler(structure))])
        }
    }
}

/// The associated type of the tracer.
pub(super) fn associated_type(out: &mut Module, structure: &Structure) -> fmt::Result {
    let mut parameters = vec![Code::word("D"), sampler(structure)];
    match structure.tracer {
        TracerNode::Path(mis) => parameters.push(weights(mis)),
        TracerNode::Bidirectional(kind) => parameters.extend([camera(structure), sharing(kind)]),
        TracerNode::AmbientOcclusion | TracerNode::Debug(_) => {}
    }
    let mut tracer = Code::generic(name(structure.tracer), parameters);
    if let Some(media) = structure.between.media {
        let parameters = [tracer, nesting(media), matter_type(structure, media)];
        tracer = Code::generic(Name::of("tracer", "InMedia"), parameters);
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
    let line = out.define("type Tracer", &tracer, 4);
    writeln!(out, "    {line}")
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
        TracerNode::Bidirectional(kind) => {
            fields.extend([("camera", camera(structure)), ("sharing", sharing(kind))]);
        }
        TracerNode::AmbientOcclusion => {}
        TracerNode::Debug(view) => {
            let view = Name::of("tracer", format!("DebugView::{view:?}"));
            fields.push(("view", Code::Word(view)));
        }
    }
    let mut tracer = Code::literal(name(structure.tracer), fields);
    if let Some(media) = structure.between.media {
        let fields = [
            ("tracer", tracer),
            ("nesting", nesting(media)),
            ("matter", matter(structure, media)),
        ];
        tracer = Code::literal(Name::of("tracer", "InMedia"), fields);
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
        TracerNode::Bidirectional(_) => "Bidirectional",
        TracerNode::AmbientOcclusion => "AmbientOcclusion",
        TracerNode::Debug(_) => "Debug",
    };
    Name::of("tracer", name)
}
