//! The list of lights, and how one of them is picked: by an alias table.

use crate::alias_table::{AliasEntry, AliasTable, BELOW_ONE, Outcome};
use crate::domain::{Buffer, Domain};
use crate::record::{BufferRecord, record};
use crate::scene_data::SceneData;

/// Words from one light to the next in [`Buffer::Lights`]: enough for the record of every kind.
pub const LIGHT_WORDS: u32 = 12;

record! {
    /// What the record of every light begins with.
    pub struct LightRecord {
        row {
            /// Index of its kind in the scene's list of kinds.
            kind: word,
        }
    }
}

/// The kind of a light, and the first word of its record.
#[inline(always)]
pub(super) fn find<D: Domain>(d: D, light: D::U) -> (D::U, D::U) {
    let record = light * d.uint(LIGHT_WORDS);
    let kind = record + d.uint(LightRecord::offsets().kind);
    (d.load(Buffer::Lights, kind), record)
}

record! {
    /// What lies before the table over the lights in [`Buffer::LightAlias`].
    pub struct PickHeader {
        row {
            /// How many lights there are.
            count: word,
        }
    }
}

/// The table over the lights, whose densities are the probabilities of picks.
const PICKS: AliasTable = AliasTable {
    buffer: Buffer::LightAlias,
    first: PickHeader::WORDS,
};

/// A picked light.
#[derive(Clone, Copy, Debug)]
pub struct Pick<D: Domain> {
    /// Index of its kind in the scene's list of kinds.
    pub kind: D::U,
    /// First word of its record.
    pub record: D::U,
    /// The probability of the pick.
    pub probability: D::F,
    /// Two numbers in [0, 1) for a place on the light.
    pub place: [D::F; 2],
}

/// Picks a light with the first of two numbers, and makes of both two numbers for a place on it.
///
/// Points that are well spread over the square are so over each light, too, for a light takes a strip of the square, or a few.
/// Numbers of their own for the place would be spread over all lights' samples together, and at random over those of each.
#[inline(always)]
pub fn pick<D: Domain>(d: D, [u, v]: [D::F; 2]) -> Pick<D> {
    let header = PickHeader::uniform_at(d, Buffer::LightAlias, 0);
    let count = d.to_real(header.count);
    let scaled = u * count;
    let slot = d.min(d.floor(scaled), count - d.lit(1.0));
    // Among thousands of lights few digits are left of the 24: digits of the other number follow them.
    let digits = v * d.lit(4096.0);
    let digits = (digits - d.floor(digits)) * count;
    let within = d.fma(digits, d.lit(1.0 / (1 << 24) as f64), scaled - slot);
    let Outcome {
        index,
        density,
        rest,
    } = PICKS.resolve(d, d.to_uint(slot), d.min(within, d.lit(BELOW_ONE)));
    let (kind, record) = find(d, index);
    Pick {
        kind,
        record,
        probability: density,
        place: [rest, v],
    }
}

/// The probability of picking a light.
#[inline(always)]
pub fn pick_probability<D: Domain>(d: D, light: D::U) -> D::F {
    PICKS.density(d, light)
}

/// Adds a light.
pub fn push_light<R: BufferRecord>(data: &mut SceneData, record: R) {
    const { assert!(R::WORDS <= LIGHT_WORDS) };
    let lights = data.buffer_mut(Buffer::Lights);
    record.append_to(lights);
    lights.resize(lights.len().next_multiple_of(LIGHT_WORDS as usize), 0);
}

/// Sets the table from which lights are picked: an entry each.
pub fn set_picks(data: &mut SceneData, entries: impl ExactSizeIterator<Item = AliasEntry>) {
    let buffer = data.buffer_mut(Buffer::LightAlias);
    buffer.clear();
    let count = entries.len() as u32;
    PickHeader { count }.append_to(buffer);
    entries.for_each(|entry| entry.append_to(buffer));
}
