@compute @workgroup_size(WORKGROUP)
fn scatter(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= queues.live {
        return;
    }
    let slot = queues.entries[queues.side * settings.slots + id.x];
    let place = atomicAdd(&queues.cursors[paths[slot].hit.x], 1u);
    queues.entries[2u * settings.slots + place] = slot;
}
