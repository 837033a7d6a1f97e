//! Functions of a hit that no tracer has a part in: whether the surface is there, and which program it has.

use residual_render::alpha::AlphaTest as _;
use residual_render::domain::tape::{Outputs, Record, Tape};
use residual_render::program::AlphaTestNode;
use residual_render::surface::SurfaceHit;
use residual_render::triangle;

use crate::recorded::Recorded;

/// A hit, as parameters.
pub(crate) fn hit(tape: &Tape) -> SurfaceHit<Record<'_>> {
    let prim = tape.word("prim");
    SurfaceHit {
        prim,
        u: tape.real("u"),
        v: tape.real("v"),
    }
}

pub(crate) fn alpha_test(index: usize, node: &AlphaTestNode) -> Recorded {
    let tape = Tape::new();
    let d = Record::new(&tape);
    let hit = hit(&tape);
    let ray = [tape.vector("org"), tape.vector("dir")];
    let passes = node.boxed::<Record<'_>>().passes(d, ray, &hit);
    Recorded {
        function: tape.function(
            format!("program_{index}_alpha_test"),
            Outputs::new().truth("passes", passes),
        ),
        result: "",
        comment: "Whether the surface is there for this hit of the ray.".to_owned(),
    }
}

pub(crate) fn program_of() -> Recorded {
    let tape = Tape::new();
    let d = Record::new(&tape);
    let program = triangle::program_of(d, tape.word("prim"));
    Recorded {
        function: tape.function("program_of", Outputs::new().word("program", program)),
        result: "",
        comment: "The index of a triangle's program.".to_owned(),
    }
}
