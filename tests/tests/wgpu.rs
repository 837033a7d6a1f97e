//! The GPU device against the processor.

use residual_bvh::{BuildQuality, build};
use residual_device_cpu::LaneCount;
use residual_device_wgpu::{Dialect, Gpu, Mapping, Mode, WgpuRenderer};
use residual_render::film::Film;
use residual_render::passes::Pass;
use residual_render::tracer::TracerOptions;
use residual_scenegen::plan::{Plan, PlanOptions, plan};
use residual_tests::{Look, Prepared, read_scene};
use residual_wgsl::Arithmetic;

fn gpu_film(gpu: &Gpu, plan: &Plan, look: &Look, dialect: Dialect, mapping: Mapping) -> Film {
    let bvh = build::<4, 4>(
        &plan.data.positions(),
        &plan.data.triangles(),
        plan.data
            .single_sided
            .contains(&true)
            .then_some(&plan.data.single_sided[..]),
        BuildQuality::Fast,
    );
    let t = std::time::Instant::now();
    let renderer = WgpuRenderer::new(
        gpu,
        dialect,
        mapping,
        &plan.structure,
        &plan.data,
        &bvh,
        look.size,
    )
    .unwrap_or_else(|e| panic!("{e}"));
    println!("compiled {:?}", t.elapsed());
    let mut film = Film::new(look.size[0], look.size[1], 64, plan.structure.layers);
    let options = TracerOptions {
        image: look.size,
        seed: look.seed,
        max_depth: look.max_depth,
        roulette_from: 5,
        reach: look.reach,
    };
    let t = std::time::Instant::now();
    let c = renderer
        .pass(
            &mut film,
            Pass {
                first: 0,
                count: look.samples,
            },
            &options,
        )
        .unwrap_or_else(|e| panic!("{e}"));
    println!("rendered {:?} {c:?}", t.elapsed());
    film
}

#[test]
fn first() {
    let Ok(gpu) = Gpu::open(None) else {
        println!("skipped: no adapter");
        return;
    };
    println!("{}", gpu.adapter);
    let probe = gpu.probe().unwrap_or_else(|e| panic!("{e}"));
    println!(
        "plain: {}\nchosen: {:?}: {}",
        probe.plain, probe.dialect, probe.answers
    );
    let t = std::time::Instant::now();
    let all = gpu
        .ask(&residual_device_wgpu::Question::all(), probe.dialect)
        .unwrap_or_else(|e| panic!("{e}"));
    println!("all in {:?}: {all}", t.elapsed());
    let all = gpu
        .ask(
            &residual_device_wgpu::Question::all(),
            Dialect {
                mode: Mode::Exact,
                arithmetic: Arithmetic::default(),
            },
        )
        .unwrap_or_else(|e| panic!("{e}"));
    println!("exact, all native: {all}");
    let Some(scenes) = residual_tests::scenes() else {
        return;
    };
    let names = std::env::var("SCENES").unwrap_or("interiors/cornell-box.glb".into());
    for name in names.split(',') {
        let scene = read_scene(&scenes.join(name), None).unwrap();
        let side = std::env::var("SIDE").map_or(64, |s| s.parse().unwrap());
        let size = [side, side];
        let plan = plan(
            &scene,
            &PlanOptions {
                size,
                ..PlanOptions::default()
            },
        )
        .unwrap();
        let look = Look::new(size, std::env::var("SPP").map_or(4, |s| s.parse().unwrap()));
        let cpu = Prepared::new(&plan, LaneCount::native()).interpret(&look);
        for (dialect, mapping) in [
            (probe.dialect, Mapping::Wavefront),
            (probe.dialect, Mapping::Megakernel),
            (
                Dialect {
                    mode: Mode::Plain,
                    arithmetic: Arithmetic::default(),
                },
                Mapping::Wavefront,
            ),
        ] {
            let film = gpu_film(&gpu, &plan, &look, dialect, mapping);
            let (a, b) = (cpu.image(), film.image());
            let same = a.iter().zip(&b).filter(|(a, b)| a == b).count();
            println!(
                "{name} {mapping} {:?}: {same} of {} pixels equal; means {:?} {:?}; {}",
                dialect.mode,
                a.len(),
                cpu.mean(),
                film.mean(),
                film.invalid_samples()
            );
        }
    }
}
