// What the threads of a workgroup have for each queue.
var<workgroup> tallies: array<atomic<u32>, QUEUES>;

fn clear_tallies(thread: u32) {
    for (var k = thread; k < QUEUES; k += WORKGROUP) {
        atomicStore(&tallies[k], 0u);
    }
    workgroupBarrier();
}
