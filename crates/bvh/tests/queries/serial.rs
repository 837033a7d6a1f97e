//! Hierarchies that were written and read again, and what reading refuses.

use fearless_simd::{Level, dispatch};
use residual_bvh::{
    AllHits, Apart, BuildQuality, Bvh, BvhView, Hit, Hybrid, InvalidBvh, Kernel, LoadError, Ray,
    Watertight, build,
};

use crate::mesh::{Mesh, jittered_icosphere, soup};
use crate::random::Random;
use crate::runner::{aimed, any_hit, closest_hit, same, trials};

const HEADER: usize = 40;

fn written<const N: usize, const P: usize>(bvh: &Bvh<N, P>) -> Vec<u8> {
    let mut bytes = Vec::new();
    bvh.write_to(&mut bytes).expect("room in memory");
    assert_eq!(
        bytes.len(),
        HEADER + 28 * N * bvh.nodes().len() + 40 * P * bvh.packets().len()
    );
    bytes
}

fn read<const N: usize, const P: usize>(mut bytes: &[u8]) -> Result<Bvh<N, P>, LoadError> {
    let bvh = Bvh::read_from(&mut bytes)?;
    assert!(bytes.is_empty());
    Ok(bvh)
}

fn built<const N: usize, const P: usize>(mesh: &Mesh) -> Bvh<N, P> {
    let marks = (!mesh.single_sided.is_empty()).then_some(&mesh.single_sided[..]);
    build(&mesh.positions, &mesh.triangles, marks, BuildQuality::Best)
}

fn round_trip<const N: usize, const P: usize>(mesh: &Mesh) {
    let bvh: Bvh<N, P> = built(mesh);
    let bytes = written(&bvh);
    let again: Bvh<N, P> = read(&bytes).expect("what was written");
    assert!(written(&again) == bytes);
    assert_eq!(again.sah_cost().to_bits(), bvh.sah_cost().to_bits());
}

fn traced(bvh: &Bvh<8>, rays: &[Ray]) -> Vec<Hit> {
    let view = bvh.view();
    dispatch!(Level::new(), simd => {
        let mut hits = vec![Hit::miss(0.0); rays.len()];
        Apart(Hybrid::<8>).closest_hits(simd, Watertight, view, rays, &mut hits, &AllHits);
        for (ray, hit) in rays.iter().zip(&hits) {
            let single = closest_hit(simd, Watertight, view, ray, &AllHits);
            assert_eq!(single.is_hit(), hit.is_hit());
            assert_eq!(any_hit(simd, Watertight, view, ray, &AllHits), hit.is_hit());
        }
        hits
    })
}

#[test]
fn what_is_written_is_read() {
    let mut random = Random::new(90);
    let mesh = soup(5000, 0.1, &mut random).marked(&mut random);
    for mesh in [&mesh, &Mesh::default()] {
        round_trip::<2, 1>(mesh);
        round_trip::<4, 4>(mesh);
        round_trip::<8, 8>(mesh);
        round_trip::<16, 16>(mesh);
        round_trip::<8, 4>(mesh);
    }
    let bvh: Bvh<8> = built(&mesh);
    let again: Bvh<8> = read(&written(&bvh)).expect("what was written");
    let rays: Vec<Ray> = (0..trials(5000))
        .map(|_| aimed(random.in_cube(2.0), mesh.edge_point(&mut random)))
        .collect();
    let (hits, other) = (traced(&bvh, &rays), traced(&again, &rays));
    assert!(hits.iter().zip(&other).all(|(a, b)| same(a, b)));
}

#[test]
fn every_truncation_is_noticed() {
    let mut random = Random::new(91);
    let bytes = written::<4, 4>(&built(&soup(30, 0.5, &mut random)));
    for len in 0..bytes.len() {
        let error = read::<4, 4>(&bytes[..len]).expect_err("too few bytes");
        assert!(matches!(error, LoadError::Truncated), "{len}: {error}");
    }
}

#[test]
fn other_bytes_are_refused() {
    let mut random = Random::new(92);
    let bytes = written::<4, 4>(&built(&soup(30, 0.5, &mut random)));
    let changed = |offset: usize, byte: u8| {
        let mut bytes = bytes.clone();
        bytes[offset] = byte;
        read::<4, 4>(&bytes).expect_err("a changed byte")
    };
    assert!(matches!(changed(0, b'Q'), LoadError::NotAHierarchy));
    assert!(matches!(changed(8, 9), LoadError::Version(9)));
    let error = read::<8, 4>(&bytes).expect_err("other widths");
    let (LoadError::Widths { nodes, packets }, text) = (&error, error.to_string()) else {
        panic!("{error}");
    };
    assert_eq!((*nodes, *packets), (4, 4));
    assert!(text.contains("4 children"), "{text}");

    // More than there is: no memory is taken for it.
    for offset in [27, 35] {
        assert!(matches!(changed(offset, 0x7f), LoadError::Truncated));
    }
    let mut none = bytes[..HEADER].to_vec();
    none[20..36].fill(0);
    let error = read::<4, 4>(&none).expect_err("no root");
    assert!(matches!(error, LoadError::Structure(InvalidBvh::NoNodes)));
}

/// Whatever is loaded can be traced.
#[test]
fn flipped_bits_do_no_harm() {
    let mut random = Random::new(93);
    let mut loaded = 0;
    for round in 0..10 {
        let mesh = if round % 2 == 0 {
            soup(60, 0.4, &mut random)
        } else {
            jittered_icosphere(1, &mut random)
        };
        let bytes = written::<8, 8>(&built(&mesh));
        let rays: Vec<Ray> = (0..20)
            .map(|_| aimed(random.in_cube(2.0), mesh.edge_point(&mut random)))
            .collect();
        for _ in 0..1000 {
            let mut broken = bytes.clone();
            for _ in 0..1 + random.below(4) {
                // Half of them among the header and the nodes.
                let end = [bytes.len(), HEADER + 2 * 224][random.below(2)];
                broken[random.below(end)] ^= 1 << random.below(8);
            }
            let Ok(bvh) = Bvh::<8>::read_from(&mut &broken[..]) else {
                continue;
            };
            BvhView::<8, 8>::new(bvh.nodes(), bvh.packets()).expect("a checked hierarchy");
            loaded += 1;
            for ray in &rays {
                dispatch!(Level::new(), simd => {
                    let view = bvh.view();
                    closest_hit(simd, Watertight, view, ray, &AllHits);
                    any_hit(simd, Watertight, view, ray, &AllHits);
                });
            }
            dispatch!(Level::new(), simd => {
                let mut hits = [Hit::miss(0.0); 20];
                Apart(Hybrid::<8>).closest_hits(simd, Watertight, bvh.view(), &rays, &mut hits, &AllHits);
            });
        }
    }
    assert!((1000..10_000).contains(&loaded), "{loaded}");
}
