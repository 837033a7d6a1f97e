//! The functions of a scene, recorded. Directions are world space; `dir` is the direction of the ray that arrived.

use residual_render::bsdf::{Bsdf, BsdfSample, BsdfValue};
use residual_render::camera::Camera;
use residual_render::domain::tape::{Function, Outputs, Real, Record, Tape};
use residual_render::domain::{Buffers, Domain};
use residual_render::light::{self, LightSample};
use residual_render::material::Material;
use residual_render::math::Vec3;
use residual_render::program::{
    AlphaNode, BoxedAlpha, BoxedMaterial, Interpreted, Program, Structure,
};
use residual_render::sampler::{SampleKey, Sampler};
use residual_render::scene::Scene;
use residual_render::surface::{Hit, Surface};

/// A recorded function with what is printed around it.
pub(super) struct Recorded {
    pub(super) function: Function,
    /// The structure that it returns, if it has several outputs.
    pub(super) result: &'static str,
    pub(super) comment: String,
}

/// A hit, as parameters.
fn hit(tape: &Tape) -> Hit<Record<'_>> {
    let prim = tape.word("prim");
    Hit {
        prim,
        u: tape.real("u"),
        v: tape.real("v"),
    }
}

fn components(v: Vec3<Real<'_>>) -> [Real<'_>; 3] {
    [v.x, v.y, v.z]
}

/// Records a function of a program at a hit; `more` is given the surface and the unit direction `wo`.
fn at_hit<'t>(
    tape: &'t Tape,
    material: &BoxedMaterial<'_, Record<'t>>,
    more: impl FnOnce(
        &Surface<Record<'t>>,
        Vec3<Real<'t>>,
        Option<Vec3<Real<'t>>>,
        &dyn Bsdf<Record<'t>>,
    ) -> Outputs<'t>,
) -> Outputs<'t> {
    let d = Record::new(tape);
    let hit = hit(tape);
    let dir = tape.vector("dir");
    let mut surface = Surface::new(d, material.attributes(), &hit, dir);
    let wo = -dir.normalize(d);
    let shading = material.shade(d, &mut surface, wo);
    more(
        &surface,
        surface.frame.to_local(d, wo),
        shading.emission,
        &shading.bsdf,
    )
}

fn eval(number: usize, program: &Program) -> Recorded {
    let tape = Tape::new();
    let d = Record::new(&tape);
    let outputs = at_hit(
        &tape,
        &BoxedMaterial::new(program),
        |surface, wo, _, bsdf| {
            let wi = surface.frame.to_local(d, tape.vector("wi"));
            let BsdfValue { value, pdf } = bsdf.eval(d, surface, wo, wi);
            Outputs::new().vector("value", value).real("pdf", pdf)
        },
    );
    Recorded {
        function: tape.function(format!("program_{number}_eval"), outputs),
        result: "BsdfValue",
        comment: "f·cos towards the unit direction `wi`, and the density of sampling it."
            .to_owned(),
    }
}

fn sample(number: usize, program: &Program) -> Recorded {
    let tape = Tape::new();
    let d = Record::new(&tape);
    let outputs = at_hit(
        &tape,
        &BoxedMaterial::new(program),
        |surface, wo, _, bsdf| {
            let random = components(tape.vector("random"));
            let BsdfSample {
                wi,
                weight,
                pdf,
                delta,
            } = bsdf.sample(d, surface, wo, random);
            Outputs::new()
                .vector("wi", surface.frame.to_world(wi).normalize(d))
                .vector("weight", weight)
                .real("pdf", pdf)
                .truth("delta", delta)
        },
    );
    Recorded {
        function: tape.function(format!("program_{number}_sample"), outputs),
        result: "BsdfSample",
        comment: "A direction, from two numbers for the direction and one for the lobe.".to_owned(),
    }
}

fn emission(number: usize, program: &Program) -> Option<Recorded> {
    program.emission?;
    let tape = Tape::new();
    let outputs = at_hit(&tape, &BoxedMaterial::new(program), |_, _, emission, _| {
        Outputs::new().vector("radiance", emission.expect("the program emits"))
    });
    Some(Recorded {
        function: tape.function(format!("program_{number}_emission"), outputs),
        result: "",
        comment: "Radiance emitted against `dir`.".to_owned(),
    })
}

fn alpha(number: usize, node: &AlphaNode) -> Recorded {
    let tape = Tape::new();
    let d = Record::new(&tape);
    let hit = hit(&tape);
    let ray = [tape.vector("org"), tape.vector("dir")];
    let covers = BoxedAlpha::new(node).covers(d, ray, &hit);
    Recorded {
        function: tape.function(
            format!("program_{number}_covers"),
            Outputs::new().truth("covers", covers),
        ),
        result: "",
        comment: "Whether the surface is there for this hit of the ray.".to_owned(),
    }
}

/// The functions of a material program.
pub(super) fn program(number: usize, program: &Program) -> Vec<Recorded> {
    let always = [eval(number, program), sample(number, program)];
    let alpha = program.alpha.as_ref().map(|node| alpha(number, node));
    always
        .into_iter()
        .chain(emission(number, program))
        .chain(alpha)
        .collect()
}

/// The functions of one kind of light.
pub(super) fn light(number: usize, structure: &Structure) -> Vec<Recorded> {
    let empty = Buffers::EMPTY;
    let tape = Tape::new();
    let d = Record::new(&tape);
    let record = tape.word("record");
    let from = tape.vector("point");
    let random = components(tape.vector("random"));
    let scene = Interpreted::<Record<'_>>::new(structure, &empty);
    let LightSample {
        wi,
        position,
        infinite,
        radiance,
        pdf,
        delta,
    } = scene.lights()[number].sample(d, record, from, random);
    let outputs = Outputs::new()
        .vector("wi", wi)
        .vector("position", position)
        .truth("infinite", infinite)
        .vector("radiance", radiance)
        .real("pdf", pdf)
        .truth("delta", delta);
    let sample = Recorded {
        function: tape.function(format!("light_{number}_sample"), outputs),
        result: "LightSample",
        comment: "Samples the light with this record for a point.".to_owned(),
    };
    std::iter::once(sample)
        .chain(background(number, structure))
        .collect()
}

fn background(number: usize, structure: &Structure) -> Option<Recorded> {
    let empty = Buffers::EMPTY;
    let tape = Tape::new();
    let dir = tape.vector("dir");
    let scene = Interpreted::<Record<'_>>::new(structure, &empty);
    let seen = scene.lights()[number].background(Record::new(&tape), dir)?;
    let outputs = Outputs::new()
        .vector("radiance", seen.radiance)
        .real("pdf", seen.pdf);
    Some(Recorded {
        function: tape.function(format!("light_{number}_background"), outputs),
        result: "Background",
        comment: "What a ray in the unit direction `dir` that hits nothing sees.".to_owned(),
    })
}

/// The function that picks a light.
pub(super) fn light_pick() -> Recorded {
    let tape = Tape::new();
    let light::Pick {
        kind,
        record,
        probability,
    } = light::pick(Record::new(&tape), tape.real("random"));
    let outputs = Outputs::new()
        .word("kind", kind)
        .word("record", record)
        .real("probability", probability);
    Recorded {
        function: tape.function("light_pick", outputs),
        result: "LightPick",
        comment: "Picks a light: the number of its kind, its record, and the probability."
            .to_owned(),
    }
}

/// The camera's function.
pub(super) fn camera(structure: &Structure) -> Recorded {
    let tape = Tape::new();
    let film = [tape.real("x"), tape.real("y")];
    let ray = structure.camera.ray(Record::new(&tape), film);
    let outputs = Outputs::new()
        .vector("org", ray.org)
        .vector("dir", ray.dir)
        .real("tmax", ray.tmax);
    Recorded {
        function: tape.function("camera_ray", outputs),
        result: "Ray",
        comment: format!(
            "{:?}: the ray through film coordinates in [-1, 1], x to the right, y up.",
            structure.camera
        ),
    }
}

/// The sampler's functions.
pub(super) fn sampler(structure: &Structure) -> [Recorded; 2] {
    let tape = Tape::new();
    let [x, y, seed] = ["x", "y", "seed"].map(|name| tape.word(name));
    let d = Record::new(&tape);
    let key = SampleKey::new(d, x, y, d.uint(0), seed);
    let key = Recorded {
        function: tape.function("sampler_pixel", Outputs::new().word("pixel", key.pixel)),
        result: "",
        comment: "The hash of pixel and seed.".to_owned(),
    };
    let tape = Tape::new();
    let [pixel, index, dimension] = ["pixel", "index", "dimension"].map(|name| tape.word(name));
    let pair = structure
        .sampler
        .pair(Record::new(&tape), SampleKey { pixel, index }, dimension);
    let outputs = Outputs::new()
        .real("first", pair[0])
        .real("second", pair[1]);
    let pair = Recorded {
        function: tape.function("sampler_pair", outputs),
        result: "Pair",
        comment: format!("{:?}: two numbers in [0, 1).", structure.sampler),
    };
    [key, pair]
}
