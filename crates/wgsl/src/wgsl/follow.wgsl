// Rays of paths and their shadow rays take turns in one loop, so that threads of both trace together.
@compute @workgroup_size(WORKGROUP)
fn follow_path(@builtin(global_invocation_id) id: vec3u) {
//START
    var shadow: ShadowRay;
    var is_shadow = false;
    var goes_on = true;
    var bounces = 0u;
    var shadows = 0u;
    loop {
        var org = path.org;
        var dir = path.dir;
        var tmax = FARTHEST;
        if is_shadow {
            org = shadow.org;
            dir = shadow.dir;
            tmax = shadow.tmax;
        }
        let hit = traverse(org, dir, tmax, is_shadow);
        if is_shadow {
            shadows += 1u;
            if hit.prim == NONE {
                add(shadow.sample, shadow.contribution);
            }
            is_shadow = false;
            if !goes_on {
                break;
            }
            bounces += 1u;
            continue;
        }
        var queue = QUEUES - 1u;
        if hit.prim != NONE {
            queue = program_of(hit.prim);
        }
        path.hit = vec4u(queue, bitcast<u32>(hit.u), bitcast<u32>(hit.v), hit.prim);
        //[visits
        // The processor makes a colour of it.
        if path.state == 1u {
            samples[slot * STRIDE] = f32(visits);
        }
        //]
        goes_on = false;
        switch queue {
//CASES
            default: {
            }
        }
        if is_shadow {
            continue;
        }
        if !goes_on {
            break;
        }
        bounces += 1u;
    }
    atomicAdd(&queues.bounce_rays, bounces);
    atomicAdd(&queues.shadow_rays, shadows);
}
