//! The naive oracle: every triangle in turn, one scalar at a time, with the kernel's arithmetic.

use residual_bvh::{Culling, Hit, HitFilter, Ray};

use crate::mesh::Mesh;

/// The answer that a hierarchy must reproduce bit for bit.
pub(crate) fn closest_hit_of_all<F: HitFilter>(mesh: &Mesh, ray: &Ray, filter: &F) -> Hit {
    let mut best = Hit::miss(ray.tmax);
    if !is_valid(ray) {
        return best;
    }
    for prim in 0..mesh.triangles.len() {
        let vertices = mesh.vertices(prim);
        if !has_area(&vertices) {
            continue;
        }
        let one_side = match F::CULLING {
            Culling::None => false,
            Culling::Back => true,
            Culling::PerTriangle => mesh.single_sided.get(prim).is_some_and(|&mark| mark),
        };
        let Some([t, u, v]) = intersect(ray, &vertices, one_side) else {
            continue;
        };
        let hit = Hit {
            t,
            u,
            v,
            prim: prim as u32,
        };
        // Triangles come in the order of their indices: an equal distance does not win.
        if (t < best.t || !best.is_hit()) && (!F::REJECTS || filter.accept(ray, &hit)) {
            best = hit;
        }
    }
    best
}

fn is_valid(ray: &Ray) -> bool {
    let finite = ray.org.iter().chain(&ray.dir).all(|x| x.is_finite());
    let long = ray.dir.iter().any(|x| x.abs() >= f32::MIN_POSITIVE);
    finite && long && ray.tmin <= ray.tmax
}

fn has_area([a, b, c]: &[[f32; 3]; 3]) -> bool {
    let finite = [a, b, c].iter().all(|p| p.iter().all(|x| x.is_finite()));
    let edge = |p: &[f32; 3], axis: usize| f64::from(p[axis]) - f64::from(a[axis]);
    let flat = [(0, 1), (1, 2), (2, 0)]
        .iter()
        .all(|&(i, j)| edge(b, i) * edge(c, j) == edge(b, j) * edge(c, i));
    finite && !flat
}

/// `[t, u, v]` if the ray meets the triangle in its interval.
fn intersect(ray: &Ray, vertices: &[[f32; 3]; 3], one_side: bool) -> Option<[f32; 3]> {
    let size = ray.dir.map(f32::abs);
    let kz = if size[2] >= size[0] && size[2] >= size[1] {
        2
    } else if size[1] >= size[0] {
        1
    } else {
        0
    };
    let (mut kx, mut ky) = ((kz + 1) % 3, (kz + 2) % 3);
    if ray.dir[kz] < 0.0 {
        (kx, ky) = (ky, kx);
    }
    let (sx, sy, sz) = (
        ray.dir[kx] / ray.dir[kz],
        ray.dir[ky] / ray.dir[kz],
        1.0 / ray.dir[kz],
    );
    let [a, b, c] = vertices.map(|p| {
        let [x, y, z] = [kx, ky, kz].map(|axis| p[axis] - ray.org[axis]);
        [x - sx * z, y - sy * z, z]
    });
    let products = [
        (c[0] * b[1], c[1] * b[0]),
        (a[0] * c[1], a[1] * c[0]),
        (b[0] * a[1], b[1] * a[0]),
    ];
    let weights = products.map(|(p, q)| p - q);
    let front = weights.iter().all(|&weight| weight >= 0.0);
    let back = weights.iter().all(|&weight| weight <= 0.0);
    if !(front || back && !one_side) {
        return None;
    }
    let [wa, wb, wc] = weights;
    let determinant = wa + wb + wc;
    let inv = 1.0 / determinant;
    let [w, u, v] = [wa, wb, wc].map(|weight| weight * inv);
    let t = (w * a[2] + u * b[2] + v * c[2]) * sz;

    let sizes = products.map(|(p, q)| p.abs() + q.abs());
    let [t, u, v] = if (sizes[0] + sizes[1] + sizes[2]) + 1e-30 < determinant.abs() * 32.0 {
        [t, u, v]
    } else {
        ill_conditioned(ray, vertices)?
    };
    let tmin = if ray.tmin > 0.0 { ray.tmin } else { 0.0 };
    (tmin <= t && t <= ray.tmax && t <= f32::MAX).then_some([t, u, v])
}

/// The hit in `f64`, its distance moved into the passage through the padded box.
fn ill_conditioned(ray: &Ray, vertices: &[[f32; 3]; 3]) -> Option<[f32; 3]> {
    let [o, d] = [ray.org, ray.dir].map(|p| p.map(f64::from));
    let [a, b, c] = vertices.map(|p| [0, 1, 2].map(|axis| f64::from(p[axis]) - o[axis]));
    let dot = |p: [f64; 3], q: [f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    let volume = |p: [f64; 3], q: [f64; 3]| {
        let minor = |i: usize, j: usize| p[i] * q[j] - q[i] * p[j];
        dot([minor(1, 2), minor(2, 0), minor(0, 1)], d)
    };
    let volumes = [volume(c, b), volume(a, c), volume(b, a)];
    let sign = (volumes[0] + volumes[1] + volumes[2]).signum();
    let [w, u, v] = volumes.map(|x| (sign * x).max(0.0));
    let sum = w + u + v;
    let depth = (w * dot(a, d) + u * dot(b, d) + v * dot(c, d)) / dot(d, d);
    let [t, u, v] = [depth / sum, u / sum, v / sum].map(|x| x as f32);

    let axis_range = |axis: usize| {
        let [p, q, r] = [0, 1, 2].map(|i| vertices[i][axis]);
        (p.min(q).min(r), p.max(q).max(r))
    };
    let extent = (0..3)
        .map(|axis| axis_range(axis).1 - axis_range(axis).0)
        .fold(0.0, f32::max);
    let (mut entry, mut exit) = (f32::NEG_INFINITY, f32::INFINITY);
    for axis in 0..3 {
        let (lo, hi) = axis_range(axis);
        let pad = |x: f32| extent * 2f32.powi(-16) + x.abs() * f32::EPSILON;
        let inv = 1.0 / ray.dir[axis];
        let planes = [lo - pad(lo), hi + pad(hi)];
        let [near, far] = if inv < 0.0 {
            [planes[1], planes[0]]
        } else {
            planes
        };
        // f32::max and min drop NaN.
        entry = entry.max((near - ray.org[axis]) * inv * (1.0 - 2f32.powi(-21)));
        exit = exit.min((far - ray.org[axis]) * inv * (1.0 + 2f32.powi(-21)));
    }
    let finite = t.is_finite();
    let t = if t > entry { t } else { entry };
    let t = if t < exit { t } else { exit };
    (entry <= exit && finite).then_some([t, u, v])
}
