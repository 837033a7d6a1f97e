//! How kernels call recorded functions, and what they do with what comes back.

use crate::functions::Recorded;

/// How a path goes on: statements on what `step` has.
pub(crate) struct WayOn {
    pub(crate) indent: &'static str,
    pub(crate) shadow: &'static [&'static str],
    pub(crate) bounce: &'static [&'static str],
}

/// Through queues.
pub(crate) const QUEUED: WayOn = WayOn {
    indent: "        ",
    shadow: &[
        "shadow = atomicAdd(&shadow_count, 1u);",
        "shadow_ray = ShadowRay(step.shadow_org, step.shadow_tmax, step.shadow_dir, slot, step.shadow_contribution);",
    ],
    bounce: &[
        "next = atomicAdd(&next_count, 1u);",
        "paths[slot] = Path(step.bounce_org, step.bounce_pdf, step.bounce_dir, path.pixel, step.bounce_throughput, step.bounce_state, vec4u(0u));",
    ],
};

/// Through queues, in one of the cases of a kernel.
pub(crate) const QUEUED_IN_CASE: WayOn = WayOn {
    indent: "                ",
    ..QUEUED
};

/// In the same thread.
pub(crate) const FOLLOWED: WayOn = WayOn {
    indent: "                ",
    shadow: &[
        "is_shadow = true;",
        "shadow = ShadowRay(step.shadow_org, step.shadow_tmax, step.shadow_dir, slot, step.shadow_contribution);",
    ],
    bounce: &[
        "goes_on = true;",
        "path = Path(step.bounce_org, step.bounce_pdf, step.bounce_dir, path.pixel, step.bounce_throughput, step.bounce_state, vec4u(0u));",
    ],
};

/// The call of a recorded function where there are `slot`, `path`, or what emission and alpha tests have instead.
pub(crate) fn call(recorded: &Recorded) -> String {
    let name = &recorded.function.name;
    let is_alpha_test = name.ends_with("alpha_test");
    let argument = |parameter: &str| match parameter {
        "x" => "place.x",
        "y" => "place.y",
        "width" => "settings.width",
        "height" => "settings.height",
        "seed" => "settings.seed",
        "sample" | "index" => "sample_of(slot)",
        "max_depth" => "settings.max_depth",
        "roulette_from" => "settings.roulette_from",
        "reach" => "settings.reach",
        "prim" if is_alpha_test => "hit.prim",
        "u" if is_alpha_test => "hit.u",
        "v" if is_alpha_test => "hit.v",
        "org" if is_alpha_test => "org",
        "dir" if is_alpha_test => "dir",
        "prim" => "path.hit.w",
        "u" => "bitcast<f32>(path.hit.y)",
        "v" => "bitcast<f32>(path.hit.z)",
        "org" => "path.org",
        "dir" => "path.dir",
        "throughput" => "path.throughput",
        "pdf" => "path.pdf",
        "pixel" => "path.pixel",
        "state" => "path.state",
        other => unreachable!("no recorded function has a parameter {other}"),
    };
    let parameters = &recorded.function.parameters;
    let arguments: Vec<_> = parameters.iter().map(|p| argument(p.name)).collect();
    format!("{name}({})", arguments.join(", "))
}
