//! Meshes and rays for queries.

use std::collections::HashMap;

use residual_bvh::Ray;

/// A 64-bit linear congruential generator (Knuth's constants).
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        let mut random = Self(seed);
        random.bits();
        random
    }

    fn bits(&mut self) -> u32 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 32) as u32
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        self.bits() as usize % n
    }

    /// In [0, 1).
    pub(crate) fn unit(&mut self) -> f32 {
        (self.bits() >> 8) as f32 / (1 << 24) as f32
    }

    /// In a cube around a point.
    pub(crate) fn near(&mut self, center: [f32; 3], half: f32) -> [f32; 3] {
        center.map(|x| x + (2.0 * self.unit() - 1.0) * half)
    }
}

/// Triangles.
pub(crate) struct Mesh {
    pub(crate) positions: Vec<[f32; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// For each triangle: it is seen from its front only. Empty where none is.
    pub(crate) single_sided: Vec<bool>,
}

impl Mesh {
    fn corners(&self, triangle: usize) -> [[f32; 3]; 3] {
        self.triangles[triangle].map(|vertex| self.positions[vertex as usize])
    }

    pub(crate) fn vertex(&self, random: &mut Random) -> [f32; 3] {
        self.corners(random.below(self.triangles.len()))[random.below(3)]
    }

    /// Two corners of a random triangle, and a point between them.
    pub(crate) fn edge(&self, random: &mut Random) -> [[f32; 3]; 3] {
        let corners = self.corners(random.below(self.triangles.len()));
        let corner = random.below(3);
        let (a, b, weight) = (corners[corner], corners[(corner + 1) % 3], random.unit());
        [a, b, [0, 1, 2].map(|k| a[k] + weight * (b[k] - a[k]))]
    }

    /// The middle and half the longest side of the box around all.
    pub(crate) fn center_and_half(&self) -> ([f32; 3], f32) {
        let side = |k: usize| {
            let of_axis = || self.positions.iter().map(move |position| position[k]);
            [
                of_axis().fold(f32::MAX, f32::min),
                of_axis().fold(f32::MIN, f32::max),
            ]
        };
        let sides = [0, 1, 2].map(side);
        let half = sides.map(|[low, high]| (high - low) / 2.0);
        let center = sides.map(|[low, high]| (low + high) / 2.0);
        (center, half.into_iter().fold(0.0, f32::max))
    }
}

/// A closed sphere of 8 · 4^`levels` triangles around a point, every vertex moved outwards by up to half its radius.
pub(crate) fn jittered_sphere(center: [f32; 3], levels: usize, random: &mut Random) -> Mesh {
    let mut positions: Vec<[f32; 3]> = vec![
        [1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
    ];
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for [x, y, z] in [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4]] {
        triangles.extend([[x, y, z], [y, x, 5]]);
    }
    for _ in 0..levels {
        let mut middles = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let (p, q) = (positions[a as usize], positions[b as usize]);
                positions.push([0, 1, 2].map(|k| (p[k] + q[k]) * 0.5));
                positions.len() as u32 - 1
            })
        };
        let split = |&[a, b, c]: &[u32; 3]| {
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        triangles = triangles.iter().flat_map(split).collect();
    }
    for position in &mut positions {
        let radius = position.iter().map(|x| x * x).sum::<f32>().sqrt();
        let scale = (1.0 + 0.5 * random.unit()) / radius;
        *position = [0, 1, 2].map(|k| center[k] + position[k] * scale);
    }
    Mesh {
        positions,
        triangles,
        single_sided: Vec::new(),
    }
}

/// Squares in the plane z = 0, between whole coordinates: as many coincident edges and vertices as there can be.
pub(crate) fn grid(cells: u32) -> Mesh {
    let side = cells + 1;
    let places = (0..side).flat_map(|y| (0..side).map(move |x| [x as f32, y as f32, 0.0]));
    let squares = (0..cells).flat_map(|y| (0..cells).map(move |x| y * side + x));
    Mesh {
        positions: places.collect(),
        triangles: squares
            .flat_map(|a| [[a, a + 1, a + side], [a + 1, a + side + 1, a + side]])
            .collect(),
        single_sided: Vec::new(),
    }
}

/// From a point towards another, as far as it goes.
pub(crate) fn aimed(org: [f32; 3], target: [f32; 3]) -> Ray {
    Ray::unbounded(org, [0, 1, 2].map(|k| target[k] - org[k]))
}
