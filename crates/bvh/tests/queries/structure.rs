//! What the builder promises about its bytes, and what [`BvhView::new`] refuses.

use std::collections::BTreeSet;

use residual_bvh::{
    Bounds, BuildQuality, Bvh, BvhView, InvalidBvh, WideNode, build, build_with_progress,
};

use crate::mesh::{Mesh, grid, jittered_icosphere, soup};
use crate::random::Random;

const LEAF: u32 = 1 << 31;

fn build8(mesh: &Mesh, quality: BuildQuality) -> Bvh<8> {
    build(&mesh.positions, &mesh.triangles, None, quality)
}

/// Every triangle is in the tree, below boxes that contain it where it is not split.
#[test]
fn everything_is_in_the_tree() {
    let mut random = Random::new(40);
    let mut mesh = jittered_icosphere(3, &mut random);
    mesh.push([[-50.0, -2.0, -50.0], [50.0, -2.0, -50.0], [0.0, 2.0, 50.0]]);
    for quality in BuildQuality::ALL {
        let bvh = build8(&mesh, quality);
        BvhView::<8, 8>::new(bvh.nodes(), bvh.packets()).expect("a sound tree");
        let ids = bvh.packets().iter().flat_map(|packet| packet.prim_ids);
        let found: BTreeSet<u32> = ids.clone().filter(|&id| id != u32::MAX).collect();
        assert!(found.into_iter().eq(0..mesh.triangles.len() as u32));
        assert!(bvh.sah_cost() > 1.0 && bvh.sah_cost() < 100.0);
        assert_eq!(
            bvh.memory_bytes(),
            256 * bvh.nodes().len() + 320 * bvh.packets().len()
        );

        let all = mesh.positions.iter().fold(Bounds::EMPTY, |all, &position| {
            all.union(&Bounds {
                lo: position,
                hi: position,
            })
        });
        assert!(bvh.bounds().contains(&all));
        if matches!(quality, BuildQuality::Fast | BuildQuality::Medium) {
            assert_eq!(
                ids.filter(|&id| id != u32::MAX).count(),
                mesh.triangles.len()
            );
            for_each_leaf(&bvh, |bounds, packet| {
                for prim in bvh.packets()[packet]
                    .prim_ids
                    .into_iter()
                    .filter(|&id| id != u32::MAX)
                {
                    for position in mesh.vertices(prim as usize) {
                        assert!(bounds.contains(&Bounds {
                            lo: position,
                            hi: position
                        }));
                    }
                }
            });
        }
    }
}

fn for_each_leaf(bvh: &Bvh<8>, visit: impl Fn(Bounds, usize)) {
    for node in bvh.nodes() {
        for slot in 0..8 {
            let child = node.children[slot];
            if child & LEAF != 0 {
                let first = (child & 0x07ff_ffff) as usize;
                let count = (child >> 27 & 15) as usize;
                (first..first + count).for_each(|packet| visit(node.child_bounds(slot), packet));
            }
        }
    }
}

#[test]
fn equal_input_gives_equal_bytes() {
    let mut random = Random::new(41);
    let mesh = soup(3000, 0.1, &mut random);
    for quality in BuildQuality::ALL {
        let text = || {
            let bvh = build8(&mesh, quality);
            format!("{:?}{:?}", bvh.nodes(), bvh.packets())
        };
        assert!(text() == text());
    }
}

/// The bytes do not depend on the number of threads, of which large meshes use all.
#[test]
fn any_number_of_threads_gives_equal_bytes() {
    let mut random = Random::new(44);
    let mut mesh = soup(60_000, 0.01, &mut random);
    let large = soup(2000, 0.5, &mut random);
    (0..2000).for_each(|i| mesh.push(large.vertices(i)));
    for quality in BuildQuality::ALL {
        let bytes = [1, 2, 8].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            let bvh = pool
                .build()
                .expect("threads")
                .install(|| build8(&mesh, quality));
            let bits = |row: [f32; 8]| row.map(f32::to_bits);
            let nodes: Vec<_> = bvh
                .nodes()
                .iter()
                .map(|node| (node.bounds.map(bits), node.children))
                .collect();
            let prims: Vec<_> = bvh.packets().iter().map(|packet| packet.prim_ids).collect();
            (nodes, prims, bvh.sah_cost().to_bits())
        });
        assert!(bytes[0] == bytes[1] && bytes[0] == bytes[2], "{quality:?}");
    }
}

/// Progress stays in its range and ends with everything done.
#[test]
fn progress_is_reported() {
    let mut random = Random::new(46);
    let mesh = soup(30_000, 0.02, &mut random);
    let reports = std::sync::Mutex::new(Vec::new());
    let report = |done: f32| reports.lock().expect("no panic").push(done);
    let quality = BuildQuality::High;
    build_with_progress::<8, 8>(&mesh.positions, &mesh.triangles, None, quality, &report);
    let reports = reports.into_inner().expect("no panic");
    assert!(reports.len() > 5 && reports.iter().all(|done| (0.0..=1.0).contains(done)));
    assert_eq!(reports.last(), Some(&1.0));
}

/// Splits stay within their budget, and are made where triangles are large.
#[test]
fn splits_are_few() {
    let mut random = Random::new(45);
    for size in [0.01, 0.1, 1.0] {
        let mesh = soup(5000, size, &mut random);
        let bvh = build8(&mesh, BuildQuality::High);
        let ids = bvh.packets().iter().flat_map(|packet| packet.prim_ids);
        let references = ids.filter(|&id| id != u32::MAX).count();
        assert!((5000..=7500).contains(&references), "{references}");
    }
}

/// The builder splits the large triangles only when asked for a better tree, and gains by it.
#[test]
fn splitting_lowers_the_cost() {
    let mut random = Random::new(42);
    let mut mesh = soup(2000, 0.02, &mut random);
    for _ in 0..50 {
        mesh.push([[-1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [0.0; 3]].map(|p| {
            let offset = random.in_cube(0.4);
            [0, 1, 2].map(|axis| p[axis] + offset[axis])
        }));
    }
    let medium = build8(&mesh, BuildQuality::Medium).sah_cost();
    let high = build8(&mesh, BuildQuality::High).sah_cost();
    assert!(high < 0.95 * medium, "{high} is not below {medium}");
}

#[test]
fn broken_structures_are_refused() {
    let bvh = build8(&grid(40), BuildQuality::Fast);
    let nodes = bvh.nodes();
    assert!(nodes.len() > 3);
    let inner = |node: &WideNode<8>| (0..8).find(|&slot| node.children[slot] & LEAF == 0);
    let leaf = |node: &WideNode<8>| {
        (0..8).find(|&slot| node.children[slot] >> 27 & 15 != 0 && node.children[slot] & LEAF != 0)
    };
    let inner_slot = inner(&nodes[0]).expect("the root has inner children");
    let leaf_node = nodes
        .iter()
        .position(|node| leaf(node).is_some())
        .expect("there are leaves");
    let leaf_slot = leaf(&nodes[leaf_node]).expect("there is a leaf");
    let refuse = |node: usize, slot: usize, child: u32, expected: InvalidBvh| {
        let mut broken = nodes.to_vec();
        broken[node].children[slot] = child;
        assert_eq!(
            BvhView::<8, 8>::new(&broken, bvh.packets()).unwrap_err(),
            expected
        );
    };
    let bad_child = InvalidBvh::BadChild {
        node: 0,
        slot: inner_slot,
    };
    refuse(0, inner_slot, nodes.len() as u32, bad_child);
    refuse(0, inner_slot, LEAF - 1, bad_child);
    refuse(0, inner_slot, 0, bad_child);
    let bad_leaf = InvalidBvh::BadLeaf {
        node: leaf_node,
        slot: leaf_slot,
    };
    refuse(
        leaf_node,
        leaf_slot,
        LEAF | 1 << 27 | bvh.packets().len() as u32,
        bad_leaf,
    );
    refuse(leaf_node, leaf_slot, u32::MAX, bad_leaf);

    assert_eq!(
        BvhView::<8>::new(&[], &[]).unwrap_err(),
        InvalidBvh::NoNodes
    );
    let bad_bounds = InvalidBvh::BadBounds {
        node: 0,
        slot: inner_slot,
    };
    for value in [0.0, f32::NAN] {
        let mut broken = nodes.to_vec();
        broken[0].bounds[1][inner_slot] = value;
        let error = BvhView::<8, 8>::new(&broken, bvh.packets()).unwrap_err();
        assert_eq!(error, bad_bounds);
        assert!(error.to_string().contains("box"));
    }
}

#[test]
fn shared_and_deep_nodes_are_refused() {
    let mut vacant = *build8(&Mesh::default(), BuildQuality::Fast)
        .nodes()
        .first()
        .expect("a root");
    for row in 0..6 {
        vacant.bounds[row][0] = if row % 2 == 0 { -1.0 } else { 1.0 };
    }
    let chain: Vec<WideNode<8>> = (0..65)
        .map(|i| {
            let mut node = vacant;
            if i < 64 {
                node.children[0] = i + 1;
            }
            node
        })
        .collect();
    assert_eq!(
        BvhView::<8, 8>::new(&chain, &[]).unwrap_err(),
        InvalidBvh::TooDeep { node: 64 }
    );
    let mut fits = chain[..64].to_vec();
    fits[63] = chain[64];
    BvhView::<8, 8>::new(&fits, &[]).expect("64 levels are allowed");

    fits[0].children[1] = 2;
    assert_eq!(
        BvhView::<8, 8>::new(&fits, &[]).unwrap_err(),
        InvalidBvh::BadBounds { node: 0, slot: 1 }
    );
    for row in 0..6 {
        fits[0].bounds[row][1] = fits[0].bounds[row][0];
    }
    assert_eq!(
        BvhView::<8, 8>::new(&fits, &[]).unwrap_err(),
        InvalidBvh::BadChild { node: 1, slot: 0 }
    );
}
