//! What lies in memory, as the kernels read it: nodes, packets of triangles and the hierarchies of
//! both, their check and their bytes in files; and packets of rays.

pub(crate) mod boxes;
pub(crate) mod bvh;
pub(crate) mod child;
pub(crate) mod class;
pub(crate) mod compact;
pub(crate) mod node;
pub(crate) mod packet;
pub(crate) mod quantized;
pub(crate) mod ray_packet;
pub(crate) mod serial;
pub(crate) mod triangle_packet;
pub(crate) mod validate;
