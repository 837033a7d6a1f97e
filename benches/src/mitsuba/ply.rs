//! Meshes as binary PLY files.

use std::collections::HashMap;

/// A corner of a triangle: where it is, the normal that it has for shading, and where textures are read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Corner {
    pub(super) position: [f32; 3],
    /// `None` where the triangle is flat.
    pub(super) normal: Option<[f32; 3]>,
    /// `None` where no texture is.
    pub(super) uv: Option<[f32; 2]>,
}

impl Corner {
    fn numbers(&self) -> impl Iterator<Item = f32> {
        self.position
            .into_iter()
            .chain(self.normal.into_iter().flatten())
            .chain(self.uv.into_iter().flatten())
    }
}

/// A mesh whose corners are shared where they are the same to the last bit.
#[derive(Debug, Default)]
pub(super) struct PlyMesh {
    has: Has,
    vertices: Vec<Corner>,
    triangles: Vec<[u32; 3]>,
    known: HashMap<Vec<u32>, u32>,
}

/// What corners have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Has {
    pub(super) normals: bool,
    pub(super) uvs: bool,
}

impl PlyMesh {
    /// A mesh without triangles.
    pub(super) fn new(has: Has) -> Self {
        Self {
            has,
            ..Self::default()
        }
    }

    /// Adds a triangle.
    ///
    /// # Panics
    /// If a corner has what corners of the mesh do not have, or the other way round.
    pub(super) fn push(&mut self, corners: [Corner; 3]) {
        let indices = corners.map(|corner| self.vertex(corner));
        self.triangles.push(indices);
    }

    fn vertex(&mut self, corner: Corner) -> u32 {
        let has = Has {
            normals: corner.normal.is_some(),
            uvs: corner.uv.is_some(),
        };
        assert_eq!(has, self.has);
        let bits = corner.numbers().map(f32::to_bits).collect();
        *self.known.entry(bits).or_insert_with(|| {
            self.vertices.push(corner);
            self.vertices.len() as u32 - 1
        })
    }

    /// The file.
    pub(super) fn bytes(&self) -> Vec<u8> {
        let mut names = vec!["x", "y", "z"];
        if self.has.normals {
            names.extend(["nx", "ny", "nz"]);
        }
        if self.has.uvs {
            names.extend(["u", "v"]);
        }
        let properties: String = names
            .iter()
            .map(|name| format!("property float {name}\n"))
            .collect();
        let mut bytes = format!(
            "ply\nformat binary_little_endian 1.0\nelement vertex {}\n{properties}\
             element face {}\nproperty list uchar int vertex_indices\nend_header\n",
            self.vertices.len(),
            self.triangles.len(),
        )
        .into_bytes();
        for number in self.vertices.iter().flat_map(Corner::numbers) {
            bytes.extend(number.to_le_bytes());
        }
        for triangle in &self.triangles {
            bytes.push(3);
            bytes.extend(triangle.iter().flat_map(|index| index.to_le_bytes()));
        }
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_are_shared_and_the_file_has_what_its_header_says() {
        let corner = |x: f32, y: f32| Corner {
            position: [x, y, 0.0],
            normal: Some([0.0, 0.0, 1.0]),
            uv: Some([0.5 * x, 1.0 - y]),
        };
        let mut mesh = PlyMesh::new(Has {
            normals: true,
            uvs: true,
        });
        mesh.push([corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0)]);
        mesh.push([corner(0.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)]);
        let bytes = mesh.bytes();
        let end = b"end_header\n";
        let start = bytes.windows(end.len()).position(|w| w == end).unwrap() + end.len();
        let header = std::str::from_utf8(&bytes[..start]).unwrap();
        assert!(header.contains("element vertex 4\n"), "{header}");
        assert!(header.contains("element face 2\n"), "{header}");
        let names = header
            .lines()
            .filter_map(|line| line.strip_prefix("property float "));
        let names: Vec<_> = names.collect();
        assert_eq!(names, ["x", "y", "z", "nx", "ny", "nz", "u", "v"]);
        assert_eq!(bytes.len() - start, 4 * 8 * 4 + 2 * (1 + 3 * 4));
        // The last triangle refers to vertices 0, 2 and 3.
        let last = &bytes[bytes.len() - 12..];
        let index = |k: usize| u32::from_le_bytes(last[4 * k..4 * k + 4].try_into().unwrap());
        assert_eq!([index(0), index(1), index(2)], [0, 2, 3]);
        // The second vertex.
        let second = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.5, 1.0_f32];
        let second: Vec<u8> = second.into_iter().flat_map(f32::to_le_bytes).collect();
        assert_eq!(bytes[start + 32..start + 64], second);
    }
}
