//! Cryptomatte: which objects and materials cover how much of a pixel, for mattes in compositing (Friedman and Jones 2015;
//! specification 1.2.0). A name's hash, as a floating-point number, is its id in every image.

/// How many ids a pixel keeps: those that cover most of it.
pub const LEVELS: usize = 6;

/// The id where nothing is seen.
pub const NOTHING: f32 = 0.0;

/// The id of a name: its hash, bit by bit, but for exponents that numbers which are zero, subnormal, infinite or NaN have.
pub fn id(name: &str) -> f32 {
    let hash = murmur3(name.as_bytes());
    let exponent = hash >> 23 & 0xff;
    f32::from_bits(match exponent {
        0 | 0xff => hash ^ 1 << 23,
        _ => hash,
    })
}

/// The bits of a name's id, as manifests have them: eight hexadecimal digits.
pub fn digits(name: &str) -> String {
    format!("{:08x}", id(name).to_bits())
}

/// MurmurHash3_x86_32 with seed 0 (Appleby).
fn murmur3(bytes: &[u8]) -> u32 {
    let mix = |word: u32| {
        let word = word.wrapping_mul(0xcc9e_2d51);
        word.rotate_left(15).wrapping_mul(0x1b87_3593)
    };
    let (words, rest) = bytes.as_chunks();
    let mut hash = 0;
    for word in words {
        hash ^= mix(u32::from_le_bytes(*word));
        hash = hash.rotate_left(13).wrapping_mul(5);
        hash = hash.wrapping_add(0xe654_6b64);
    }
    let mut last = [0; 4];
    last[..rest.len()].copy_from_slice(rest);
    // Without a rest this changes nothing: 0 is mixed to 0.
    hash ^= mix(u32::from_le_bytes(last));
    hash ^= bytes.len() as u32;
    hash = (hash ^ hash >> 16).wrapping_mul(0x85eb_ca6b);
    hash = (hash ^ hash >> 13).wrapping_mul(0xc2b2_ae35);
    hash ^ hash >> 16
}

/// The ids that the samples of a pixel have, and how many have each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Coverage(Vec<(u32, u32)>);

impl Coverage {
    /// Counts a sample.
    pub fn add(&mut self, id: f32) {
        let id = id.to_bits();
        match self.0.iter_mut().find(|(other, _)| *other == id) {
            Some((_, count)) => *count += 1,
            None => self.0.push((id, 1)),
        }
    }

    /// Ids, each with the part of the pixel that it covers, the largest first; then zeros. It does not matter in which order
    /// samples were counted.
    pub fn ranked(&self) -> [[f32; 2]; LEVELS] {
        let samples: u64 = self.0.iter().map(|&(_, count)| u64::from(count)).sum();
        let mut ids = self.0.clone();
        ids.sort_unstable_by_key(|&(id, count)| (std::cmp::Reverse(count), id));
        let mut ranked = [[0.0; 2]; LEVELS];
        for (rank, (id, count)) in ranked.iter_mut().zip(ids) {
            let part = f64::from(count) / samples as f64;
            *rank = [f32::from_bits(id), part as f32];
        }
        ranked
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of the specification, its sample images and the tests of its authors.
    #[test]
    fn ids_are_those_of_the_specification() {
        assert_eq!(murmur3("torus".as_bytes()), 4_053_562_365);
        assert_eq!(murmur3("равнина".as_bytes()), 2_518_896_926);
        assert_eq!(id("torus"), -1.549_436_248_32e30);
        assert_eq!(id("равнина"), -1.319_263_121_24e-25);
        assert_eq!(id("hello"), 6.070_562_710_240_000_5e-17);
        assert_eq!(id("mädchen"), 6.236_129_821_159_999_7e25);
        for (name, expected) in [
            ("bunny", "13851a76"),
            ("default", "42c9679f"),
            ("bunny_porcelain_mat", "b24b26d4"),
            ("name, with, comma", "62fa4db8"),
            ("name containing a \"quote\"  ", "af8bfa09"),
            ("ball_asset", "79b62f5e"),
            ("/obj/box:polygons:1", "9d416418"),
        ] {
            assert_eq!(digits(name), expected, "{name}");
        }
    }

    #[test]
    fn exponents_of_no_normal_number_are_moved() {
        // Names whose hashes have the exponents 0 and 255.
        let with_exponent = |wanted: u32| {
            let mut names = (0..).map(|k: u32| k.to_string());
            let found = names.find(|name| murmur3(name.as_bytes()) >> 23 & 0xff == wanted);
            found.expect("numbers do not end")
        };
        for (exponent, moved) in [(0, 1), (255, 254), (1, 1), (254, 254)] {
            let name = with_exponent(exponent);
            let bits = id(&name).to_bits();
            assert_eq!(bits >> 23 & 0xff, moved, "{name}");
            assert_eq!(bits & 0x807f_ffff, murmur3(name.as_bytes()) & 0x807f_ffff);
            assert!(id(&name).is_normal());
        }
    }

    #[test]
    fn ranks_go_by_coverage_and_not_by_order() {
        let samples = [1.0, 2.0, 2.0, 3.0, 0.0, 2.0, 3.0, 1.0];
        let ranked = |samples: &mut dyn Iterator<Item = f32>| {
            let mut coverage = Coverage::default();
            samples.for_each(|id| coverage.add(id));
            coverage.ranked()
        };
        let forwards = ranked(&mut samples.into_iter());
        assert_eq!(
            forwards[..5],
            [
                [2.0, 0.375],
                [1.0, 0.25],
                [3.0, 0.25],
                [0.0, 0.125],
                [0.0; 2]
            ]
        );
        assert_eq!(forwards, ranked(&mut samples.into_iter().rev()));
        // What is beyond the levels is left out, and the rest keeps its parts.
        let many = ranked(&mut (0..8).map(|k| k as f32));
        assert_eq!(many.map(|[_, part]| part), [0.125; LEVELS]);
        assert_eq!(ranked(&mut [].into_iter()), [[0.0; 2]; LEVELS]);
    }
}
