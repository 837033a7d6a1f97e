//! A plan and what it says of the scene's objects, materials and lights.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use residual_render::changed_data::ChangedData;
use residual_render::cryptomatte;
use residual_render::domain::Buffer;
use residual_render::layer::Layer;
use residual_render::program::Structure;
use residual_render::scene_data::SceneData;
use residual_render::tracer::{MatterNode, TracerNode};
use residual_render::triangle::ObjectRecord;

use super::options::{Binding, LightPicks};
use crate::desc::{Dismissed, Warning};

/// A scene, analysed.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The scene's name.
    pub name: String,
    /// When inputs are known.
    pub binding: Binding,
    /// How often each light is picked, as decided.
    pub light_picks: LightPicks,
    /// The static half.
    pub structure: Structure,
    /// The dynamic half; where the shutter is open, at the first moment.
    pub data: SceneData,
    /// What moves while the shutter is open, if anything does.
    pub motion: Option<Motion>,
    /// For each program, the materials that use it.
    pub materials: Vec<Vec<MaterialUse>>,
    /// What is seen, in the order of its triangles: a triangle's object is an index into this list.
    pub objects: Vec<PlannedObject>,
    /// For each kind of light, the lights of that kind.
    pub lights: Vec<LightKindUse>,
    /// The camera that was chosen.
    pub camera_name: String,
    /// Length of the diagonal of the box around everything.
    pub diagonal: f32,
    /// Distance from the eye to the farthest corner of that box.
    pub depth: f32,
    /// What was changed or left out.
    pub warnings: Vec<Warning>,
    /// What the scene has and the image does not need.
    pub dismissed: Vec<Dismissed>,
}

/// What a scene shows while the shutter is open.
#[derive(Debug, Clone)]
pub struct Motion {
    /// What of the data is different in other poses than the first, whose data are the plan's.
    pub later: Vec<ChangedData>,
    /// For each moment, in order of time, the pose then: 0 is the first, `k` is that of `later[k - 1]`.
    pub moments: Vec<usize>,
    /// What moves, such as `node "Wheel"`.
    pub sources: Vec<String>,
}

impl Plan {
    /// Fills [`Buffer::Objects`], which is empty unless layers read it.
    pub(super) fn pack_objects(&mut self) {
        self.data.buffer_mut(Buffer::Objects).clear();
        for object in &self.objects {
            self.data.push(ObjectRecord {
                material: object.material as u32,
                name_id: cryptomatte::id(&object.name),
                material_name_id: cryptomatte::id(&object.material_name),
            });
        }
    }

    /// Bytes of the data at all moments.
    pub fn memory_bytes(&self) -> usize {
        let later = self.motion.iter().flat_map(|motion| &motion.later);
        let later: usize = later.map(ChangedData::memory_bytes).sum();
        self.data.memory_bytes() + later
    }

    /// The names behind the ids of a Cryptomatte layer; `None` for other layers.
    pub fn names(&self, layer: Layer) -> Option<BTreeSet<&str>> {
        let objects = self.objects.iter();
        match layer {
            Layer::CryptoObject => Some(objects.map(|object| &*object.name).collect()),
            Layer::CryptoMaterial => Some(objects.map(|object| &*object.material_name).collect()),
            _ => None,
        }
    }

    /// Most vertices of a path unless the user says so: among bodies that scatter, many more than elsewhere, since most of
    /// theirs are within a body.
    pub fn default_max_depth(&self) -> u32 {
        let media = self.structure.between.media;
        match media.map(|media| media.matter) {
            Some(MatterNode::AbsorptionAndScattering) => 256,
            Some(MatterNode::Absorption) | None => 8,
        }
    }

    /// How far a tracer reaches unless it is told: [`reach`](residual_render::tracer::TracerOptions::reach).
    pub fn default_reach(&self) -> f32 {
        match self.structure.tracer {
            TracerNode::AmbientOcclusion => 0.1 * self.diagonal,
            TracerNode::Path(_) | TracerNode::Bidirectional(_) | TracerNode::Debug(_) => self.depth,
        }
    }
}

/// An instance of a mesh that is seen.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlannedObject {
    /// The instance's name.
    pub name: String,
    /// Index of its material in the description.
    pub material: usize,
    /// The material's name.
    pub material_name: String,
    /// Its triangles.
    pub triangles: Range<u32>,
}

/// A material that uses a program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MaterialUse {
    /// Its name.
    pub name: String,
    /// Names of the images that it reads, by their slots among its parameters.
    pub images: BTreeMap<u32, String>,
    /// Its surfaces are not seen from behind.
    pub culled: bool,
    /// Its surfaces bound bodies that absorb.
    pub absorbs: bool,
    /// Its surfaces bound bodies that scatter.
    pub scatters: bool,
    /// Its surfaces bound bodies in a scene with media.
    pub body: bool,
}

/// The lights of a kind.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct LightKindUse {
    /// How many there are.
    pub count: usize,
    /// Where they come from, such as `light "Sun"`, each once.
    pub sources: Vec<String>,
}
