@group(1) @binding(0) var<storage, read> tree: array<vec4f>;
@group(1) @binding(1) var<storage, read_write> paths: array<Path>;
@group(1) @binding(2) var<storage, read_write> shadow_rays: array<ShadowRay>;
@group(1) @binding(3) var<storage, read_write> queues: Queues;
@group(1) @binding(4) var<storage, read_write> samples: array<f32>;
@group(1) @binding(5) var<uniform> settings: Settings;
