//! Where everything is at the moments while a shutter is open.

use super::{CameraDesc, InstanceDesc, LightDesc, PoseDesc, SceneDesc};

/// Why there is no motion blur where a shutter is open.
pub const NOTHING_MOVES: &str = "nothing that is seen moves while the shutter is open";

/// One of a scene's poses.
#[derive(Debug, Clone, Copy)]
pub struct Pose<'a> {
    /// Meshes placed in the world.
    pub instances: &'a [InstanceDesc],
    /// Punctual lights.
    pub lights: &'a [LightDesc],
    /// Cameras.
    pub cameras: &'a [CameraDesc],
}

impl SceneDesc {
    /// The pose of this index: 0 is that of the scene itself, the others are those of [`SceneDesc::later`].
    ///
    /// # Panics
    /// If there is none.
    pub fn pose(&self, index: usize) -> Pose<'_> {
        match index.checked_sub(1) {
            None => Pose {
                instances: &self.instances,
                lights: &self.lights,
                cameras: &self.cameras,
            },
            Some(later) => {
                let PoseDesc {
                    instances,
                    lights,
                    cameras,
                } = &self.later[later];
                Pose {
                    instances,
                    lights,
                    cameras,
                }
            }
        }
    }

    /// All poses; the first is that of the scene itself.
    pub fn poses(&self) -> impl Iterator<Item = Pose<'_>> {
        (0..=self.later.len()).map(|index| self.pose(index))
    }

    /// The lights of all poses.
    pub fn all_lights_mut(&mut self) -> impl Iterator<Item = &mut LightDesc> {
        let later = self.later.iter_mut().flat_map(|pose| &mut pose.lights);
        self.lights.iter_mut().chain(later)
    }

    /// Keeps the lights of which something holds, in all poses.
    pub fn retain_lights(&mut self, is_kept: impl Fn(&LightDesc) -> bool) {
        let later = self.later.iter_mut().map(|pose| &mut pose.lights);
        for lights in later.chain([&mut self.lights]) {
            lights.retain(&is_kept);
        }
    }

    /// Closes the shutter: what is left is the pose of the scene itself.
    pub fn close_shutter(&mut self) {
        self.later.clear();
        self.moments.clear();
    }
}
