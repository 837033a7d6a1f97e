// Paths and shadow rays that go on: a workgroup asks for their places at once.
var<workgroup> next_count: atomic<u32>;
var<workgroup> next_start: u32;
var<workgroup> shadow_count: atomic<u32>;
var<workgroup> shadow_start: u32;

fn clear_counts(thread: u32) {
    if thread == 0u {
        atomicStore(&next_count, 0u);
        atomicStore(&shadow_count, 0u);
    }
    workgroupBarrier();
}

fn reserve(thread: u32) {
    workgroupBarrier();
    if thread == 0u {
        next_start = atomicAdd(&queues.next, atomicLoad(&next_count));
        shadow_start = atomicAdd(&queues.shadows, atomicLoad(&shadow_count));
    }
    workgroupBarrier();
}
