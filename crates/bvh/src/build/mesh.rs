//! The triangles of a build.

/// The triangles' corners and marks, as the build sees them.
#[derive(Clone, Copy)]
pub(crate) struct Mesh<'a> {
    pub(crate) positions: &'a [[f32; 3]],
    pub(crate) triangles: &'a [[u32; 3]],
    pub(crate) single_sided: Option<&'a [bool]>,
}

impl Mesh<'_> {
    #[inline]
    pub(crate) fn vertices(&self, prim: u32) -> [[f32; 3]; 3] {
        self.triangles[prim as usize].map(|vertex| self.positions[vertex as usize])
    }

    pub(crate) fn is_single_sided(&self, prim: u32) -> bool {
        self.single_sided.is_some_and(|marks| marks[prim as usize])
    }
}

/// Whether the vertices are finite and not collinear. In `f64` the products of any two `f32`
/// differences neither overflow nor vanish.
pub(crate) fn has_area(vertices: &[[f32; 3]; 3]) -> bool {
    let [a, b, c] = vertices.map(|vertex| vertex.map(f64::from));
    let edge = |p: [f64; 3]| [p[0] - a[0], p[1] - a[1], p[2] - a[2]];
    let (e, f) = (edge(b), edge(c));
    let normal = [
        e[1] * f[2] - e[2] * f[1],
        e[2] * f[0] - e[0] * f[2],
        e[0] * f[1] - e[1] * f[0],
    ];
    vertices.iter().flatten().all(|x| x.is_finite()) && normal != [0.0; 3]
}
