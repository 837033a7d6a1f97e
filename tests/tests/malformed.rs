//! Malformed files, all the way: every one ends in an image without invalid samples or in an error; none in a panic,
//! none in minutes of work or gigabytes of memory.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::mpsc;
use std::time::{Duration, Instant};

use residual_device_cpu::LaneCount;
use residual_scenegen::plan::{PlanOptions, plan};
use residual_tests::{Look, Prepared, read_scene, scene_files, scenes};

const TIME_LIMIT: Duration = Duration::from_secs(20);

/// What became of a file.
#[derive(Debug, PartialEq)]
enum Outcome {
    Image,
    Refused,
    InvalidSamples(u64),
    Panicked,
    TimedOut,
}

/// Runs a job on a thread of its own, for a limited time.
fn observe(limit: Duration, job: impl FnOnce() -> Outcome + Send + 'static) -> Outcome {
    let (sender, receiver) = mpsc::channel();
    std::thread::spawn(move || {
        let outcome = catch_unwind(AssertUnwindSafe(job)).unwrap_or(Outcome::Panicked);
        let _ = sender.send(outcome);
    });
    receiver.recv_timeout(limit).unwrap_or(Outcome::TimedOut)
}

fn render(path: &Path) -> Outcome {
    let Ok(scene) = read_scene(path, None) else {
        return Outcome::Refused;
    };
    let size = [16, 16];
    let Ok(plan) = plan(
        &scene,
        &PlanOptions {
            size,
            ..PlanOptions::default()
        },
    ) else {
        return Outcome::Refused;
    };
    let look = Look {
        threads: 1,
        ..Look::new(size, 1)
    };
    let film = Prepared::new(&plan, LaneCount::native()).interpret(&look);
    match film.invalid_samples() {
        0 => Outcome::Image,
        count => Outcome::InvalidSamples(count),
    }
}

fn malformed() -> Option<Vec<PathBuf>> {
    Some(scene_files(&scenes()?.join("malformed")))
}

#[test]
fn every_malformed_file_ends_in_an_image_or_an_error() {
    let Some(files) = malformed() else { return };
    let (mut images, mut refused, mut faults) = (0, 0, Vec::new());
    for path in files {
        let start = Instant::now();
        let job = path.clone();
        match observe(TIME_LIMIT, move || render(&job)) {
            Outcome::Image => images += 1,
            Outcome::Refused => refused += 1,
            fault => faults.push((path.clone(), fault)),
        }
        if start.elapsed() > Duration::from_secs(1) {
            println!("{}: {:.1} s", path.display(), start.elapsed().as_secs_f64());
        }
    }
    println!("{images} rendered, {refused} refused");
    assert!(faults.is_empty(), "{faults:#?}");
    assert!(
        images > 20 && refused > 20,
        "the files are not what they were"
    );
}

/// A sample of the files through the command line, in 2 GiB of address space: an allocation beyond it would abort.
#[cfg(unix)]
#[test]
fn memory_stays_bounded() {
    let Some(files) = malformed() else { return };
    let folder = tempfile::tempdir().unwrap();
    for path in files.iter().step_by(6) {
        let output = limited(2 << 20)
            .args([
                "render",
                "--quiet",
                "--size",
                "16x16",
                "--spp",
                "1",
                "--threads",
                "1",
            ])
            .args(["--tier", "interpreted", "-o"])
            .arg(folder.path().join("image.png"))
            .arg(path)
            .output()
            .unwrap();
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(
            matches!(output.status.code(), Some(0 | 1)),
            "{}: {}\n{message}",
            path.display(),
            output.status
        );
        if output.status.code() == Some(1) {
            assert!(message.contains("error: "), "{}: {message}", path.display());
        }
        assert!(
            !message.contains("panicked"),
            "{}: {message}",
            path.display()
        );
    }
}

/// The command line with so many KiB of address space.
#[cfg(unix)]
fn limited(kib: u64) -> Command {
    let mut command = Command::new("sh");
    let script = format!("ulimit -v {kib} && exec \"$@\"");
    command.args(["-c", &script, "sh", env!("CARGO_BIN_EXE_residual-tests")]);
    command
}

/// The watch sees panics and slow jobs; given less memory than it needs, the limit kills the program.
#[test]
fn faults_are_seen() {
    assert_eq!(
        observe(TIME_LIMIT, || panic!("on purpose")),
        Outcome::Panicked
    );
    assert_eq!(
        observe(TIME_LIMIT, || Outcome::InvalidSamples(1)),
        Outcome::InvalidSamples(1)
    );
    let slow = || {
        std::thread::sleep(Duration::from_secs(1));
        Outcome::Image
    };
    assert_eq!(observe(Duration::from_millis(10), slow), Outcome::TimedOut);
    #[cfg(unix)]
    {
        let folder = tempfile::tempdir().unwrap();
        let scene = folder.path().join("a.obj");
        std::fs::write(&scene, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
        let output = limited(256 << 10)
            .args([
                "render",
                "--quiet",
                "--size",
                "30000x30000",
                "--spp",
                "1",
                "--threads",
                "1",
            ])
            .args(["--tier", "interpreted", "-o"])
            .arg(folder.path().join("image.png"))
            .arg(&scene)
            .output()
            .unwrap();
        assert!(
            !matches!(output.status.code(), Some(0 | 1)),
            "{}",
            output.status
        );
    }
}
