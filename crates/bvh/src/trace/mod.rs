//! Queries of a hierarchy: one walk, the tests of boxes on its way, and the kernels that are made of
//! them, for single rays, for packets and for many rays in flight.

mod answers;
pub(crate) mod apart;
mod best_hits;
pub(crate) mod columns;
pub(crate) mod cost;
mod counting_sort;
mod exhaustive;
mod flight_stack;
pub(crate) mod goal;
mod hybrid;
mod leaf;
pub(crate) mod one_by_one;
mod packet;
mod phased;
pub(crate) mod prefetch;
pub(crate) mod single;
pub(crate) mod slab;
mod sorting_network;
mod stack;
pub(crate) mod stream;
pub(crate) mod traverse;
mod triangle_table;
mod window;
