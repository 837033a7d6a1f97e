//! Meshes for the tests.

use crate::random::Random;

#[derive(Clone, Default)]
pub(crate) struct Mesh {
    pub(crate) positions: Vec<[f32; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Empty, or a mark for each triangle.
    pub(crate) single_sided: Vec<bool>,
}

impl Mesh {
    pub(crate) fn vertices(&self, prim: usize) -> [[f32; 3]; 3] {
        self.triangles[prim].map(|vertex| self.positions[vertex as usize])
    }

    pub(crate) fn push(&mut self, vertices: [[f32; 3]; 3]) {
        let first = self.positions.len() as u32;
        self.positions.extend(vertices);
        self.triangles.push([first, first + 1, first + 2]);
    }

    pub(crate) fn marked(mut self, random: &mut Random) -> Mesh {
        self.single_sided = self
            .triangles
            .iter()
            .map(|_| random.below(2) == 0)
            .collect();
        self
    }

    /// A point on a random edge of a random triangle.
    pub(crate) fn edge_point(&self, random: &mut Random) -> [f32; 3] {
        let vertices = self.vertices(random.below(self.triangles.len()));
        let corner = random.below(3);
        let (a, b, weight) = (vertices[corner], vertices[(corner + 1) % 3], random.unit());
        [0, 1, 2].map(|axis| a[axis] + weight * (b[axis] - a[axis]))
    }

    pub(crate) fn vertex(&self, random: &mut Random) -> [f32; 3] {
        self.vertices(random.below(self.triangles.len()))[random.below(3)]
    }

    pub(crate) fn translated(mut self, offset: f32) -> Mesh {
        for position in &mut self.positions {
            *position = position.map(|x| x + offset);
        }
        self
    }
}

/// Separate triangles in the cube [-1, 1]³, with edges of about `size`.
pub(crate) fn soup(count: usize, size: f32, random: &mut Random) -> Mesh {
    let mut mesh = Mesh::default();
    for _ in 0..count {
        let center = random.in_cube(1.0);
        mesh.push([0; 3].map(|_| {
            let offset = random.in_cube(size);
            [0, 1, 2].map(|axis| center[axis] + offset[axis])
        }));
    }
    mesh
}

/// A closed sphere of 20 · 4^`levels` triangles around the origin, every vertex moved outwards by
/// up to half its radius.
pub(crate) fn jittered_icosphere(levels: usize, random: &mut Random) -> Mesh {
    let phi = (1.0 + 5f32.sqrt()) / 2.0;
    let mut positions: Vec<[f32; 3]> = Vec::new();
    for (a, b) in [(1.0, phi), (-1.0, phi), (1.0, -phi), (-1.0, -phi)] {
        positions.extend([[a, b, 0.0], [0.0, a, b], [b, 0.0, a]]);
    }
    // The faces are the triples at mutual distance 2, wound to face outwards.
    let squared = |p: [f32; 3], q: [f32; 3]| (0..3).map(|i| (p[i] - q[i]).powi(2)).sum::<f32>();
    let near = |i: usize, j: usize| (squared(positions[i], positions[j]) - 4.0).abs() < 0.01;
    let mut triangles = Vec::new();
    for (i, j, k) in (0..12).flat_map(|i| (0..i).flat_map(move |j| (0..j).map(move |k| (i, j, k))))
    {
        if near(i, j) && near(j, k) && near(k, i) {
            let [a, b, c] = [i, j, k].map(|v| glam::Vec3::from(positions[v]));
            let outwards = (b - a).cross(c - a).dot(a) > 0.0;
            triangles.push(if outwards { [i, j, k] } else { [i, k, j] }.map(|v| v as u32));
        }
    }
    assert_eq!(triangles.len(), 20);

    for _ in 0..levels {
        let mut middles = std::collections::HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let (p, q) = (positions[a as usize], positions[b as usize]);
                positions.push([0, 1, 2].map(|axis| (p[axis] + q[axis]) * 0.5));
                positions.len() as u32 - 1
            })
        };
        triangles = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    for position in &mut positions {
        let radius = position.iter().map(|x| x * x).sum::<f32>().sqrt();
        let scale = (1.0 + 0.5 * random.unit()) / radius;
        *position = position.map(|x| x * scale);
    }
    Mesh {
        positions,
        triangles,
        single_sided: Vec::new(),
    }
}

/// A plane at z = 0 of `cells`² squares between whole coordinates.
pub(crate) fn grid(cells: usize) -> Mesh {
    let side = cells as u32 + 1;
    let mut mesh = Mesh::default();
    for y in 0..side {
        mesh.positions
            .extend((0..side).map(|x| [x as f32, y as f32, 0.0]));
    }
    for y in 0..side - 1 {
        for x in 0..side - 1 {
            let a = y * side + x;
            mesh.triangles
                .extend([[a, a + 1, a + side], [a + 1, a + side + 1, a + side]]);
        }
    }
    mesh
}

/// A disc around the z axis: a fan of `count` triangles.
pub(crate) fn fan(count: usize) -> Mesh {
    let mut mesh = Mesh {
        positions: vec![[0.1, 0.2, 0.3]],
        ..Mesh::default()
    };
    for i in 0..count {
        let (s, c) = (std::f32::consts::TAU * i as f32 / count as f32).sin_cos();
        mesh.positions.push([c, s, 0.0]);
        mesh.triangles
            .push([0, 1 + i as u32, 1 + ((i + 1) % count) as u32]);
    }
    mesh
}
