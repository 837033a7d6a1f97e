//! Rays sorted by what they have in common.

use crate::ray::Ray;

/// The indices of at most `LEN` rays, in the order of their keys, which are below `KEYS`; those of equal keys in
/// their order.
pub(crate) struct Sorted<const LEN: usize, const KEYS: usize> {
    pub(crate) order: [u16; LEN],
    /// Where the indices of each key end.
    pub(crate) ends: [u16; KEYS],
}

impl<const LEN: usize, const KEYS: usize> Sorted<LEN, KEYS> {
    #[inline(always)]
    pub(crate) fn by_key(rays: &[Ray], key: impl Fn(&Ray) -> usize) -> Self {
        const { assert!(LEN <= 1 << 16 && KEYS <= 1 << 8) };
        let mut keys = [0u8; LEN];
        let mut ends = [0u16; KEYS];
        for (ray, key_of_ray) in rays.iter().zip(&mut keys) {
            *key_of_ray = key(ray) as u8;
            ends[*key_of_ray as usize] += 1;
        }
        let mut start = 0;
        for end in &mut ends {
            (*end, start) = (start, start + *end);
        }
        let mut order = [0u16; LEN];
        for (ray, &key) in keys[..rays.len()].iter().enumerate() {
            let end = &mut ends[key as usize];
            order[*end as usize] = ray as u16;
            *end += 1;
        }
        Sorted { order, ends }
    }
}
