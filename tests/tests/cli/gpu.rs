//! Renders on GPUs, by the command line.

use std::process::Output;

use residual_device_wgpu::{AdapterDescription, list_adapters};
use residual_tests::pictures::{first_difference, read_exr};
use tempfile::TempDir;

use super::motion::moving;
use super::{fails, good, run, statistics, stderr, workplace};

/// The adapter that renders by default; prints that the test is skipped where there is none.
fn adapter() -> Option<AdapterDescription> {
    let adapter = list_adapters().into_iter().next();
    if adapter.is_none() {
        println!("skipped: no graphics adapter");
    }
    adapter
}

/// Renders the triangle on a device: 20 × 12 pixels, 3 samples. Its kernels are waited for.
fn render(folder: &TempDir, args: &[&str]) -> Output {
    let job = ["render", "triangle.obj", "--size", "20x12", "--spp", "3"];
    run(folder, &[&job[..], &["--threads", "1"], args].concat())
}

#[test]
fn gpus_render_the_processors_image() {
    let Some(adapter) = adapter() else {
        return;
    };
    let folder = workplace();
    let cpu = ["--device", "cpu", "--tier", "interpreted"];
    for tracer in ["path", "bidirectional", "ao"] {
        let job = &["--tracer", tracer];
        let args = [&cpu[..], job, &["-o", "cpu.exr", "--stats", "json"]].concat();
        let of_cpu = statistics(&good(render(&folder, &args)));
        assert_eq!(of_cpu["device"], "cpu");
        assert!(of_cpu["gpu"].is_null());
        for mapping in ["wavefront", "megakernel"] {
            let gpu = ["--device", "wgpu", "--tier", "specialized"];
            let output = ["-o", "gpu.exr", "--stats", "json", "--mapping", mapping];
            let output = good(render(&folder, &[&gpu[..], job, &output].concat()));
            let of_gpu = statistics(&output);
            assert_eq!(of_gpu["device"], "wgpu");
            assert_eq!(of_gpu["tier"], "specialized");
            let gpu = &of_gpu["gpu"];
            let name = gpu["adapter"].as_str().expect("a name");
            assert!(name.contains(&adapter.name), "{name}");
            assert_eq!(gpu["mapping"], mapping);
            // The processor renders the first sample, to compare.
            assert!(gpu["from_samples"].as_u64().expect("samples") <= 1);
            for number in ["compile_seconds", "memory_mib"] {
                assert!(gpu[number].as_f64().expect("a number") > 0.0, "{number}");
            }
            if gpu["exact"] != true {
                println!("skipped: {name}: {}", gpu["answers"]);
                continue;
            }
            assert_eq!(gpu["pixels_equal"], serde_json::json!([240, 240]));
            assert_eq!(of_cpu["rays"], of_gpu["rays"], "{mapping}");
            assert!(!stderr(&output).contains("may differ"));
            let picture = |name: &str| read_exr(&folder.path().join(name)).unwrap().1;
            let difference = first_difference(&picture("cpu.exr"), &picture("gpu.exr"));
            assert_eq!(difference, None, "{mapping}");
        }
    }
}

/// Poses of the scene are copied to the device as samples ask for them.
#[test]
fn gpus_spread_samples_over_the_same_moments() {
    if adapter().is_none() {
        return;
    }
    let folder = moving();
    let picture = |device: &[&str], mapping: &str| {
        let job = ["render", "moving.gltf", "--frame", "12", "--shutter", "24"];
        let look = ["--size", "20x12", "--spp", "20", "--stats", "json"];
        let output = ["-o", "moving.exr", "--mapping", mapping];
        let output = good(run(&folder, &[&job, &look, device, &output].concat()));
        let gpu = statistics(&output)["gpu"].clone();
        let pixels = read_exr(&folder.path().join("moving.exr")).unwrap().1;
        (pixels, gpu)
    };
    let (expected, _) = picture(&["--tier", "interpreted"], "wavefront");
    for mapping in ["wavefront", "megakernel"] {
        let (pixels, gpu) = picture(&["--device", "wgpu", "--tier", "specialized"], mapping);
        if gpu["exact"] != true {
            println!("skipped: {}", gpu["answers"]);
            continue;
        }
        assert_eq!(first_difference(&expected, &pixels), None, "{mapping}");
    }
}

#[test]
fn adapters_are_listed_with_their_arithmetic() {
    let folder = workplace();
    let output = run(&folder, &["adapters"]);
    if adapter().is_none() {
        return fails(&output, &["no graphics adapter", "VK_DRIVER_FILES"]);
    }
    let text = String::from_utf8(good(output).stdout).unwrap();
    for adapter in list_adapters() {
        assert!(text.contains(&adapter.to_string()), "{text}");
    }
    assert!(text.contains("    plain; "), "{text}");
}

#[test]
fn unknown_adapters_are_refused() {
    let Some(adapter) = adapter() else {
        return;
    };
    let folder = workplace();
    let args = ["--device", "wgpu", "--adapter", "nonsense", "-o", "a.png"];
    fails(&render(&folder, &args), &["\"nonsense\"", &adapter.name]);
    assert!(!folder.path().join("a.png").exists());
}

/// A part of the name will do.
#[test]
fn an_adapter_can_be_chosen() {
    let Some(adapter) = adapter() else {
        return;
    };
    let folder = workplace();
    let part: String = adapter.name.chars().take(4).collect();
    let args = ["--device", "wgpu", "--adapter", &part, "-o", "a.png"];
    good(render(&folder, &args));
    assert!(folder.path().join("a.png").exists());
}

#[test]
fn gpus_take_as_many_samples_of_every_pixel() {
    let folder = workplace();
    let args = ["--device", "wgpu", "--adaptive", "-o", "a.png"];
    fails(&render(&folder, &args), &["--adaptive", "--device cpu"]);
    assert!(!folder.path().join("a.png").exists());
}

/// Whether there is an adapter or not: what a GPU runs is made for the scene.
#[test]
fn gpus_do_not_interpret() {
    let folder = workplace();
    let args = ["--device", "wgpu", "--tier", "interpreted", "-o", "a.png"];
    fails(
        &render(&folder, &args),
        &["--tier interpreted", "--device cpu"],
    );
    assert!(!folder.path().join("a.png").exists());
}
