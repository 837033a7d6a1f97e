//! What traces a device's rays. Renderers know no hierarchy: streams of rays go in, hits come out.
//!
//! So the kernels are compiled once, not with every scene, and a hierarchy is as wide as suits the machine, not as wide
//! as the shading. It is also where another library's traversal is put in.

use fearless_simd::{Level, Simd, dispatch};
use residual_bvh::{
    AllHits, Apart, BuildQuality, Bvh, CompactBvh, Culling, Hit, HitFilter, Hybrid, Kernel,
    MarkedHits, Precision, Ray, Watertight, build, build_compact, traversal_cost,
};
use residual_render::scene_data::SceneData;

use crate::lanes::{LaneCount, native};

/// Says whether a surface is there where a ray meets it (alpha). A pure function of both.
pub type AlphaFilter<'a> = dyn Fn(&Ray, &Hit) -> bool + 'a;

/// Traces streams of rays against a scene's triangles.
pub trait Traversal {
    /// The nearest hit of each ray; of several at the same distance, the one with the smallest triangle number.
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit], alpha: Option<&AlphaFilter<'_>>);

    /// Whether each ray hits anything.
    fn any_hits(&self, rays: &[Ray], occluded: &mut [bool], alpha: Option<&AlphaFilter<'_>>);

    /// How many nodes and packets of triangles are visited until the nearest hit of each ray is found; 0 where the
    /// traversal does not count.
    fn visits(&self, _rays: &[Ray], visits: &mut [u32], _alpha: Option<&AlphaFilter<'_>>) {
        visits.fill(0);
    }
}

impl<T: Traversal + ?Sized> Traversal for &T {
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit], alpha: Option<&AlphaFilter<'_>>) {
        (**self).closest_hits(rays, hits, alpha);
    }

    fn any_hits(&self, rays: &[Ray], occluded: &mut [bool], alpha: Option<&AlphaFilter<'_>>) {
        (**self).any_hits(rays, occluded, alpha);
    }

    fn visits(&self, rays: &[Ray], visits: &mut [u32], alpha: Option<&AlphaFilter<'_>>) {
        (**self).visits(rays, visits, alpha);
    }
}

/// How many children a hierarchy's nodes have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// As many as suit the machine: as its lanes, whatever the lanes that shade.
    Native,
    /// Four, as GPUs traverse.
    Four,
}

/// A hierarchy.
#[derive(Debug)]
pub struct AnyBvh {
    tree: Tree,
    /// Some triangles are seen from their front only.
    sided: bool,
    alpha_tested: Marks,
}

/// A bit for each triangle.
#[derive(Debug)]
struct Marks(Vec<u64>);

impl Marks {
    fn new(of_triangles: &[bool]) -> Self {
        let word = |marks: &[bool]| {
            let bits = marks
                .iter()
                .zip(0..)
                .map(|(&mark, bit)| u64::from(mark) << bit);
            bits.fold(0, |word, bit| word | bit)
        };
        Self(of_triangles.chunks(64).map(word).collect())
    }

    #[inline(always)]
    fn has(&self, triangle: u32) -> bool {
        let word = self.0.get(triangle as usize / 64);
        word.is_some_and(|word| word >> (triangle % 64) & 1 == 1)
    }
}

/// A width of eight or sixteen is that of an instruction set, for which alone it is compiled.
#[derive(Debug)]
enum Tree {
    Four(Bvh<4>),
    Eight(Bvh<8>),
    /// Sixteen numbers fit a register, in which a packet's shared vertices are looked up.
    Sixteen(CompactBvh<16>),
}

impl AnyBvh {
    /// Builds the hierarchy over a scene's triangles.
    pub fn build(data: &SceneData, width: Width, quality: BuildQuality) -> Self {
        Self::build_moved(data, &data.positions(), width, quality)
    }

    /// The same of triangles that are elsewhere: whose corners are at these positions, three a triangle.
    ///
    /// # Panics
    /// If there are other numbers of them.
    pub fn build_moved(
        data: &SceneData,
        positions: &[[f32; 3]],
        width: Width,
        quality: BuildQuality,
    ) -> Self {
        let triangles = data.triangles();
        assert_eq!(positions.len(), 3 * triangles.len(), "three a triangle");
        let sided = data.single_sided.contains(&true);
        let sides = sided.then_some(data.single_sided.as_slice());
        let children = match width {
            Width::Native => LaneCount::native(),
            Width::Four => LaneCount::Four,
        };
        let tree = match children {
            LaneCount::Sixteen => {
                Tree::Sixteen(build_compact(positions, &triangles, sides, quality))
            }
            LaneCount::Eight => Tree::Eight(build(positions, &triangles, sides, quality)),
            LaneCount::One | LaneCount::Four => {
                Tree::Four(build(positions, &triangles, sides, quality))
            }
        };
        Self {
            tree,
            sided,
            alpha_tested: Marks::new(&data.alpha_tested),
        }
    }

    /// The hierarchy itself, if it is four wide: GPUs traverse such.
    pub fn four_wide(&self) -> Option<&Bvh<4>> {
        match &self.tree {
            Tree::Four(bvh) => Some(bvh),
            Tree::Eight(_) | Tree::Sixteen(_) => None,
        }
    }

    /// The same hierarchy, whose triangles are tested with another precision. Only those who ask for one have it compiled.
    pub fn with_precision<P: Precision>(&self, precision: P) -> PreciseBvh<'_, P> {
        PreciseBvh {
            bvh: self,
            precision,
        }
    }

    /// Bytes of its nodes and triangles.
    pub fn memory_bytes(&self) -> usize {
        match &self.tree {
            Tree::Four(bvh) => bvh.memory_bytes(),
            Tree::Eight(bvh) => bvh.memory_bytes(),
            Tree::Sixteen(bvh) => bvh.memory_bytes(),
        }
    }
}

/// What alpha leaves. It is asked about triangles that may let rays through, only: it is a call across libraries.
struct AlphaTested<'a> {
    alpha: &'a AlphaFilter<'a>,
    alpha_tested: &'a Marks,
}

impl HitFilter for AlphaTested<'_> {
    const CULLING: Culling = Culling::PerTriangle;
    const REJECTS: bool = true;

    #[inline(always)]
    fn accept(&self, ray: &Ray, hit: &Hit) -> bool {
        !self.alpha_tested.has(hit.prim) || (self.alpha)(ray, hit)
    }
}

/// How streams are traced, on whatever instruction set.
const STREAMS: Hybrid<32> = Hybrid;

/// Evaluates an expression for the hierarchy, whatever its width, on instruction set `$S`, with the kernel of its streams.
macro_rules! with_tree {
    ($S:ident, $tree:expr, $kernel:ident, $bvh:ident => $call:expr) => {
        match $tree {
            Tree::Four(bvh) => {
                let ($kernel, $bvh) = (Apart(STREAMS), bvh.view());
                $call
            }
            Tree::Eight(bvh) => {
                if const { native::<$S>() == 8 } {
                    let ($kernel, $bvh) = (Apart(STREAMS), bvh.view());
                    $call
                } else {
                    unreachable!("built for another instruction set")
                }
            }
            Tree::Sixteen(bvh) => {
                if const { native::<$S>() >= 16 } {
                    let ($kernel, $bvh) = (Apart(STREAMS), bvh.view());
                    $call
                } else {
                    unreachable!("built for another instruction set")
                }
            }
        }
    };
}

/// Evaluates an expression with the filter that the scene calls for.
macro_rules! with_filter {
    ($scene:ident, $alpha:ident, $filter:ident => $call:expr) => {
        match $alpha {
            Some(alpha) => {
                let $filter = &AlphaTested {
                    alpha,
                    alpha_tested: &$scene.alpha_tested,
                };
                $call
            }
            None if $scene.sided => {
                let $filter = &MarkedHits;
                $call
            }
            None => {
                let $filter = &AllHits;
                $call
            }
        }
    };
}

/// Watertight, as images are rendered.
impl Traversal for AnyBvh {
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit], alpha: Option<&AlphaFilter<'_>>) {
        self.with_precision(Watertight)
            .closest_hits(rays, hits, alpha);
    }

    fn any_hits(&self, rays: &[Ray], occluded: &mut [bool], alpha: Option<&AlphaFilter<'_>>) {
        self.with_precision(Watertight)
            .any_hits(rays, occluded, alpha);
    }

    fn visits(&self, rays: &[Ray], visits: &mut [u32], alpha: Option<&AlphaFilter<'_>>) {
        dispatch!(Level::new(), simd => self.visits_on(simd, rays, visits, alpha));
    }
}

/// A hierarchy with the precision of its test of triangles. It counts no visits.
#[derive(Clone, Copy, Debug)]
pub struct PreciseBvh<'a, P> {
    bvh: &'a AnyBvh,
    precision: P,
}

/// Streams are traced in packets as wide as the hierarchy where neighbours agree, and with many rays in flight elsewhere.
impl<P: Precision> Traversal for PreciseBvh<'_, P> {
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit], alpha: Option<&AlphaFilter<'_>>) {
        dispatch!(Level::new(), simd => self.closest_hits_on(simd, rays, hits, alpha));
    }

    fn any_hits(&self, rays: &[Ray], occluded: &mut [bool], alpha: Option<&AlphaFilter<'_>>) {
        dispatch!(Level::new(), simd => self.any_hits_on(simd, rays, occluded, alpha));
    }
}

impl<P: Precision> PreciseBvh<'_, P> {
    #[inline(always)]
    fn closest_hits_on<S: Simd>(
        &self,
        simd: S,
        rays: &[Ray],
        hits: &mut [Hit],
        alpha: Option<&AlphaFilter<'_>>,
    ) {
        let (scene, precision) = (self.bvh, self.precision);
        with_tree!(S, &scene.tree, kernel, bvh => with_filter!(scene, alpha, filter =>
            kernel.closest_hits(simd, precision, bvh, rays, hits, filter)));
    }

    #[inline(always)]
    fn any_hits_on<S: Simd>(
        &self,
        simd: S,
        rays: &[Ray],
        occluded: &mut [bool],
        alpha: Option<&AlphaFilter<'_>>,
    ) {
        let (scene, precision) = (self.bvh, self.precision);
        with_tree!(S, &scene.tree, kernel, bvh => with_filter!(scene, alpha, filter =>
            kernel.any_hits(simd, precision, bvh, rays, occluded, filter)));
    }
}

impl AnyBvh {
    #[inline(always)]
    fn visits_on<S: Simd>(
        &self,
        simd: S,
        rays: &[Ray],
        visits: &mut [u32],
        alpha: Option<&AlphaFilter<'_>>,
    ) {
        with_tree!(S, &self.tree, _kernel, bvh => with_filter!(self, alpha, filter => {
            for (ray, visits) in rays.iter().zip(visits) {
                let cost = traversal_cost(simd, Watertight, bvh, ray, filter);
                *visits = cost.nodes + cost.packets;
            }
        }));
    }
}
