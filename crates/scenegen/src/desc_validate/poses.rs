//! The invariants of poses.

use super::{Check, check_camera, check_light, require};
use crate::desc::{Pose, SceneDesc};

impl SceneDesc {
    pub(super) fn check_poses(&self) -> Check {
        self.poses().try_for_each(|pose| self.check_pose(pose))?;
        self.check_moments()
    }

    fn check_pose(&self, pose: Pose<'_>) -> Check {
        for (i, instance) in pose.instances.iter().enumerate() {
            require(
                instance.mesh < self.meshes.len(),
                || format!("instances[{i}].mesh"),
                "is out of range",
            )?;
            require(
                instance.transform.is_finite(),
                || format!("instances[{i}].transform"),
                "is not finite",
            )?;
        }
        let mut lights = pose.lights.iter().enumerate();
        lights.try_for_each(|(i, light)| check_light(i, light))?;
        let mut cameras = pose.cameras.iter().enumerate();
        cameras.try_for_each(|(i, camera)| check_camera(i, camera))
    }

    fn check_moments(&self) -> Check {
        let poses = 1 + self.later.len();
        let is_valid = match poses {
            1 => self.moments.is_empty(),
            _ => {
                self.moments.len().is_power_of_two()
                    && self.moments.iter().all(|&pose| pose < poses)
            }
        };
        let place = || "moments".to_owned();
        require(
            is_valid,
            place,
            "are no power of two or of poses that there are not",
        )?;
        for (k, pose) in self.later.iter().enumerate() {
            let first = self.pose(0);
            let is_same = pose.instances.len() == first.instances.len()
                && pose.lights.len() == first.lights.len()
                && pose.cameras.len() == first.cameras.len();
            require(
                is_same,
                || format!("later[{k}]"),
                "has other numbers of instances, lights or cameras than the first pose",
            )?;
        }
        Ok(())
    }
}
