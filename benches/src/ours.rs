//! Our kernels: the only file that calls them. A new kernel is a line in [`variants`] and, where its signature is new,
//! a macro that wraps it into a [`Stream`].

use std::any::{Any, TypeId};
use std::cell::RefCell;
use std::collections::HashMap;
use std::fmt;
use std::rc::Rc;

use clap::ValueEnum;
use residual_bvh::{
    AllHits, Boxes, BuildQuality, Bvh, BvhView, CompactBvh, HitFilter, HitPacket, Hybrid,
    Kernel as _, OneByOne, Packet, Packets, Phased, RayPacket, Single, Width, any_hit_packets,
    build, build_compact, closest_hit_packets,
};

use crate::contender::{Contender, Stream};
use crate::isa::Isa;
use crate::mesh::Mesh;
use crate::on_isa;

/// How rays are traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Kernel {
    /// One ray, many boxes.
    Single,
    /// Many rays, one box.
    Packet,
    /// Many rays in flight.
    Phased,
    /// Packets that fall apart into single rays, or many rays in flight, as suits the rays.
    Hybrid,
    /// As hybrid, on packets that share vertices: what renderers of sixteen lanes do.
    Compact,
    /// As compact, of packets that are given and answered in columns.
    Columns,
    /// One ray, one box.
    Scalar,
}

impl Kernel {
    /// All, in the order of the tables.
    pub const ALL: [Kernel; 7] = [
        Kernel::Single,
        Kernel::Packet,
        Kernel::Phased,
        Kernel::Hybrid,
        Kernel::Compact,
        Kernel::Columns,
        Kernel::Scalar,
    ];
}

impl fmt::Display for Kernel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Kernel::Single => "single",
            Kernel::Packet => "packet",
            Kernel::Phased => "phased",
            Kernel::Hybrid => "hybrid",
            Kernel::Compact => "compact",
            Kernel::Columns => "columns",
            Kernel::Scalar => "scalar",
        })
    }
}

/// How much arithmetic is spent on edges and vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Precision {
    /// May miss between triangles.
    Fast,
    /// Closed meshes are closed.
    Watertight,
    /// Decided without rounding.
    Exact,
}

impl fmt::Display for Precision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Precision::Fast => "fast",
            Precision::Watertight => "watertight",
            Precision::Exact => "exact",
        })
    }
}

/// One of our kernels on one kind of hierarchy.
#[derive(Clone, Copy)]
pub struct Variant {
    /// How rays are traced.
    pub kernel: Kernel,
    /// Children of a node.
    pub width: usize,
    /// Triangles of a packet in a leaf.
    pub triangle_packet: usize,
    /// Rays traced together.
    pub packet: usize,
    /// Its precision.
    pub precision: Precision,
    /// The contender.
    pub make: fn(&Trees<'_>, Isa) -> Box<dyn Contender>,
}

/// Packets of `R` rays in columns, called as the kernels of streams are.
struct InColumns<const R: usize>;

impl<const R: usize> InColumns<R> {
    #[inline(always)]
    fn closest_hits<S, const N: usize, const P: usize>(
        self,
        simd: S,
        precision: impl residual_bvh::Precision,
        bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
        rays: &[RayPacket<R>],
        hits: &mut [HitPacket<R>],
        filter: &impl HitFilter,
    ) where
        S: Width<N> + Width<P> + Width<R>,
    {
        closest_hit_packets(simd, precision, bvh, rays, hits, filter);
    }

    #[inline(always)]
    fn any_hits<S, const N: usize, const P: usize>(
        self,
        simd: S,
        precision: impl residual_bvh::Precision,
        bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
        rays: &[RayPacket<R>],
        occluded: &mut [u32],
        filter: &impl HitFilter,
    ) where
        S: Width<N> + Width<P> + Width<R>,
    {
        any_hit_packets(simd, precision, bvh, rays, occluded, filter);
    }
}

/// All our kernels.
pub fn variants() -> Vec<Variant> {
    macro_rules! variants {
        ($($kernel:ident($trace:expr, $packet:literal): $tree:ident $n:literal x $p:literal, $precision:ident;)*) => {
            vec![$(Variant {
                kernel: Kernel::$kernel,
                width: $n,
                triangle_packet: $p,
                packet: $packet,
                precision: Precision::$precision,
                make: |trees, isa| {
                    let tree = trees.$tree::<$n, $p>();
                    let same = tree.clone();
                    Box::new(Stream::new(
                        move |rays, hits| {
                            on_isa!(isa, simd => $trace.closest_hits(
                                simd, residual_bvh::$precision, tree.bvh.view(), rays, hits, &AllHits))
                        },
                        move |rays, occluded| {
                            on_isa!(isa, simd => $trace.any_hits(
                                simd, residual_bvh::$precision, same.bvh.view(), rays, occluded, &AllHits))
                        },
                    ))
                },
            }),*]
        };
    }
    variants![
        Single(Single, 1): get 4 x 4, Fast;
        Single(Single, 1): get 8 x 8, Fast;
        Single(Single, 1): get 16 x 8, Fast;
        Single(Single, 1): get 16 x 16, Fast;
        Single(Single, 1): get 4 x 4, Watertight;
        Single(Single, 1): get 8 x 8, Watertight;
        Single(Single, 1): get 16 x 8, Watertight;
        Single(Single, 1): get 16 x 16, Watertight;
        Single(Single, 1): get 8 x 8, Exact;
        Single(Single, 1): get 16 x 16, Exact;
        Packet(Packets::<4>, 4): get 4 x 4, Fast;
        Packet(Packets::<8>, 8): get 8 x 8, Fast;
        Packet(Packets::<16>, 16): get 16 x 16, Fast;
        Phased(Phased, 1): get 8 x 8, Fast;
        Phased(Phased, 1): get 16 x 16, Fast;
        Phased(Phased, 1): get 8 x 8, Watertight;
        Phased(Phased, 1): get 16 x 16, Watertight;
        Hybrid(Hybrid::<4>, 4): get 4 x 4, Fast;
        Hybrid(Hybrid::<32>, 32): get 8 x 8, Fast;
        Hybrid(Hybrid::<32>, 32): get 16 x 16, Fast;
        Hybrid(Hybrid::<32>, 32): get 8 x 8, Watertight;
        Hybrid(Hybrid::<32>, 32): get 16 x 16, Watertight;
        Compact(Hybrid::<32>, 32): compact 16 x 16, Fast;
        Compact(Hybrid::<32>, 32): compact 16 x 16, Watertight;
        Columns(InColumns::<32>, 32): get 8 x 8, Fast;
        Columns(InColumns::<32>, 32): get 8 x 8, Watertight;
        Columns(InColumns::<32>, 32): compact 16 x 16, Fast;
        Columns(InColumns::<32>, 32): compact 16 x 16, Watertight;
        Scalar(OneByOne, 1): get 2 x 1, Fast;
        Scalar(OneByOne, 1): get 4 x 4, Fast;
        Scalar(OneByOne, 1): get 8 x 8, Fast;
        Scalar(OneByOne, 1): get 16 x 16, Fast;
    ]
}

/// What a build cost and gave.
#[derive(Clone, Copy, Debug)]
pub struct BuildCost {
    /// CPU seconds; the build has one thread.
    pub seconds: f64,
    /// Expected cost of a ray by the surface area heuristic, in node tests.
    pub sah_cost: f64,
    /// Size of nodes and packets.
    pub memory_bytes: usize,
}

/// A hierarchy and what it cost.
pub struct Tree<const N: usize, const P: usize> {
    /// The hierarchy.
    pub bvh: Bvh<N, P>,
    /// What it cost.
    pub cost: BuildCost,
}

/// Builds and times one hierarchy.
pub fn build_tree<const N: usize, const P: usize>(
    mesh: &Mesh,
    quality: BuildQuality,
) -> Tree<N, P> {
    let start = residual_frontend::process_time();
    let bvh = build::<N, P>(&mesh.positions, &mesh.triangles, None, quality);
    let cost = BuildCost {
        seconds: (residual_frontend::process_time() - start).as_secs_f64(),
        sah_cost: f64::from(bvh.sah_cost()),
        memory_bytes: bvh.memory_bytes(),
    };
    Tree { bvh, cost }
}

/// A mesh's hierarchies, each built when it is first asked for: of [`BuildQuality::Best`], or as renderers build them.
pub struct Trees<'m> {
    mesh: &'m Mesh,
    built: RefCell<HashMap<TypeId, Rc<dyn Any>>>,
}

impl<'m> Trees<'m> {
    /// None built yet.
    pub fn new(mesh: &'m Mesh) -> Trees<'m> {
        Trees {
            mesh,
            built: RefCell::default(),
        }
    }

    /// The hierarchy with `N` children a node and `P` triangles a packet.
    pub fn get<const N: usize, const P: usize>(&self) -> Rc<Tree<N, P>> {
        self.kept(|mesh| build_tree::<N, P>(mesh, BuildQuality::Best))
    }

    /// The hierarchy whose packets share vertices, of [`BuildQuality::High`].
    fn compact<const N: usize, const P: usize>(&self) -> Rc<Compact<N>> {
        const { assert!(P == 16) };
        self.kept(|mesh| Compact {
            bvh: build_compact(&mesh.positions, &mesh.triangles, None, BuildQuality::High),
        })
    }

    fn kept<T: 'static>(&self, build: impl FnOnce(&Mesh) -> T) -> Rc<T> {
        let mut built = self.built.borrow_mut();
        let tree = built
            .entry(TypeId::of::<T>())
            .or_insert_with(|| Rc::new(build(self.mesh)))
            .clone();
        tree.downcast().expect("trees are kept under their type")
    }
}

/// A hierarchy whose packets share vertices.
struct Compact<const N: usize> {
    bvh: CompactBvh<N>,
}

/// A build to be timed.
pub struct Build {
    /// Children of a node.
    pub width: usize,
    /// Triangles of a packet.
    pub triangle_packet: usize,
    /// Name of the quality.
    pub quality: &'static str,
    /// Builds, or looks up what [`Trees`] has built.
    pub cost: fn(&Trees<'_>) -> BuildCost,
}

/// All shapes of trees with all qualities.
pub fn builds() -> Vec<Build> {
    macro_rules! builds {
        ($($n:literal)*) => {
            vec![$(
                builds!($n, "fast", |trees| build_tree::<$n, $n>(trees.mesh, BuildQuality::Fast).cost),
                builds!($n, "medium", |trees| build_tree::<$n, $n>(trees.mesh, BuildQuality::Medium).cost),
                builds!($n, "high", |trees| build_tree::<$n, $n>(trees.mesh, BuildQuality::High).cost),
                builds!($n, "best", |trees| trees.get::<$n, $n>().cost),
            )*]
        };
        ($n:literal, $quality:literal, $cost:expr) => {
            Build { width: $n, triangle_packet: $n, quality: $quality, cost: $cost }
        };
    }
    builds!(4 8 16)
}
