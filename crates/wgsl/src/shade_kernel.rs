//! The kernel that shades a queue of paths, around what it does with each.

use crate::module::Module;

const COMPACTION: &str = include_str!("wgsl/compaction.wgsl");

/// Adds the kernel that shades `count` of the sorted paths from `first` on.
pub(crate) fn add_shade(mut module: Module, first: &str, count: &str, body: &str) -> String {
    module.add_text(COMPACTION);
    module.add_text(&format!(
        "\
@compute @workgroup_size(WORKGROUP)
fn shade(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {{
    clear_counts(thread);
    var slot: u32;
    var next = NONE;
    var shadow = NONE;
    var shadow_ray: ShadowRay;
    if id.x < {count} {{
        slot = queues.entries[2u * settings.slots + {first} + id.x];
        let path = paths[slot];
{body}    }}
    reserve(thread);
    if next != NONE {{
        queues.entries[(1u - queues.side) * settings.slots + next_start + next] = slot;
    }}
    if shadow != NONE {{
        shadow_rays[shadow_start + shadow] = shadow_ray;
    }}
}}
"
    ));
    module.finish()
}
