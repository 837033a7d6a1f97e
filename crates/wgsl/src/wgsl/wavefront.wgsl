// The kernels of the wavefront: paths wait in queues, one for each program (thesis, section 4.1).

const NONE: u32 = 0xffffffffu;

struct Settings {
    // Of the image, in pixels.
    width: f32,
    height: f32,
    // Blocks of 8 × 8 pixels in a row of the image, and pixels in all blocks.
    columns: u32,
    places: u32,
    // The first sample of the pass, and the first of the places of its samples that this launch renders, and how many.
    first_sample: u32,
    first: u32,
    count: u32,
    // How many paths the buffers hold.
    slots: u32,
    seed: u32,
    max_depth: u32,
    roulette_from: u32,
    reach: f32,
    // The first row of the hierarchy's packets.
    first_packet: u32,
}

struct Path {
    org: vec3f,
    pdf: f32,
    dir: vec3f,
    pixel: u32,
    throughput: vec3f,
    // Depth and medium; 1 for the ray from the camera.
    state: u32,
    // Program, u, v, triangle.
    hit: vec4u,
    //[ends
    // What strategies from the other end are worth, and the number of the path's points.
    rivals: f32,
    index: u32,
    //]
}

struct ShadowRay {
    org: vec3f,
    tmax: f32,
    dir: vec3f,
    // What it counts for: a path's slot, or a sample of any pixel.
    sample: u32,
    contribution: vec3f,
}

struct Queues {
    // Paths whose rays are to be traced, and where they wait: in the first or second third of the entries.
    live: u32,
    side: u32,
    next: atomic<u32>,
    shadows: atomic<u32>,
    // What has been traced.
    bounce_rays: atomic<u32>,
    shadow_rays: atomic<u32>,
    // What light paths have found.
    splats: atomic<u32>,
    // Of each program; misses come last.
    counts: array<atomic<u32>, QUEUES>,
    cursors: array<atomic<u32>, QUEUES>,
    starts: array<u32, QUEUES>,
    entries: array<u32>,
}
