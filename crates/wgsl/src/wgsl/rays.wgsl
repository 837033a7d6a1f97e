// Ray queries by themselves: for tests and measurements of traversal.

const NONE: u32 = 0xffffffffu;

struct Ray {
    org: vec3f,
    // Any hit will do.
    any_hit: u32,
    dir: vec3f,
    tmax: f32,
}

struct Settings {
    count: u32,
    first_packet: u32,
}

@group(0) @binding(0) var<storage, read> tree: array<vec4f>;
@group(0) @binding(1) var<storage, read> rays: array<Ray>;
@group(0) @binding(2) var<storage, read_write> hits: array<Hit>;
@group(0) @binding(3) var<uniform> settings: Settings;

@compute @workgroup_size(WORKGROUP)
fn trace_rays(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= settings.count {
        return;
    }
    let ray = rays[id.x];
    hits[id.x] = traverse(ray.org, ray.dir, ray.tmax, ray.any_hit != 0u);
}
