//! The naive oracles: every triangle in turn, one scalar at a time, with the arithmetic of
//! [`Watertight`](residual_bvh::Watertight) or [`Exact`](residual_bvh::Exact).

use residual_bvh::{Culling, Hit, HitFilter, Ray};

use crate::integers::{integer, quotient, triple_product as exact_triple_product};
use crate::mesh::Mesh;

/// The answer that a hierarchy must reproduce bit for bit.
pub(crate) fn closest_hit_of_all<F: HitFilter>(mesh: &Mesh, ray: &Ray, filter: &F) -> Hit {
    closest_of_all(mesh, ray, filter, intersect)
}

/// The same for `Exact`.
pub(crate) fn exact_closest_hit_of_all<F: HitFilter>(mesh: &Mesh, ray: &Ray, filter: &F) -> Hit {
    closest_of_all(mesh, ray, filter, intersect_exactly)
}

fn closest_of_all<F: HitFilter>(
    mesh: &Mesh,
    ray: &Ray,
    filter: &F,
    intersect: impl Fn(&Ray, &[[f32; 3]; 3], bool) -> Option<[f32; 3]>,
) -> Hit {
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

    let (entry, exit) = passage(ray, vertices);
    let finite = t.is_finite();
    let t = if t > entry { t } else { entry };
    let t = if t < exit { t } else { exit };
    (entry <= exit && finite).then_some([t, u, v])
}

/// Where the ray passes through the padded box.
fn passage(ray: &Ray, vertices: &[[f32; 3]; 3]) -> (f32, f32) {
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
    (entry, exit)
}

/// `[t, u, v]` if the ray meets the triangle in its interval: `f64` where its error bounds allow,
/// else integers.
fn intersect_exactly(ray: &Ray, vertices: &[[f32; 3]; 3], one_side: bool) -> Option<[f32; 3]> {
    let minus = |p: [f32; 3], q: [f32; 3]| [0, 1, 2].map(|i| f64::from(p[i]) - f64::from(q[i]));
    let minus_exactly = |p: [f32; 3], q: [f32; 3]| [0, 1, 2].map(|i| integer(p[i]) - integer(q[i]));
    // `p · (q × r)`, and what it may be off by.
    let triple_product = |p: [f64; 3], q: [f64; 3], r: [f64; 3]| {
        let (mut value, mut size) = (0.0, 0.0);
        for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
            value += p[i] * (q[j] * r[k] - q[k] * r[j]);
            size += p[i].abs() * ((q[j] * r[k]).abs() + (q[k] * r[j]).abs());
        }
        (value, 9.0 * 2f64.powi(-53) * size)
    };
    let longest = |p: [f64; 3]| p[0].abs().max(p[1].abs()).max(p[2].abs());

    let [a, b, c] = *vertices;
    let dir = ray.dir.map(f64::from);
    let relative = |p| minus(p, ray.org);
    let edges = [(c, b), (a, c), (b, a)];
    let weights = edges.map(|(p, q)| triple_product(dir, relative(p), minus(q, p)));
    let outside = |sign: f64| weights.iter().any(|(weight, error)| sign * weight > *error);
    if outside(1.0) && outside(-1.0) {
        return None;
    }
    let [w, u, v] = weights.map(|(weight, _)| weight);
    let error = weights[0].1 + weights[1].1 + weights[2].1;
    let certain = weights.iter().all(|(weight, error)| weight.abs() >= *error);
    let [w, u, v] = if certain && error <= (w + u + v).abs() * 2f64.powi(-28) {
        [w, u, v]
    } else {
        let dir = ray.dir.map(integer);
        let unit = integer(1.0);
        let unit = &unit * &unit * &unit;
        edges.map(|(p, q)| {
            let [p, q] = [p, q].map(|p| minus_exactly(p, ray.org));
            quotient(&exact_triple_product(&dir, &p, &q), &unit)
        })
    };
    let front = w >= 0.0 && u >= 0.0 && v >= 0.0;
    let back = w <= 0.0 && u <= 0.0 && v <= 0.0;
    let determinant = w + u + v;
    if !(front || back && !one_side) || determinant == 0.0 {
        return None;
    }
    let (volume, error) = triple_product(relative(a), minus(c, a), minus(b, a));
    let far = longest(relative(a)) * determinant.abs() / longest(dir);
    let volume = if error <= volume.abs().max(far * 2f64.powi(-10)) * 2f64.powi(-26) {
        volume
    } else {
        let unit = integer(1.0);
        let unit = &unit * &unit * &unit;
        let [a, c, b] = [
            minus_exactly(a, ray.org),
            minus_exactly(c, a),
            minus_exactly(b, a),
        ];
        quotient(&exact_triple_product(&a, &c, &b), &unit)
    };
    let [t, u, v] = [volume, u, v].map(|x| (x / determinant) as f32 + 0.0);
    let (entry, exit) = passage(ray, vertices);
    let t = if t > entry { t } else { entry };
    let t = if t < exit { t } else { exit };
    let tmin = if ray.tmin > 0.0 { ray.tmin } else { 0.0 };
    let in_interval = tmin <= t && t <= ray.tmax && t <= f32::MAX;
    (entry <= exit && in_interval).then_some([t, u, v])
}
