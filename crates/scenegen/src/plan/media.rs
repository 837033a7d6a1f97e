//! The media that bodies are filled with, and how bodies lie to each other.

use std::collections::BTreeMap;

use glam::Vec3A;
use residual_render::record::BufferRecord;
use residual_render::tracer::{AnyNesting, MatterNode, MediaNode, MediumRecord, Nested};

use super::closed::Closed;
use super::options::BodyRule;
use crate::desc::{
    Attenuation, MaterialDesc, MeshDesc, Pose, Scattering, SceneDesc, SurfaceDesc, Warning,
    WarningKind,
};

/// What a body is filled with, and how it goes before others.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Medium {
    attenuation: Option<Attenuation>,
    scattering: Option<Scattering>,
    /// Index of refraction; 1 where bodies lie beside each other, where nothing reads it.
    ior: f32,
    priority: i32,
}

/// The media of a scene. Index 0 is the outside, which is empty.
#[derive(Default)]
pub(super) struct Media {
    /// What paths meet; `None` if bodies are all empty and beside each other.
    pub(super) node: Option<MediaNode>,
    pub(super) warnings: Vec<Warning>,
    media: Vec<Medium>,
    /// For each material, what its bodies are filled with, if its surfaces are those of bodies.
    interiors: Vec<Option<u32>>,
}

impl Media {
    /// The media of the materials that are seen.
    pub(super) fn of(scene: &SceneDesc, seen: &[bool], closed: &Closed, rule: BodyRule) -> Self {
        let bodies: Vec<_> = (scene.materials.iter().zip(&closed.materials))
            .zip(seen)
            .map(|((material, closed), seen)| body(material, *closed).filter(|_| *seen))
            .collect();
        let mut media = Self::default();
        let mut nesting = match rule {
            BodyRule::Nested
                if scene
                    .poses()
                    .any(|pose| some_overlap(scene, pose, closed, &bodies)) =>
            {
                AnyNesting::Nested
            }
            BodyRule::Nested | BodyRule::Beside => AnyNesting::Beside,
        };
        if nesting == AnyNesting::Nested {
            media.list(&bodies, |_| true);
            if media.media.len() > Nested::MAX_MEDIUM as usize {
                media.warnings.push(Warning {
                    kind: WarningKind::Unfaithful,
                    place: "materials".to_owned(),
                    message: format!(
                        "{} kinds of bodies, some of them within others, are more than {}; bodies are taken to lie beside \
                         each other",
                        media.media.len(),
                        Nested::MAX_MEDIUM
                    ),
                });
                nesting = AnyNesting::Beside;
            }
        }
        if nesting == AnyNesting::Beside {
            let beside = |medium: &Medium| Medium {
                ior: 1.0,
                priority: 0,
                ..*medium
            };
            let bodies: Vec<_> = bodies
                .iter()
                .map(|body| body.as_ref().map(beside))
                .collect();
            media.list(&bodies, |medium| medium.attenuation.is_some());
        }
        let has = |what: fn(&Medium) -> bool| media.media.iter().any(what);
        if nesting == AnyNesting::Nested || has(|medium| medium.attenuation.is_some()) {
            media.node = Some(MediaNode {
                nesting,
                matter: match has(|medium| medium.scattering.is_some()) {
                    true => MatterNode::AbsorptionAndScattering,
                    false => MatterNode::Absorption,
                },
            });
        }
        media
    }

    /// Lists the media of bodies, each once, those of low priority first; others than those that are to be listed are as the
    /// outside.
    fn list(&mut self, bodies: &[Option<Medium>], is_listed: impl Fn(&Medium) -> bool) {
        let mut media: Vec<Medium> = Vec::new();
        for medium in bodies.iter().flatten() {
            if is_listed(medium) && !media.contains(medium) {
                media.push(*medium);
            }
        }
        media.sort_by_key(|medium| medium.priority);
        let index = |medium: &Medium| {
            let place = media.iter().position(|other| other == medium);
            place.map_or(0, |place| place as u32 + 1)
        };
        self.interiors = bodies.iter().map(|body| body.as_ref().map(index)).collect();
        self.media = media;
    }

    /// The index of the medium behind the surfaces of a material, if paths meet media and the surfaces bound bodies.
    pub(super) fn interior(&self, material: usize) -> Option<u32> {
        self.node?;
        self.interiors[material]
    }

    /// How bodies lie to each other.
    pub(super) fn nesting(&self) -> AnyNesting {
        self.node.map_or(AnyNesting::Beside, |node| node.nesting)
    }

    /// What fills the bodies of a material absorbs light.
    pub(super) fn absorbs(&self, material: usize) -> bool {
        self.filling(material)
            .is_some_and(|medium| medium.attenuation.is_some() && medium.scattering.is_none())
    }

    /// What fills the bodies of a material scatters light.
    pub(super) fn scatters(&self, material: usize) -> bool {
        self.filling(material)
            .is_some_and(|medium| medium.scattering.is_some())
    }

    fn filling(&self, material: usize) -> Option<&Medium> {
        let index = self.interior(material)?.checked_sub(1)?;
        Some(&self.media[index as usize])
    }

    /// The records of all media.
    pub(super) fn words(&self) -> Vec<u32> {
        let mut words = Vec::new();
        let outside = Medium {
            attenuation: None,
            scattering: None,
            ior: 1.0,
            priority: i32::MIN,
        };
        for medium in std::iter::once(&outside).chain(&self.media) {
            let above = self
                .media
                .partition_point(|other| other.priority <= medium.priority);
            medium.record(above as u32 + 1).append_to(&mut words);
        }
        words
    }
}

impl Medium {
    fn record(&self, above: u32) -> MediumRecord {
        let halvings = |Attenuation { color, distance }: Attenuation| {
            // In f64: the logarithm of a colour near 1 is small.
            color.map(|c| (-f64::from(c).log2() / f64::from(distance)) as f32)
        };
        let albedo = |scattering: Scattering| scattering.multiscatter_color.map(single_albedo);
        MediumRecord {
            halvings: self.attenuation.map_or([0.0; 3], halvings).into(),
            ior: self.ior,
            albedo: self.scattering.map_or([0.0; 3], albedo).into(),
            anisotropy: self
                .scattering
                .map_or(0.0, |scattering| scattering.anisotropy),
            above,
            around_camera: 0,
        }
    }
}

/// The share of light that a single scattering leaves, of the share that a thick layer does (Kulla and Conty Estevez 2017,
/// "Revisiting physically based shading at Imageworks"; KHR_materials_volume_scatter).
fn single_albedo(multiple: f32) -> f32 {
    let c = f64::from(multiple);
    let root = (9.59217 + 41.6808 * c + 17.7126 * c * c).sqrt();
    let s = 4.09712 + 4.20863 * c - root;
    (1.0 - s * s).clamp(0.0, 1.0) as f32
}

/// What the bodies are filled with whose surfaces are of a material; `None` where it has no bodies.
fn body(material: &MaterialDesc, is_closed: bool) -> Option<Medium> {
    match &material.surface {
        SurfaceDesc::MetallicRoughness(surface) => {
            let refracts = surface.transmission.factor > 0.0 && (surface.solid || is_closed);
            (refracts || surface.is_translucent()).then(|| Medium {
                attenuation: surface.attenuation,
                scattering: surface.scattering.filter(|_| surface.attenuation.is_some()),
                ior: surface.ior.max(1.0),
                priority: surface.priority,
            })
        }
        SurfaceDesc::Dielectric { ior, .. } => Some(Medium {
            attenuation: None,
            scattering: None,
            ior: *ior,
            priority: 0,
        }),
        _ => None,
    }
}

/// Whether the boxes of two bodies overlap, so that one may be within the other. Closed meshes are bodies of their own; what
/// else has one material may together be one.
fn some_overlap(
    scene: &SceneDesc,
    pose: Pose<'_>,
    closed: &Closed,
    bodies: &[Option<Medium>],
) -> bool {
    let mut boxes = Vec::new();
    let mut parts: BTreeMap<usize, [Vec3A; 2]> = BTreeMap::new();
    for instance in pose.instances {
        let mesh = &scene.meshes[instance.mesh];
        if bodies[mesh.material].is_none() {
            continue;
        }
        let Some(bounds) = bounds(mesh, |p| instance.transform.transform_point3a(p)) else {
            continue;
        };
        match closed.meshes[instance.mesh] {
            true => boxes.push(bounds),
            false => {
                let all = parts.entry(mesh.material).or_insert(bounds);
                *all = union(*all, bounds);
            }
        }
    }
    boxes.extend(parts.into_values());
    boxes.sort_by(|a, b| a[0].x.total_cmp(&b[0].x));
    boxes.iter().enumerate().any(|(i, [low, high])| {
        let mut near = boxes[i + 1..]
            .iter()
            .take_while(|other| other[0].x < high.x);
        near.any(|other| other[0].cmplt(*high).all() && low.cmplt(other[1]).all())
    })
}

fn union(a: [Vec3A; 2], b: [Vec3A; 2]) -> [Vec3A; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

fn bounds(mesh: &MeshDesc, to_world: impl Fn(Vec3A) -> Vec3A) -> Option<[Vec3A; 2]> {
    let points = mesh.positions.iter().map(|&p| to_world(p.into()));
    points
        .map(|p| [p, p])
        .reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
}
