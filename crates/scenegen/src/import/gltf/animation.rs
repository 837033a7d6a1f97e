//! Animations, of which a still shows one moment: transforms and weights of nodes at a time.

use std::collections::HashMap;

use glam::{DQuat, DVec3};
use gltf::json::animation::{Channel, Interpolation, Property, Sampler};
use gltf::json::validation::Checked;
use gltf::json::{Animation, Root};

use super::accessors::Accessors;
use super::lookup::{find, place};
use crate::import::error::Fault;
use crate::import::warnings::Warnings;

/// What animations say of a node.
#[derive(Debug, Default)]
pub(super) struct Animated {
    pub(super) translation: Option<DVec3>,
    pub(super) rotation: Option<DQuat>,
    pub(super) scale: Option<DVec3>,
    /// Of its mesh's morph targets.
    pub(super) weights: Option<Vec<f32>>,
}

/// All animated nodes, by their index.
pub(super) type Pose = HashMap<usize, Animated>;

/// The animation of a name or an index, or all.
fn chosen(root: &Root, wanted: Option<&str>) -> Result<Vec<usize>, Fault> {
    let Some(wanted) = wanted else {
        return Ok((0..root.animations.len()).collect());
    };
    let name = |animation: &Animation| animation.name.as_deref() == Some(wanted);
    let by_index = || {
        wanted
            .parse()
            .ok()
            .filter(|&index| index < root.animations.len())
    };
    let found = root.animations.iter().position(name).or_else(by_index);
    found.map(|index| vec![index]).ok_or_else(|| {
        let list = root.animations.iter().enumerate();
        let list: Vec<String> = list
            .map(|(index, animation)| place("", index, animation.name.as_deref()).split_off(1))
            .collect();
        let available = match list.is_empty() {
            true => "none".to_owned(),
            false => list.join(", "),
        };
        let problem = format!("there is no animation {wanted:?}; the file has {available}");
        Fault::new("animations", problem).advise("give one of these to --animation")
    })
}

/// The pose at a time in seconds, which the animation asked for, or all together, give; nothing where no time is asked for.
pub(super) fn pose_at(
    root: &Root,
    wanted: Option<&str>,
    time: Option<f64>,
    accessors: &mut Accessors<'_>,
    warnings: &mut Warnings,
) -> Result<Pose, Fault> {
    let mut pose = Pose::new();
    let Some(time) = time else {
        if !root.animations.is_empty() {
            let reason = "no time is asked for; --time-code or --frame shows a moment of them";
            warnings.dismiss(None, "animations", reason);
        }
        return Ok(pose);
    };
    let has_channels = |animation: &Animation| !animation.channels.is_empty();
    if !root.animations.iter().any(has_channels) {
        warnings.push(
            "animations",
            "there are none that can be read; the time code changes nothing",
        );
    }
    for index in chosen(root, wanted)? {
        let animation = &root.animations[index];
        let at = place("animations", index, animation.name.as_deref());
        for (k, channel) in animation.channels.iter().enumerate() {
            let at = format!("{at}/channels/{k}");
            let without = "the channel is left out";
            let samplers = &animation.samplers;
            let sampler = find(
                samplers,
                channel.sampler,
                "samplers",
                &at,
                without,
                warnings,
            );
            let node = find(
                &root.nodes,
                channel.target.node,
                "nodes",
                &at,
                without,
                warnings,
            );
            let (Some(sampler), Some(_)) = (sampler, node) else {
                continue;
            };
            let node = pose.entry(channel.target.node.value()).or_default();
            if !node.set(channel, sampler, time, accessors, &at)? {
                warnings.push(
                    at,
                    "animates what another animation does; the first is shown (--animation chooses one)",
                );
            }
        }
    }
    Ok(pose)
}

impl Animated {
    /// Takes what a channel says; false where the property is set already.
    fn set(
        &mut self,
        channel: &Channel,
        sampler: &Sampler,
        time: f64,
        accessors: &mut Accessors<'_>,
        at: &str,
    ) -> Result<bool, Fault> {
        let Checked::Valid(property) = channel.target.path else {
            return Err(Fault::new(at, "animates an unknown property"));
        };
        let vector = |[x, y, z]: [f32; 3]| DVec3::new(x.into(), y.into(), z.into());
        Ok(match property {
            Property::Translation => {
                let value = value(sampler, time, accessors, at, lerp)?;
                set(&mut self.translation, value.map(vector))
            }
            Property::Scale => {
                let value = value(sampler, time, accessors, at, lerp)?;
                set(&mut self.scale, value.map(vector))
            }
            Property::Rotation => {
                let value = value(sampler, time, accessors, at, slerp)?;
                let rotation = value.map(|value| DQuat::from_array(value.map(f64::from)));
                let rotation = rotation.filter(|rotation| rotation.length() > 0.0);
                set(&mut self.rotation, rotation.map(DQuat::normalize))
            }
            Property::MorphTargetWeights => {
                set(&mut self.weights, weights(sampler, time, accessors, at)?)
            }
        })
    }
}

/// Sets what is not set; false where it is.
fn set<T>(place: &mut Option<T>, value: Option<T>) -> bool {
    let is_free = place.is_none();
    if is_free {
        *place = value;
    }
    is_free
}

/// Between which keys a time lies, and how far from the first to the second, in [0, 1]; with the time between them.
struct Keys {
    from: usize,
    to: usize,
    share: f64,
    seconds: f64,
}

fn keys(times: &[[f32; 1]], time: f64) -> Option<Keys> {
    let last = times.len().checked_sub(1)?;
    let to = times.partition_point(|[key]| f64::from(*key) <= time);
    let (from, to) = (to.saturating_sub(1).min(last), to.min(last));
    let seconds = f64::from(times[to][0]) - f64::from(times[from][0]);
    let share = (time - f64::from(times[from][0])) / seconds;
    Some(Keys {
        from,
        to,
        share: if seconds > 0.0 {
            share.clamp(0.0, 1.0)
        } else {
            0.0
        },
        seconds: seconds.max(0.0),
    })
}

/// The value of a sampler of vectors; `None` where it has no keys.
fn value<const N: usize>(
    sampler: &Sampler,
    time: f64,
    accessors: &mut Accessors<'_>,
    at: &str,
    linear: impl Fn([f32; N], [f32; N], f64) -> [f32; N],
) -> Result<Option<[f32; N]>, Fault> {
    let times = accessors.floats::<1>(sampler.input, at)?;
    let values = accessors.floats::<N>(sampler.output, at)?;
    let Some(keys) = keys(&times, time) else {
        return Ok(None);
    };
    let interpolation = interpolation(sampler, at)?;
    check_count(values.len(), times.len() * per_key(interpolation), at)?;
    Ok(Some(match interpolation {
        Interpolation::Step => values[keys.from],
        Interpolation::Linear => linear(values[keys.from], values[keys.to], keys.share),
        Interpolation::CubicSpline => {
            let [_, from, out] = [0, 1, 2].map(|k| values[3 * keys.from + k]);
            let [into, to, _] = [0, 1, 2].map(|k| values[3 * keys.to + k]);
            std::array::from_fn(|k| hermite(&keys, [from[k], out[k], to[k], into[k]]))
        }
    }))
}

/// The same of as many weights as the mesh has morph targets.
fn weights(
    sampler: &Sampler,
    time: f64,
    accessors: &mut Accessors<'_>,
    at: &str,
) -> Result<Option<Vec<f32>>, Fault> {
    let times = accessors.floats::<1>(sampler.input, at)?;
    let values = {
        let values = accessors.floats::<1>(sampler.output, at)?;
        values.into_iter().flatten().collect::<Vec<f32>>()
    };
    let Some(keys) = keys(&times, time) else {
        return Ok(None);
    };
    let interpolation = interpolation(sampler, at)?;
    let count = values.len() / (times.len() * per_key(interpolation));
    check_count(
        values.len(),
        count * times.len() * per_key(interpolation),
        at,
    )?;
    let row = |row: usize| &values[row * count..][..count];
    let weight = |k: usize| match interpolation {
        Interpolation::Step => row(keys.from)[k],
        Interpolation::Linear => {
            let [from, to] = [row(keys.from)[k], row(keys.to)[k]];
            lerp([from], [to], keys.share)[0]
        }
        Interpolation::CubicSpline => {
            let [from, out] = [row(3 * keys.from + 1)[k], row(3 * keys.from + 2)[k]];
            let [into, to] = [row(3 * keys.to)[k], row(3 * keys.to + 1)[k]];
            hermite(&keys, [from, out, to, into])
        }
    };
    Ok(Some((0..count).map(weight).collect()))
}

fn interpolation(sampler: &Sampler, at: &str) -> Result<Interpolation, Fault> {
    match sampler.interpolation {
        Checked::Valid(interpolation) => Ok(interpolation),
        Checked::Invalid => Err(Fault::new(at, "has an unknown interpolation")),
    }
}

/// Values for each key: with tangents of splines before and after it.
fn per_key(interpolation: Interpolation) -> usize {
    match interpolation {
        Interpolation::Linear | Interpolation::Step => 1,
        Interpolation::CubicSpline => 3,
    }
}

fn check_count(count: usize, expected: usize, at: &str) -> Result<(), Fault> {
    if count == expected && count > 0 {
        return Ok(());
    }
    let problem = format!("has {count} values where its keys need {expected}");
    Err(Fault::new(at, problem))
}

fn lerp<const N: usize>(a: [f32; N], b: [f32; N], t: f64) -> [f32; N] {
    std::array::from_fn(|k| (f64::from(a[k]) + (f64::from(b[k]) - f64::from(a[k])) * t) as f32)
}

fn slerp(a: [f32; 4], b: [f32; 4], t: f64) -> [f32; 4] {
    let [a, b] = [a, b].map(|quaternion| DQuat::from_array(quaternion.map(f64::from)));
    if !(a.length() > 0.0 && b.length() > 0.0) {
        return lerp(a.as_quat().to_array(), b.as_quat().to_array(), t);
    }
    let between = a.normalize().slerp(b.normalize(), t);
    between.as_quat().to_array()
}

/// glTF 2.0, appendix C.5: values and tangents at the first key and at the second.
fn hermite(keys: &Keys, [from, out, to, into]: [f32; 4]) -> f32 {
    let [from, out, to, into] = [from, out, to, into].map(f64::from);
    let (t, seconds) = (keys.share, keys.seconds);
    let (t2, t3) = (t * t, t * t * t);
    let value = (2.0 * t3 - 3.0 * t2 + 1.0) * from
        + seconds * (t3 - 2.0 * t2 + t) * out
        + (3.0 * t2 - 2.0 * t3) * to
        + seconds * (t3 - t2) * into;
    value as f32
}
