// One thread, between the kernels: how many workgroups the next ones have.

@group(0) @binding(0) var<storage, read_write> queues: Queues;
@group(0) @binding(1) var<storage, read_write> arguments: array<u32>;
@group(0) @binding(2) var<uniform> settings: Settings;

fn set_arguments(kernel: u32, threads: u32) {
    arguments[kernel * 3u] = (threads + WORKGROUP - 1u) / WORKGROUP;
    arguments[kernel * 3u + 1u] = 1u;
    arguments[kernel * 3u + 2u] = 1u;
}

// Gives a queue its place among the sorted paths; returns the next.
fn place(queue: u32, start: u32) -> u32 {
    let count = atomicLoad(&queues.counts[queue]);
    queues.starts[queue] = start;
    atomicStore(&queues.cursors[queue], start);
    set_arguments(queue + 2u, count);
    return start + count;
}

// After shading: the paths that go on become those to be traced.
@compute @workgroup_size(1)
fn turn() {
    let live = atomicLoad(&queues.next);
    queues.live = live;
    queues.side = 1u - queues.side;
    atomicAdd(&queues.bounce_rays, live);
    atomicStore(&queues.next, 0u);
    for (var k = 0u; k < QUEUES; k++) {
        atomicStore(&queues.counts[k], 0u);
    }
    set_arguments(0u, live + atomicLoad(&queues.shadows));
    set_arguments(1u, live);
}
