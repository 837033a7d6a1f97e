//! Ray queries: wide bounding volume hierarchies over triangles, traversed with portable SIMD.
//!
//! [`build`] makes a [`Bvh`] whose nodes have `N` children and whose leaves hold packets of `N`
//! triangles (`N` = 4, 8 or 16); [`closest_hit`] and [`any_hit`] trace one ray through it, `N`
//! boxes or `N` triangles per instruction.
//!
//! ```text
//! positions, triangles ─ build ─ sbvh (binary tree, references) ─ reinsert ─ collapse ─ Bvh<N>
//!                                                                                        │ view
//! Ray ─ prepared ray ─ traverse { slab test of N boxes | triangle test of N triangles } ─ Hit
//! ```
//!
//! # Contracts
//! - A closed mesh has no holes: edges and vertices belong to every triangle that shares them.
//! - The answer is a function of the ray and the triangles alone: among hits at the same distance
//!   the smallest triangle index wins, and `(t, u, v, prim)` has the same bits for every width,
//!   instruction set and shape of tree. (Trees with split references, [`BuildQuality::Best`], keep
//!   this up to the ill-conditioned case that `bounds.rs` describes.)
//! - Invalid rays and degenerate triangles never hit and never disturb others.
#![warn(clippy::undocumented_unsafe_blocks)]

mod balance;
mod binary;
mod binning;
mod bounds;
mod build;
mod bvh;
mod clip;
mod collapse;
mod columns;
mod filter;
mod fragment;
mod packet;
mod partition;
mod precision;
mod ray;
mod reinsert;
mod sbvh;
mod simd;
mod single;
mod slab;
mod spatial;
mod stack;
mod stream;
mod traverse;
mod triangle;
mod validate;

pub use bounds::Bounds;
pub use build::{BuildQuality, build, build_with_progress};
pub use bvh::{Bvh, BvhView, Node, TrianglePacket};
pub use filter::{AllHits, Culling, FrontHits, HitFilter, MarkedHits};
pub use precision::{Exact, Fast, Precision, Watertight};
pub use ray::{Hit, Ray};
pub use simd::Lanes;
pub use single::{any_hit, closest_hit};
pub use stream::{Hybrid, Kernel, Packets, Single};
pub use validate::InvalidBvh;
