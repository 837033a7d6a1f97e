//! The lights of poses behind the first, for the renderer of the first.

use residual_render::domain::Buffer;
use residual_render::light::{EnvironmentHeader, PunctualRecord, push_light};
use residual_render::program::LightNode;
use residual_render::record::BufferRecord;
use residual_render::scene_data::SceneData;

use super::PlannedLights;
use crate::desc::{Pose, SceneDesc};
use crate::plan::geometry::Geometry;
use crate::plan::light_tree::Reach;
use crate::plan::planned::LightKindUse;
use crate::plan::planned_materials::Materials;

impl PlannedLights {
    /// Plans the lights of a later pose, so that one renderer serves both: kinds keep their indices, and lights are picked from
    /// a tree or a table as at the first moment, whose data `first` are.
    pub(in crate::plan) fn plan_later(
        &mut self,
        scene: &SceneDesc,
        pose: Pose<'_>,
        materials: &Materials,
        geometry: &Geometry,
        radius: f64,
        (first, data): (&SceneData, &mut SceneData),
    ) {
        let mut lights = Self {
            kinds: std::mem::take(&mut self.kinds),
            uses: vec![LightKindUse::default(); self.uses.len()],
            environment: self.environment,
            ..Self::default()
        };
        lights.add_emitting_triangles(scene, materials, geometry, data);
        for light in pose.lights {
            lights.add_punctual(light, radius, data);
        }
        if lights.environment > 0.0 {
            // Only the number of lights before it can have changed.
            let words = first.buffer(Buffer::Environment);
            let header = EnvironmentHeader {
                light: lights.powers.len() as u32,
                ..EnvironmentHeader::from_words(words)
            };
            data.buffer_mut(Buffer::Environment).extend(words);
            header.write_to(data.buffer_mut(Buffer::Environment));
            lights.push_environment(scene, radius, data);
        }
        lights.stay_countable(data);
        lights.set_picks(self.picks, data);
        self.take_in(lights);
    }

    /// Notes what another pose has.
    fn take_in(&mut self, other: Self) {
        self.kinds = other.kinds;
        self.uses.resize(self.kinds.len(), LightKindUse::default());
        for (ours, theirs) in self.uses.iter_mut().zip(other.uses) {
            if ours.count == 0 {
                *ours = theirs;
            }
        }
        if let (Some(ours), Some(theirs)) = (&mut self.tree, other.tree) {
            ours.levels = ours.levels.max(theirs.levels);
        }
        self.is_dark &= other.is_dark;
    }

    /// Where a pose has no light, one that is dark stands for those of other poses, as renderers that pick lights need one to pick.
    pub(super) fn stay_countable(&mut self, data: &mut SceneData) {
        self.is_dark = self.powers.is_empty();
        if self.is_dark {
            let kind = self.kind(LightNode::Point);
            push_light(data, PunctualRecord::new(kind as u32, [0.0; 3], [0.0; 3]));
            self.powers.push((1.0, kind));
            self.reaches.push(Reach::Everywhere);
        }
    }
}
