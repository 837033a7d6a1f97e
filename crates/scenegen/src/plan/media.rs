//! The media that bodies are filled with.

use residual_render::record::BufferRecord;
use residual_render::tracer::MediumRecord;

use crate::desc::Attenuation;

/// The media of a scene, each once. Index 0 is the outside, which absorbs nothing.
#[derive(Default)]
pub(super) struct Media {
    inside: Vec<Attenuation>,
}

impl Media {
    /// The index of a medium; that of the outside for none.
    pub(super) fn index(&mut self, attenuation: Option<Attenuation>) -> u32 {
        let Some(attenuation) = attenuation else {
            return 0;
        };
        let known = self.inside.iter().position(|other| *other == attenuation);
        let place = known.unwrap_or_else(|| {
            self.inside.push(attenuation);
            self.inside.len() - 1
        });
        place as u32 + 1
    }

    /// The records of all media.
    pub(super) fn words(&self) -> Vec<u32> {
        let mut words = Vec::new();
        let outside = MediumRecord {
            halvings: [0.0; 3].into(),
        };
        outside.append_to(&mut words);
        for Attenuation { color, distance } in &self.inside {
            // In f64: the logarithm of a colour near 1 is small.
            let halvings = color.map(|c| (-f64::from(c).log2() / f64::from(*distance)) as f32);
            let medium = MediumRecord {
                halvings: halvings.into(),
            };
            medium.append_to(&mut words);
        }
        words
    }
}
