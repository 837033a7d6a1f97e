//! How kernels call recorded functions, and what they do with what comes back.

use crate::recorded::Recorded;

/// How a path goes on: statements on what `step` has, in which `SHADOW` stands for its shadow ray and `PATH` for the path behind it.
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
        "shadow_ray = SHADOW;",
    ],
    bounce: &["next = atomicAdd(&next_count, 1u);", "paths[slot] = PATH;"],
};

/// Through queues, in one of the cases of a kernel.
pub(crate) const QUEUED_IN_CASE: WayOn = WayOn {
    indent: "                ",
    ..QUEUED
};

/// In the same thread.
pub(crate) const FOLLOWED: WayOn = WayOn {
    indent: "                ",
    shadow: &["is_shadow = true;", "shadow = SHADOW;"],
    bounce: &["goes_on = true;", "path = PATH;"],
};

/// The call of a recorded function where there are `slot`, `path`, or what emission and alpha tests have instead. Paths of scenes
/// with light paths keep the index of their points.
pub(crate) fn call(recorded: &Recorded, has_light_paths: bool) -> String {
    let name = &recorded.function.name;
    let is_alpha_test = name.ends_with("alpha_test");
    let argument = |parameter: &str| match parameter {
        "x" => "place.x",
        "y" => "place.y",
        "width" => "settings.width",
        "height" => "settings.height",
        "seed" => "settings.seed",
        "index" if has_light_paths => "path.index",
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
        "rivals" => "path.rivals",
        other => unreachable!("no recorded function has a parameter {other}"),
    };
    let parameters = &recorded.function.parameters;
    let arguments: Vec<_> = parameters.iter().map(|p| argument(p.name)).collect();
    format!("{name}({})", arguments.join(", "))
}
