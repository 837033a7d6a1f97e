// After rays have been traced: where the paths of each program will stand.
@compute @workgroup_size(1)
fn plan() {
    var start = 0u;
//FOLDED
    set_arguments(QUEUES + 2u, start);
//OTHERS
    atomicAdd(&queues.shadow_rays, atomicLoad(&queues.shadows));
    atomicStore(&queues.shadows, 0u);
}
