//! Ray queries: wide bounding volume hierarchies over triangles, traversed with portable SIMD.
//!
//! [`build`] makes a [`Bvh`] whose nodes have `N` children and whose leaves hold packets of `P`
//! triangles; a ray is tested against `N` boxes or `P` triangles per instruction.
//!
//! ```
//! use residual_bvh::{BuildQuality, Bvh, Ray, build};
//!
//! // A square in the plane z = 0, of two triangles that share an edge.
//! let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
//! let triangles = [[0, 1, 2], [0, 2, 3]];
//! let bvh: Bvh<8> = build(&positions, &triangles, None, BuildQuality::Best);
//!
//! let down = |x, y| Ray::unbounded([x, y, 2.0], [0.0, 0.0, -1.0]);
//! let hit = bvh.closest_hit(&down(0.25, 0.75));
//! assert_eq!((hit.prim, hit.t), (1, 2.0));
//! assert!(bvh.any_hit(&down(0.5, 0.5)) && !bvh.any_hit(&down(2.0, 0.5)));
//!
//! // Many rays at once.
//! let rays: Vec<Ray> = (0..100).map(|i| down(i as f32 / 50.0, 0.5)).collect();
//! let mut occluded = vec![false; rays.len()];
//! bvh.any_hits(&rays, &mut occluded);
//! assert_eq!(occluded.iter().filter(|&&is| is).count(), 51);
//! ```
//!
//! # Filters
//! A [`HitFilter`] says which intersections count.
//!
//! ```
//! # use residual_bvh::{BuildQuality, Bvh, build};
//! use residual_bvh::{Culling, Hit, HitFilter, Ray};
//!
//! /// Everything but the triangle that the ray comes from.
//! struct Others {
//!     from: u32,
//! }
//!
//! impl HitFilter for Others {
//!     const CULLING: Culling = Culling::None;
//!     const REJECTS: bool = true;
//!
//!     fn accept(&self, _ray: &Ray, hit: &Hit) -> bool {
//!         hit.prim != self.from
//!     }
//! }
//!
//! # let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
//! # let bvh: Bvh<4> = build(&positions, &[[0, 1, 2]], None, BuildQuality::Fast);
//! let ray = Ray { org: [0.2, 0.2, 1.0], tmin: 0.0, dir: [0.0, 0.0, -1.0], tmax: 10.0 };
//! assert!(bvh.closest_hit(&ray).is_hit());
//! assert!(!bvh.closest_hit_filtered(&ray, &Others { from: 0 }).is_hit());
//! ```
//!
//! # Instances
//! An [`InstancedBvh`] places objects in the world, each any number of times. Distances are the
//! same in the world and in the object.
//!
//! ```
//! # use residual_bvh::{BuildQuality, Bvh, Ray, build};
//! use glam::{Affine3A, Vec3};
//! use residual_bvh::{Instance, InstancedBvh};
//!
//! # let positions = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]];
//! # let bvh: Bvh<8> = build(&positions, &[[0, 1, 2]], None, BuildQuality::Fast);
//! let instances: Vec<Instance> = (0..10)
//!     .map(|i| Instance {
//!         bvh: 0,
//!         object_to_world: Affine3A::from_translation(Vec3::new(0.0, 0.0, -5.0 * i as f32)),
//!     })
//!     .collect();
//! let scene = InstancedBvh::new(vec![bvh], &instances)?;
//! let ray = Ray::unbounded([0.0, 0.0, -7.0], [0.0, 0.0, -1.0]);
//! let hit = scene.closest_hit(&ray);
//! assert_eq!((hit.instance, hit.hit.prim, hit.hit.t), (2, 0, 3.0));
//! # Ok::<(), residual_bvh::InvalidInstance>(())
//! ```
//!
//! # Files, and vertices that move
//! [`Bvh::write_to`] and [`Bvh::read_from`] take any writer and reader; bytes of any origin are safe
//! to load and trace. [`Bvh::refit`] keeps the tree and moves its triangles.
//!
//! ```
//! # use residual_bvh::{BuildQuality, Bvh, build};
//! # let mut positions = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]];
//! # let triangles = [[0, 1, 2]];
//! # let bvh: Bvh<8> = build(&positions, &triangles, None, BuildQuality::Fast);
//! let mut file = Vec::new();
//! bvh.write_to(&mut file)?;
//! let mut again: Bvh<8> = Bvh::read_from(&mut &file[..])?;
//!
//! positions[0][2] = 3.0;
//! again.refit(&positions, &triangles);
//! assert!(again.bounds().hi[2] >= 3.0);
//! # Ok::<(), residual_bvh::LoadError>(())
//! ```
//!
//! # Layout
//! Everything is aligned to cache lines of 64 bytes. One line of `WideNode<2>` holds both children.
//!
//! | `N` | bytes of a [`WideNode`] | of a [`QuantizedNode`] | `P` | bytes of a [`TrianglePacket`] |
//! |----:|------------------------:|-----------------------:|----:|------------------------------:|
//! |   2 |                      64 |                     64 |   1 |                            64 |
//! |   4 |                     128 |                     64 |   4 |                           192 |
//! |   8 |                     256 |                    128 |   8 |                           320 |
//! |  16 |                     448 |                    192 |  16 |                           640 |
//!
//! A [`CompactBvh`] has packets of 288 bytes, whose 16 triangles share vertices, and which leaves share: a third to a half of
//! the memory of [`Bvh<16, 16>`](Bvh) and the same answers, as fast where registers hold sixteen numbers (AVX-512).
//!
//! A [`QuantizedBvh`] is a [`Bvh`] with smaller nodes and the same answers.
//!
//! ```
//! # use residual_bvh::{BuildQuality, Bvh, Ray, build};
//! use fearless_simd::{Level, dispatch};
//! use residual_bvh::{AllHits, QuantizedBvh, Watertight, closest_hit};
//!
//! # let positions = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]];
//! # let bvh: Bvh<8> = build(&positions, &[[0, 1, 2]], None, BuildQuality::Fast);
//! # let ray = Ray { org: [0.0, 0.0, 1.0], tmin: 0.0, dir: [0.0, 0.0, -1.0], tmax: 10.0 };
//! let small = QuantizedBvh::from(bvh.clone());
//! assert!(small.memory_bytes() < bvh.memory_bytes());
//! let hit = dispatch!(Level::new(), simd =>
//!     closest_hit(simd, Watertight, small.view(), &ray, &AllHits));
//! assert_eq!(hit, bvh.closest_hit(&ray));
//! ```
//!
//! # Kernels
//! The methods of [`Bvh`] look for the machine's instruction set at every call. Code that is
//! compiled for an instruction set itself, with fearless_simd, calls [`closest_hit`], [`any_hit`]
//! and the stream [`Kernel`]s, and chooses the [`Precision`].
//!
//! ```
//! # use residual_bvh::{BuildQuality, Bvh, Ray, build};
//! use fearless_simd::{Level, dispatch};
//! use residual_bvh::{AllHits, Fast, closest_hit};
//!
//! # let positions = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]];
//! # let bvh: Bvh<8> = build(&positions, &[[0, 1, 2]], None, BuildQuality::Fast);
//! # let ray = Ray { org: [0.0, 0.0, 1.0], tmin: 0.0, dir: [0.0, 0.0, -1.0], tmax: 10.0 };
//! let hit = dispatch!(Level::new(), simd => closest_hit(simd, Fast, bvh.view(), &ray, &AllHits));
//! assert_eq!(hit.t, 1.0);
//! ```
//!
//! Rays that come from about one place in about one direction, as a camera's do, are the fastest in packets that are laid out as
//! vector lanes want them: 1.04 (large scenes) to 1.5 times (small ones) as fast as in a stream.
//!
//! ```
//! # use residual_bvh::{BuildQuality, Bvh, Ray, build};
//! use fearless_simd::{Level, dispatch};
//! use residual_bvh::{AllHits, HitPacket, RayPacket, Watertight, closest_hit_packets};
//!
//! # let positions = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]];
//! # let bvh: Bvh<8> = build(&positions, &[[0, 1, 2]], None, BuildQuality::Fast);
//! let mut rays = RayPacket::<32>::NONE;
//! for lane in 0..32 {
//!     rays.set(lane, &Ray::unbounded([0.0, 0.0, 2.0], [lane as f32 / 16.0, 0.0, -1.0]));
//! }
//! let mut hits = [HitPacket::misses(&rays)];
//! dispatch!(Level::new(), simd =>
//!     closest_hit_packets(simd, Watertight, bvh.view(), &[rays], &mut hits, &AllHits));
//! assert_eq!(hits[0].t[0], 2.0);
//! assert_eq!(hits[0].hits(), 0b11111);
//! ```
//!
//! [`traversal_cost`] counts the nodes and packets that [`closest_hit`] visits.
//!
//! ```text
//! positions, triangles ─ build ─ sbvh (binary tree, references) ─ reinsert ─ collapse ─ Bvh<N>
//!                                                                                        │ view
//! Ray ─ prepared ray ─ traverse { slab test of N boxes | triangle test of N triangles } ─ Hit
//! ```
//!
//! In the source, `layout` has what lies in memory, `build` makes trees, `precision` tests triangles,
//! `trace` has the walk and the kernels, `instances` places objects. Each depends on some before it.
//!
//! # Contracts
//! - A closed mesh has no holes: edges and vertices belong to every triangle that shares them.
//! - The answer is a function of the ray and the triangles alone: among hits at the same distance
//!   the smallest triangle index wins, and `(t, u, v, prim)` has the same bits for every width,
//!   instruction set and shape of tree. (Trees with split references, [`BuildQuality::Best`], keep
//!   this up to the ill-conditioned case that `bounds.rs` describes.)
//! - Invalid rays and degenerate triangles never hit and never disturb others.
#![warn(clippy::undocumented_unsafe_blocks)]

mod bounds;
mod build;
mod dispatch;
mod filter;
mod inlined;
mod instances;
mod layout;
mod look_up;
mod pairs;
mod precision;
mod ray;
mod reduce;
mod simd;
mod trace;

pub use bounds::Bounds;
pub use build::{BuildQuality, build, build_compact, build_with_progress};
pub use dispatch::HasKernels;
pub use filter::{AllHits, Culling, FrontHits, HitFilter, MarkedHits};
pub use instances::instance::{Instance, InstanceFault, InvalidInstance};
pub use instances::instanced_bvh::InstancedBvh;
pub use instances::query::{InstanceHit, any_instance_hit, closest_instance_hit};
pub use layout::boxes::Boxes;
pub use layout::bvh::{Bvh, BvhView};
pub use layout::compact::{CompactBvh, CompactPacket, LeafTooLarge};
pub use layout::node::WideNode;
pub use layout::packet::Packet;
pub use layout::quantized::{QuantizedBvh, QuantizedNode};
pub use layout::ray_packet::{HitPacket, RayPacket};
pub use layout::serial::LoadError;
pub use layout::triangle_packet::TrianglePacket;
pub use layout::validate::InvalidBvh;
pub use precision::exact::Exact;
pub use precision::fast::Fast;
pub use precision::triangle_test::Precision;
pub use precision::watertight::Watertight;
pub use ray::{Hit, Ray};
pub use simd::Width;
pub use trace::apart::Apart;
pub use trace::columns::{any_hit_packets, closest_hit_packets};
pub use trace::cost::{TraversalCost, traversal_cost};
pub use trace::one_by_one::OneByOne;
pub use trace::prefetch::prefetch;
pub use trace::single::{any_hit, closest_hit};
pub use trace::stream::{Hybrid, Kernel, Packets, Phased, Single};
