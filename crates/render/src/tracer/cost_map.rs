//! The cost of traversal as a heat map.

/// From visited nodes and packets to colours: black, blue, cyan, green, yellow, red, white, each step of which is a
/// doubling.
#[derive(Clone, Copy, Debug)]
pub struct CostMap;

impl CostMap {
    /// What is shown as white, and everything dearer.
    pub const MOST: u32 = 1 << (Self::COLORS.len() - 1);

    const COLORS: [[f32; 3]; 10] = [
        [0.0, 0.0, 0.0],
        [0.0, 0.0, 0.3],
        [0.0, 0.0, 1.0],
        [0.0, 0.5, 1.0],
        [0.0, 1.0, 0.5],
        [0.2, 1.0, 0.0],
        [1.0, 1.0, 0.0],
        [1.0, 0.4, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 1.0],
    ];

    /// The colour of a number of visits.
    pub fn color(self, visits: u32) -> [f32; 3] {
        let place = (visits.clamp(1, Self::MOST) as f32).log2();
        let low = (place as usize).min(Self::COLORS.len() - 2);
        let t = place - low as f32;
        [0, 1, 2].map(|k| Self::COLORS[low][k] * (1.0 - t) + Self::COLORS[low + 1][k] * t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cost_map_goes_from_black_to_white_without_jumps() {
        assert_eq!(CostMap.color(0), [0.0; 3]);
        assert_eq!(CostMap.color(1), [0.0; 3]);
        assert_eq!(CostMap.color(CostMap::MOST), [1.0; 3]);
        assert_eq!(CostMap.color(u32::MAX), [1.0; 3]);
        for visits in 4..CostMap::MOST {
            let (a, b) = (CostMap.color(visits), CostMap.color(visits + 1));
            let step = (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f32::max);
            assert!(step < 0.35 && a != b, "{visits}: {a:?} {b:?}");
        }
    }
}
