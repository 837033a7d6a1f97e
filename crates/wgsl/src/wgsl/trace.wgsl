// Shadow rays come first, then the rays of paths.
@compute @workgroup_size(WORKGROUP)
fn trace(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    let shadows = atomicLoad(&queues.shadows);
    let is_shadow = id.x < shadows;
    let is_path = !is_shadow && id.x < shadows + queues.live;
    var queue = QUEUES - 1u;
    if is_shadow || is_path {
        var org: vec3f;
        var dir: vec3f;
        var tmax: f32;
        var slot: u32;
        if is_shadow {
            org = shadow_rays[id.x].org;
            dir = shadow_rays[id.x].dir;
            tmax = shadow_rays[id.x].tmax;
            slot = shadow_rays[id.x].sample;
        } else {
            slot = queues.entries[queues.side * settings.slots + id.x - shadows];
            org = paths[slot].org;
            dir = paths[slot].dir;
            tmax = FARTHEST;
        }
        let hit = traverse(org, dir, tmax, is_shadow);
        if is_shadow {
            if hit.prim == NONE {
                add(slot, shadow_rays[id.x].contribution);
            }
        } else {
            if hit.prim != NONE {
                queue = program_of(hit.prim);
            }
            paths[slot].hit = vec4u(queue, bitcast<u32>(hit.u), bitcast<u32>(hit.v), hit.prim);
            //[visits
            // The processor makes a colour of it.
            if paths[slot].state == 1u {
                samples[slot * STRIDE] = f32(visits);
            }
            //]
        }
    }
    // Each queue is counted once a workgroup: a million additions to few numbers would wait for each other.
    clear_tallies(thread);
    if is_path {
        atomicAdd(&tallies[queue], 1u);
    }
    workgroupBarrier();
    for (var k = thread; k < QUEUES; k += WORKGROUP) {
        let count = atomicLoad(&tallies[k]);
        if count != 0u {
            atomicAdd(&queues.counts[k], count);
        }
    }
}
