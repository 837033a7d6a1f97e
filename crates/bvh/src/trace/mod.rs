//! Queries of a hierarchy: one walk, the tests of boxes on its way, and the kernels that are made of
//! them, for single rays and for packets.

pub(crate) mod cost;
pub(crate) mod goal;
pub(crate) mod one_by_one;
mod packet;
pub(crate) mod prefetch;
pub(crate) mod single;
pub(crate) mod slab;
mod sorting_network;
mod stack;
pub(crate) mod stream;
pub(crate) mod traverse;
