//! What moves while the shutter is open: the data at other moments, for the renderer of the first.
//!
//! Whatever a plan decides by what is in the scene is decided once for all poses: a surface is smooth and bodies lie within each
//! other if they do so in any of them, a mesh is closed if it is so in all; lights are picked by a tree if that pays at the first.
//! So the structure is one, and only data differ.

use std::collections::HashSet;

use residual_render::changed_data::ChangedData;
use residual_render::domain::Buffer;
use residual_render::program::CameraNode;
use residual_render::scene_data::SceneData;

use super::camera::{self, Bounds, Shot};
use super::clip_distances::{self, Clipping};
use super::error::PlanError;
use super::geometry::Geometry;
use super::lights::PlannedLights;
use super::options::PlanOptions;
use super::planned::Motion;
use super::planned_materials::Materials;
use super::{coincident, geometry, media_at_camera};
use crate::desc::{Pose, SceneDesc, Warning};

/// The first pose, planned, by which the others go.
pub(super) struct First<'a> {
    pub(super) scene: &'a SceneDesc,
    pub(super) options: &'a PlanOptions,
    pub(super) materials: &'a Materials,
    pub(super) geometry: &'a Geometry,
    pub(super) camera: (&'a CameraNode, &'a Shot),
    pub(super) data: &'a SceneData,
}

/// What is the same whatever moves: what is made of materials, images and names alone.
const SAME: [Buffer; 3] = [Buffer::Texels, Buffer::Params, Buffer::Objects];

impl First<'_> {
    /// Plans the other poses; `None` where nothing that is seen moves.
    pub(super) fn motion(
        &self,
        lights: &mut PlannedLights,
        depth: &mut f32,
        warnings: &mut Vec<Warning>,
    ) -> Result<Option<Motion>, PlanError> {
        let scene = self.scene;
        let mut later = Vec::new();
        // By the description's poses. Those that differ in nothing that is seen are the first.
        let mut poses = vec![0];
        for index in 1..=scene.later.len() {
            let changed = self.pose(scene.pose(index), lights, depth, warnings)?;
            poses.push(match changed.is_empty() {
                true => 0,
                false => {
                    later.push(changed);
                    later.len()
                }
            });
        }
        if later.is_empty() {
            return Ok(None);
        }
        let moments = scene.moments.iter().map(|&pose| poses[pose]).collect();
        let sources = self.sources(&later);
        Ok(Some(Motion {
            later,
            moments,
            sources,
        }))
    }

    /// Plans a pose.
    fn pose(
        &self,
        pose: Pose<'_>,
        lights: &mut PlannedLights,
        depth: &mut f32,
        warnings: &mut Vec<Warning>,
    ) -> Result<ChangedData, PlanError> {
        let mut data = SceneData::default();
        let mut new_warnings = Vec::new();
        let first = self.scene.pose(0);
        // Where only the camera moves, its record is all that is new.
        let only_camera = pose.instances == first.instances && pose.lights == first.lights;
        if !only_camera {
            self.place(pose, lights, &mut data, &mut new_warnings)?;
        }
        let bounds = &self.geometry.bounds;
        let (camera, shot) = camera::choose(
            (self.scene, pose),
            self.options,
            bounds,
            Some(self.camera.1.focus_distance),
            &mut data,
            &mut new_warnings,
        )?;
        if camera != *self.camera.0 {
            return Err(PlanError::OtherAtAnotherMoment);
        }
        let filters = self.materials.filter();
        camera::set_other_records(&camera, self.options, filters, bounds, &mut data);
        let triangles = if only_camera { self.data } else { &data };
        let (materials, objects) = (self.materials, &self.geometry.objects);
        let media = media_at_camera::media_words(materials, &data.record(0), triangles, objects);
        if let Some(clip) = shot.camera.clip {
            let record = data.record(0);
            let looked = clip_distances::look(clip, &shot.camera, &record, triangles);
            if let Clipping::Something(warning) = looked {
                new_warnings.push(warning);
            }
        }
        *data.buffer_mut(Buffer::Media) = media;
        *depth = depth.max(bounds.farthest(shot.camera.position));
        for warning in new_warnings {
            if !warnings.contains(&warning) {
                warnings.push(warning);
            }
        }
        let is_new = |buffer: &Buffer| match only_camera {
            true => matches!(buffer, Buffer::Camera | Buffer::Media),
            false => !SAME.contains(buffer),
        };
        let same: Vec<Buffer> = Buffer::ALL.into_iter().filter(|b| !is_new(b)).collect();
        Ok(ChangedData::new(self.data, data, &same))
    }

    /// Writes what is where in a pose: triangles and lights.
    fn place(
        &self,
        pose: Pose<'_>,
        lights: &mut PlannedLights,
        data: &mut SceneData,
        warnings: &mut Vec<Warning>,
    ) -> Result<(), PlanError> {
        let (scene, materials) = (self.scene, self.materials);
        let geometry = geometry::pack(scene, pose, materials, data, warnings)?;
        coincident::hide(data);
        if self.options.tracer.needs_light() {
            let radius = f64::from(self.geometry.bounds.sphere().1);
            lights.plan_later(scene, pose, materials, &geometry, radius, (self.data, data));
        }
        let is_alike = geometry.objects == self.geometry.objects
            && data.single_sided == self.data.single_sided
            && data.alpha_tested == self.data.alpha_tested;
        match is_alike {
            true => Ok(()),
            false => Err(PlanError::OtherAtAnotherMoment),
        }
    }

    /// What of the scene moves.
    fn sources(&self, later: &[ChangedData]) -> Vec<String> {
        let scene = self.scene;
        let mut sources = Vec::new();
        let mut seen = HashSet::new();
        let mut add = |source: String| {
            if seen.insert(source.clone()) {
                sources.push(source);
            }
        };
        for (index, first) in scene.instances.iter().enumerate() {
            let is_seen = self.materials.planned[scene.meshes[first.mesh].material].is_some();
            let moves = |pose: Pose<'_>| pose.instances[index] != *first;
            if is_seen && scene.poses().any(moves) {
                add(format!("node {:?}", first.name));
            }
        }
        if later.iter().any(|changed| changed.has(Buffer::Lights)) {
            for (index, first) in scene.lights.iter().enumerate() {
                if scene.poses().any(|pose| pose.lights[index] != *first) {
                    add(format!("light {:?}", first.name));
                }
            }
        }
        if later.iter().any(|changed| changed.has(Buffer::Camera)) {
            add(format!("camera {:?}", self.camera.1.camera.name));
        }
        sources
    }
}

/// The box around everything, at all moments: framing cameras do not follow what moves.
pub(super) fn set_bounds(scene: &SceneDesc, materials: &Materials, bounds: &mut Bounds) {
    if !scene.later.is_empty() {
        *bounds = geometry::bounds_of_poses(scene, materials);
    }
}
