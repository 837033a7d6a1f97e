// Rays against the scene's hierarchy: four boxes a node, four triangles a packet, one loop (thesis, section 4.1).
//
// The triangle test is that of residual-bvh's `Watertight`: S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle
// Intersection", JCGT 2(1), 2013. Sides are decided by comparing rounded products, which no contraction can flip. The slab
// test is T. Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013. Of hits at the same distance the least triangle index wins,
// so that answers do not depend on the order of visits.

const LEAF: u32 = 0x80000000u;
const SINGLE_SIDED: u32 = 0x80000000u;
const FARTHEST: f32 = 0x1.fffffep127f;
// Rows of four numbers: six planes and the children; nine coordinates and the indices.
const NODE_ROWS: u32 = 7u;
const PACKET_ROWS: u32 = 10u;
// The slab test's slack, as in residual-bvh.
const STRETCH: f32 = 0x1p-20f;
const REACH: f32 = 0x1p-22f;

//[visits
// Nodes and packets that the last ray has visited.
var<private> visits: u32;
//]

struct Hit {
    t: f32,
    u: f32,
    v: f32,
    prim: u32,
}

// The second where the first is NaN.
fn greater4(a: vec4f, b: vec4f) -> vec4f {
    return select(b, a, a > b);
}

fn smaller4(a: vec4f, b: vec4f) -> vec4f {
    return select(b, a, a < b);
}

fn greater3(a: vec3f, b: vec3f) -> vec3f {
    return select(b, a, a > b);
}

// Finite, and with a direction whose inverse is finite.
fn is_valid(org: vec3f, dir: vec3f, tmax: f32) -> bool {
    let o = bitcast<vec3u>(org) & vec3u(0x7fffffffu);
    let d = bitcast<vec3u>(dir) & vec3u(0x7fffffffu);
    let most_org = max(max(o.x, o.y), o.z);
    let most_dir = max(max(d.x, d.y), d.z);
    return max(most_org, most_dir) <= 0x7f7fffffu && most_dir >= 0x00800000u && 0.0f <= tmax;
}

// Where the ray's line passes through the padded box of a triangle: residual-bvh, `Bounds::passage`.
fn passage(org: vec3f, dir: vec3f, a: vec3f, b: vec3f, c: vec3f) -> vec2f {
    let low = min(min(a, b), c);
    let high = max(max(a, b), c);
    let size = high - low;
    let extent = max(max(size.x, size.y), size.z);
    let lo = low - (vec3f(extent * 0x1p-16f) + abs(low) * 0x1p-23f);
    let hi = high + (vec3f(extent * 0x1p-16f) + abs(high) * 0x1p-23f);
    var entry = -FARTHEST;
    var exit = FARTHEST;
    for (var axis = 0u; axis < 3u; axis++) {
        let inverse = quotient(1.0f, dir[axis]);
        let is_negative = (bitcast<u32>(dir[axis]) & 0x80000000u) != 0u;
        let near = select(lo[axis], hi[axis], is_negative);
        let far = select(hi[axis], lo[axis], is_negative);
        entry = greatest(((near - org[axis]) * inverse) * (1.0f - 0x1p-21f), entry);
        exit = least(((far - org[axis]) * inverse) * (1.0f + 0x1p-21f), exit);
    }
    return vec2f(entry, exit);
}

//[f64
fn determinant64(p: vec3<f64>, q: vec3<f64>, dir: vec3<f64>) -> f64 {
    return ((p.y * q.z - q.y * p.z) * dir.x + (p.z * q.x - q.z * p.x) * dir.y) + (p.x * q.y - q.x * p.y) * dir.z;
}

fn dot64(a: vec3<f64>, b: vec3<f64>) -> f64 {
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

// A ray that passes inside a triangle seen edge-on, of which `f32` cannot say where it meets it.
fn ill_conditioned(org: vec3f, dir: vec3f, p0: vec3f, p1: vec3f, p2: vec3f, hit: ptr<function, Hit>) -> bool {
    let bounds = passage(org, dir, p0, p1, p2);
    let d = vec3<f64>(dir);
    let o = vec3<f64>(org);
    let a = vec3<f64>(p0) - o;
    let b = vec3<f64>(p1) - o;
    let c = vec3<f64>(p2) - o;
    var w = determinant64(c, b, d);
    var u = determinant64(a, c, d);
    var v = determinant64(b, a, d);
    if (w + u) + v < 0.0lf {
        w = -w;
        u = -u;
        v = -v;
    }
    w = select(0.0lf, w, w > 0.0lf);
    u = select(0.0lf, u, u > 0.0lf);
    v = select(0.0lf, v, v > 0.0lf);
    let sum = (w + u) + v;
    let depth = ((w * dot64(a, d) + u * dot64(b, d)) + v * dot64(c, d)) / dot64(d, d);
    let t = f32(depth / sum);
    let is_finite = (bitcast<u32>(t) & 0x7fffffffu) < 0x7f800000u;
    (*hit).t = least(greatest(t, bounds.x), bounds.y);
    (*hit).u = f32(u / sum);
    (*hit).v = f32(v / sum);
    return is_finite && bounds.x <= bounds.y;
}
//]
//[f32
// A ray that passes inside a triangle seen edge-on: the distance is moved into the padded box.
fn ill_conditioned(org: vec3f, dir: vec3f, p0: vec3f, p1: vec3f, p2: vec3f, hit: ptr<function, Hit>) -> bool {
    let bounds = passage(org, dir, p0, p1, p2);
    let t = (*hit).t;
    let is_finite = (bitcast<u32>(t) & 0x7fffffffu) < 0x7f800000u;
    (*hit).t = least(greatest(t, bounds.x), bounds.y);
    return is_finite && bounds.x <= bounds.y;
}
//]

// The nearest hit of a ray, or any, whose distance is at most `tmax`; `NONE` where there is none.
fn traverse(org: vec3f, dir: vec3f, tmax: f32, any_hit: bool) -> Hit {
    var best = Hit(least(tmax, FARTHEST), 0.0f, 0.0f, NONE);
    //[visits
    visits = 0u;
    //]
    if !is_valid(org, dir, tmax) {
        return best;
    }
    let size = abs(dir);
    // The order of the axes in which the ray runs mostly along the last, with the winding kept.
    var kz = 2u;
    if !(size.z >= size.x && size.z >= size.y) {
        kz = select(0u, 1u, size.y >= size.x);
    }
    var kx = (kz + 1u) % 3u;
    var ky = (kz + 2u) % 3u;
    var d = dir;
    var o = org;
    if d[kz] < 0.0f {
        let swapped = kx;
        kx = ky;
        ky = swapped;
    }
    let along = d[kz];
    let slope_x = quotient(d[kx], along);
    let slope_y = quotient(d[ky], along);
    let inverse_z = quotient(1.0f, along);
    let org_x = o[kx];
    let org_y = o[ky];
    let org_z = o[kz];

    let longest = greatest(greatest(size.x, size.y), size.z);
    let signs = select(vec3f(1.0f), vec3f(-1.0f), dir < vec3f(0.0f));
    let lengths = greater3(size, vec3f(longest * 0x1p-64f));
    let inverse = vec3f(quotient(signs.x, lengths.x), quotient(signs.y, lengths.y), quotient(signs.z, lengths.z));
    let near_scale = inverse * (1.0f - STRETCH);
    let far_scale = inverse * (1.0f + STRETCH);
    let near_product = org * near_scale;
    let far_product = org * far_scale;
    let near_shift = abs(near_product) * -REACH - near_product;
    let far_shift = abs(far_product) * REACH - far_product;
    // Rows of the planes through which the ray enters.
    let rows = vec3u(0u, 2u, 4u) + select(vec3u(0u), vec3u(1u), dir < vec3f(0.0f));

    // Children, and where their boxes are entered.
    var stack: array<vec2u, STACK>;
    var depth = 0u;
    var child = 0u;
    loop {
        if (child & LEAF) != 0u {
            let packets = (child >> 27u) & 15u;
            var row = settings.first_packet + (child & 0x7ffffffu) * PACKET_ROWS;
            for (var packet = 0u; packet < packets; packet++) {
                //[visits
                visits += 1u;
                //]
                for (var lane = 0u; lane < 4u; lane++) {
                    let marked = bitcast<u32>(tree[row + 9u][lane]);
                    if marked == NONE {
                        continue;
                    }
                    // Indices of components are resolved in memory: registers have none.
                    let az = tree[row + kz][lane] - org_z;
                    let bz = tree[row + 3u + kz][lane] - org_z;
                    let cz = tree[row + 6u + kz][lane] - org_z;
                    let ax = (tree[row + kx][lane] - org_x) - slope_x * az;
                    let ay = (tree[row + ky][lane] - org_y) - slope_y * az;
                    let bx = (tree[row + 3u + kx][lane] - org_x) - slope_x * bz;
                    let by = (tree[row + 3u + ky][lane] - org_y) - slope_y * bz;
                    let cx = (tree[row + 6u + kx][lane] - org_x) - slope_x * cz;
                    let cy = (tree[row + 6u + ky][lane] - org_y) - slope_y * cz;
                    let w0 = cx * by;
                    let w1 = cy * bx;
                    let u0 = ax * cy;
                    let u1 = ay * cx;
                    let v0 = bx * ay;
                    let v1 = by * ax;
                    let front = w0 >= w1 && u0 >= u1 && v0 >= v1;
                    let back = w0 <= w1 && u0 <= u1 && v0 <= v1;
                    if !(front || back) {
                        continue;
                    }
                    //[sided
                    if !front && (marked & SINGLE_SIDED) != 0u {
                        continue;
                    }
                    //]
                    let w = w0 - w1;
                    let u = u0 - u1;
                    let v = v0 - v1;
                    let determinant = (w + u) + v;
                    if !(determinant <= determinant) {
                        continue;
                    }
                    let scale = quotient(1.0f, determinant);
                    let height = ((w * scale) * az + (u * scale) * bz) + (v * scale) * cz;
                    var hit = Hit(height * inverse_z, u * scale, v * scale, marked & ~SINGLE_SIDED);
                    let sizes = ((abs(w0) + abs(w1)) + (abs(u0) + abs(u1))) + (abs(v0) + abs(v1));
                    // A triangle seen edge-on; residual-bvh, `watertight.rs`.
                    if !(sizes + 1e-30f < abs(determinant) * 32.0f) {
                        let p0 = vec3f(tree[row][lane], tree[row + 1u][lane], tree[row + 2u][lane]);
                        let p1 = vec3f(tree[row + 3u][lane], tree[row + 4u][lane], tree[row + 5u][lane]);
                        let p2 = vec3f(tree[row + 6u][lane], tree[row + 7u][lane], tree[row + 8u][lane]);
                        if !ill_conditioned(org, dir, p0, p1, p2, &hit) {
                            continue;
                        }
                    }
                    if !(0.0f <= hit.t && hit.t <= best.t) || (hit.t == best.t && hit.prim >= best.prim) {
                        continue;
                    }
                    //[alpha
                    if !is_there(org, dir, hit) {
                        continue;
                    }
                    //]
                    best = hit;
                    if any_hit {
                        return best;
                    }
                }
                row += PACKET_ROWS;
            }
            child = NONE;
            // What lies behind the nearest hit by now is left out.
            while depth > 0u && child == NONE {
                depth -= 1u;
                let waiting = stack[depth];
                child = select(NONE, waiting.x, bitcast<f32>(waiting.y & 0xfffffffcu) <= best.t);
            }
            if child == NONE {
                break;
            }
            continue;
        }

        //[visits
        visits += 1u;
        //]
        let node = child * NODE_ROWS;
        let near_x = tree[node + rows.x] * near_scale.x + near_shift.x;
        let near_y = tree[node + rows.y] * near_scale.y + near_shift.y;
        let near_z = tree[node + rows.z] * near_scale.z + near_shift.z;
        let far_x = tree[node + (rows.x ^ 1u)] * far_scale.x + far_shift.x;
        let far_y = tree[node + (rows.y ^ 1u)] * far_scale.y + far_shift.y;
        let far_z = tree[node + (rows.z ^ 1u)] * far_scale.z + far_shift.z;
        let entry = greater4(near_z, greater4(near_y, greater4(near_x, vec4f(0.0f))));
        let exit = smaller4(far_z, smaller4(far_y, smaller4(far_x, vec4f(best.t))));
        // Distances that are not negative sort like their bits, whose last two say which child it is.
        let distances = (bitcast<vec4u>(entry) & vec4u(0xfffffffcu)) | vec4u(0u, 1u, 2u, 3u);
        let keys = select(vec4u(NONE), distances, entry <= exit);
        let low = min(keys.xy, keys.zw);
        let high = max(keys.xy, keys.zw);
        let first = min(low.x, low.y);
        let second = max(low.x, low.y);
        let third = min(high.x, high.y);
        let last = max(high.x, high.y);
        let nearer = min(second, third);
        let farther = max(second, third);
        if first == NONE {
            child = NONE;
            // What lies behind the nearest hit by now is left out.
            while depth > 0u && child == NONE {
                depth -= 1u;
                let waiting = stack[depth];
                child = select(NONE, waiting.x, bitcast<f32>(waiting.y & 0xfffffffcu) <= best.t);
            }
            if child == NONE {
                break;
            }
            continue;
        }
        let children = node + 6u;
        if last != NONE {
            stack[depth] = vec2u(bitcast<u32>(tree[children][last & 3u]), last);
            depth += 1u;
        }
        if farther != NONE {
            stack[depth] = vec2u(bitcast<u32>(tree[children][farther & 3u]), farther);
            depth += 1u;
        }
        if nearer != NONE {
            stack[depth] = vec2u(bitcast<u32>(tree[children][nearer & 3u]), nearer);
            depth += 1u;
        }
        child = bitcast<u32>(tree[children][first & 3u]);
    }
    return best;
}
