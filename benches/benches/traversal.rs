//! `cargo bench -p residual-benches`: a sphere with bumps, so that no file is needed. For figures to be quoted, see
//! `cargo xtask bench traversal`, which measures all contenders in turn.

use std::time::{Duration, Instant};

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use residual_benches::contender::Contender;
use residual_benches::embree::{Embree, EmbreeContender, Mode, Quality};
use residual_benches::isa::Isa;
use residual_benches::mesh::Mesh;
use residual_benches::ours::{Trees, variants};
use residual_benches::peers;
use residual_benches::rays::{RayKind, ray_sets};
use residual_benches::scene::Scene;

fn traversal(criterion: &mut Criterion) {
    let scene = Scene::new(
        "bumpy-sphere".to_owned(),
        Mesh::bumpy_sphere(100, 200),
        None,
    );
    let trees = Trees::new(&scene.mesh);
    let mut contenders: Vec<(String, Box<dyn Contender>)> = Vec::new();
    for variant in variants() {
        let name = format!(
            "{} {}/{} {}",
            variant.kernel, variant.width, variant.triangle_packet, variant.precision
        );
        contenders.push((name, (variant.make)(&trees, Isa::native())));
    }
    contenders.push(("obvhs BVH2".to_owned(), Box::new(peers::bvh2(&scene.mesh))));
    contenders.push((
        "obvhs CWBVH".to_owned(),
        Box::new(peers::cwbvh(&scene.mesh)),
    ));
    match Embree::load(Isa::native()) {
        Ok(embree) => {
            let built = embree.build(&scene.mesh, Quality::High, true);
            let single = EmbreeContender::new(built, Mode::SINGLE);
            contenders.push(("Embree single HIGH ROBUST".to_owned(), Box::new(single)));
        }
        Err(missing) => eprintln!("note: {missing}"),
    }
    for set in ray_sets(&scene, [128, 128]) {
        if set.kind == RayKind::Miss {
            continue;
        }
        let mut group = criterion.benchmark_group(set.kind.to_string());
        group.throughput(Throughput::Elements(set.rays.len() as u64));
        for (name, contender) in &contenders {
            let mut prepared = contender.prepare(set.kind.query());
            group.bench_function(name, |bencher| {
                bencher.iter_custom(|count| {
                    let mut total = Duration::ZERO;
                    for _ in 0..count {
                        prepared.load(&set.rays);
                        let start = Instant::now();
                        prepared.run();
                        total += start.elapsed();
                    }
                    total
                })
            });
        }
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(100))
        .measurement_time(Duration::from_millis(300));
    targets = traversal
}
criterion_main!(benches);
