// Where a workgroup's paths begin in each queue.
var<workgroup> starts: array<u32, QUEUES>;

@compute @workgroup_size(WORKGROUP)
fn scatter(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    clear_tallies(thread);
    let is_path = id.x < queues.live;
    var slot: u32;
    var queue: u32;
    var place: u32;
    if is_path {
        slot = queues.entries[queues.side * settings.slots + id.x];
        queue = paths[slot].hit.x;
        place = atomicAdd(&tallies[queue], 1u);
    }
    workgroupBarrier();
    for (var k = thread; k < QUEUES; k += WORKGROUP) {
        let count = atomicLoad(&tallies[k]);
        if count != 0u {
            starts[k] = atomicAdd(&queues.cursors[k], count);
        }
    }
    workgroupBarrier();
    if is_path {
        queues.entries[2u * settings.slots + starts[queue] + place] = slot;
    }
}
