//! The poses of a scene at the moments while a shutter is open, made alike: what is not there at one of them is there without
//! size.

use glam::Mat3A;

use crate::desc::{CameraDesc, InstanceDesc, LightDesc, MeshDesc, PoseDesc, SceneDesc};
use crate::import::error::Fault;

/// What is where at a moment; `None` where nothing of something can be seen then.
#[derive(Default)]
pub(super) struct PoseDraft {
    pub(super) instances: Vec<Option<InstanceDesc>>,
    pub(super) lights: Vec<Option<LightDesc>>,
    pub(super) cameras: Vec<Option<CameraDesc>>,
}

impl PoseDraft {
    /// What is there, where there is no other moment.
    fn alone(self) -> PoseDesc {
        PoseDesc {
            instances: self.instances.into_iter().flatten().collect(),
            lights: self.lights.into_iter().flatten().collect(),
            cameras: self.cameras.into_iter().flatten().collect(),
        }
    }
}

/// Writes the poses into a scene that has the meshes of all of them, each once.
pub(super) fn write(drafts: Vec<PoseDraft>, scene: &mut SceneDesc) -> Result<(), Fault> {
    let mut poses: Vec<PoseDesc> = Vec::new();
    let mut moments = Vec::with_capacity(drafts.len());
    for pose in alike(drafts)? {
        let known = poses.iter().position(|known| *known == pose);
        moments.push(known.unwrap_or_else(|| {
            poses.push(pose);
            poses.len() - 1
        }));
    }
    for pose in &poses {
        check_meshes(&scene.meshes, &poses[0].instances, &pose.instances)?;
    }
    let mut poses = poses.into_iter();
    let PoseDesc {
        instances,
        lights,
        cameras,
    } = poses.next().unwrap_or_default();
    (scene.instances, scene.lights, scene.cameras) = (instances, lights, cameras);
    scene.later = poses.collect();
    if !scene.later.is_empty() {
        scene.moments = moments;
    }
    Ok(())
}

/// The poses, with as much in each of them.
fn alike(mut drafts: Vec<PoseDraft>) -> Result<Vec<PoseDesc>, Fault> {
    if drafts.len() > 1 {
        // Nothing is seen of what has no extent; emitters and lights of that kind are dark.
        let point = |instance: &InstanceDesc| {
            let mut instance = instance.clone();
            instance.transform.matrix3 = Mat3A::ZERO;
            instance
        };
        let dark = |light: &LightDesc| LightDesc {
            intensity: [0.0; 3],
            ..light.clone()
        };
        complete(&mut drafts, |draft| &mut draft.instances, point)?;
        complete(&mut drafts, |draft| &mut draft.lights, dark)?;
        complete(&mut drafts, |draft| &mut draft.cameras, Clone::clone)?;
    }
    Ok(drafts.into_iter().map(PoseDraft::alone).collect())
}

/// Gives what is there at some of the moments a stand-in at the others.
fn complete<T: Clone>(
    drafts: &mut [PoseDraft],
    list: impl Fn(&mut PoseDraft) -> &mut Vec<Option<T>>,
    stand_in: impl Fn(&T) -> T,
) -> Result<(), Fault> {
    let count = list(&mut drafts[0]).len();
    if drafts.iter_mut().any(|draft| list(draft).len() != count) {
        return Err(differs("nodes"));
    }
    for index in 0..count {
        let found = drafts
            .iter_mut()
            .find_map(|draft| list(draft)[index].clone());
        if let Some(found) = found {
            for draft in &mut *drafts {
                list(draft)[index].get_or_insert_with(|| stand_in(&found));
            }
        }
    }
    Ok(())
}

/// Deformed meshes are others at each moment, of the same triangles.
fn check_meshes(
    meshes: &[MeshDesc],
    first: &[InstanceDesc],
    other: &[InstanceDesc],
) -> Result<(), Fault> {
    for (a, b) in first.iter().zip(other) {
        let [a, b] = [a, b].map(|instance| &meshes[instance.mesh]);
        if a.triangles.len() != b.triangles.len() || a.material != b.material {
            return Err(differs(format!("mesh \"{}\"", a.name.escape_debug())));
        }
    }
    Ok(())
}

fn differs(place: impl Into<String>) -> Fault {
    let problem = "has triangles that are finite at some moments while the shutter is open, and not at others";
    Fault::new(place, problem).advise("close the shutter, or choose another time")
}
