//! The traversal benchmark: scene by scene, all contenders on all rays.

use std::path::PathBuf;
use std::rc::Rc;

use anyhow::{Result, ensure};
use residual_accuracy::Estimate;

use crate::contender::{Contender, Query};
use crate::embree::{Embree, EmbreeContender, EmbreeScene, Mode, Quality};
use crate::isa::Isa;
use crate::measure::{Measured, Pinned, interleaved};
use crate::ours::{self, Kernel, Precision, Trees};
use crate::peers;
use crate::rays::{RayKind, RaySet, ray_sets};
use crate::recorded::recorded_sets;
use crate::report::{BuildRow, Comparison, Label, Row};
use crate::scene::Scene;

/// What is measured.
#[derive(Clone, Debug)]
pub struct Options {
    /// glTF and OBJ files.
    pub scenes: Vec<PathBuf>,
    /// Measured rounds.
    pub rounds: usize,
    /// Width and height of the image of primary rays.
    pub size: [u32; 2],
    /// Our kernels; all if empty.
    pub kernels: Vec<Kernel>,
    /// Our node widths; all if empty.
    pub widths: Vec<usize>,
    /// Our precisions; all if empty.
    pub precisions: Vec<Precision>,
    /// Rays; all if empty.
    pub rays: Vec<RayKind>,
    /// Instruction set.
    pub isa: Isa,
    /// Whether obvhs takes part.
    pub obvhs: bool,
    /// Whether builds are timed.
    pub builds: bool,
}

/// What was found out about a scene.
pub struct SceneReport {
    /// Its name.
    pub scene: String,
    /// Its triangles.
    pub triangles: usize,
    /// Contenders and rays.
    pub traces: Vec<Row>,
    /// Builds.
    pub builds: Vec<BuildRow>,
}

/// Who takes part, apart from us.
struct Entry {
    label: Label,
    contender: Box<dyn Contender>,
    /// Embree's calls, for comparisons and for their names.
    embree: Option<(Rc<EmbreeScene>, Mode)>,
}

/// Measures all scenes; `report` gets each when it is done, and messages go to standard error.
pub fn traversal(options: &Options, mut report: impl FnMut(SceneReport)) -> Result<()> {
    ensure!(
        options.isa.is_available(),
        "this machine has no {}",
        options.isa
    );
    if options.isa != Isa::compiled_for() {
        eprintln!(
            "note: compiled for {}, measuring {}: code around the kernels, and the compiler's choices in them, differ from \
             a build for it (RUSTFLAGS=\"-C target-cpu=x86-64-v3\" for avx2)",
            Isa::compiled_for(),
            options.isa
        );
    }
    let embree = match Embree::load(options.isa) {
        Ok(embree) => {
            eprintln!("Embree {}, {}", embree.version, options.isa);
            Some(embree)
        }
        Err(missing) => {
            eprintln!("note: {missing}");
            None
        }
    };
    for path in &options.scenes {
        let scene = Scene::load(path)?;
        let view = &scene.view;
        eprintln!(
            "{}: {} triangles, eye {:.3} towards {:.3}",
            scene.name,
            scene.mesh.triangles.len(),
            view.eye,
            view.rotation * glam::Vec3::NEG_Z
        );
        report(measure(&scene, embree.as_ref(), options)?);
    }
    Ok(())
}

fn measure(scene: &Scene, embree: Option<&Rc<Embree>>, options: &Options) -> Result<SceneReport> {
    let _pinned = Pinned::new();
    let trees = Trees::new(&scene.mesh);
    let entries = entries(scene, &trees, embree, options);
    let mut traces = Vec::new();
    let mut sets = ray_sets(scene, options.size);
    if [RayKind::Bounce, RayKind::Shadow]
        .iter()
        .any(|kind| is_wanted(&options.rays, kind))
    {
        sets.extend(recorded_sets(scene, options.size)?);
    }
    for set in sets {
        if is_wanted(&options.rays, &set.kind) && !set.rays.is_empty() {
            traces.extend(rows(scene, &set, &entries, options));
        }
    }
    let builds = if options.builds {
        builds(scene, &trees, embree, options)
    } else {
        Vec::new()
    };
    Ok(SceneReport {
        scene: scene.name.clone(),
        triangles: scene.mesh.triangles.len(),
        traces,
        builds,
    })
}

fn is_wanted<T: PartialEq>(wanted: &[T], one: &T) -> bool {
    wanted.is_empty() || wanted.contains(one)
}

fn entries(
    scene: &Scene,
    trees: &Trees<'_>,
    embree: Option<&Rc<Embree>>,
    options: &Options,
) -> Vec<Entry> {
    let variants: Vec<_> = ours::variants()
        .into_iter()
        .filter(|variant| {
            is_wanted(&options.kernels, &variant.kernel)
                && is_wanted(&options.widths, &variant.width)
                && is_wanted(&options.precisions, &variant.precision)
        })
        .collect();
    let own = variants.iter().map(|variant| Entry {
        label: Label {
            kernel: variant.kernel.to_string(),
            width: Some(variant.width),
            triangle_packet: Some(variant.triangle_packet),
            packet: variant.packet,
            precision: variant.precision.to_string(),
        },
        contender: (variant.make)(trees, options.isa),
        embree: None,
    });
    let mut entries: Vec<Entry> = own.collect();
    if options.obvhs {
        entries.push(peer("obvhs-bvh2", peers::bvh2(&scene.mesh)));
        entries.push(peer("obvhs-cwbvh", peers::cwbvh(&scene.mesh)));
    }
    let is_bundle = |kernel| {
        matches!(
            kernel,
            Kernel::Packet | Kernel::Hybrid | Kernel::Compact | Kernel::Columns
        )
    };
    let robust_packets = variants
        .iter()
        .any(|variant| is_bundle(variant.kernel) && variant.precision != Precision::Fast);
    let packets = options.kernels.is_empty() || options.kernels.iter().copied().any(is_bundle);
    for robust in [false, true] {
        let Some(embree) = embree else { break };
        let built = embree.build(&scene.mesh, Quality::High, robust);
        let bundles = packets && (!robust || robust_packets);
        let modes = Mode::packets().filter(|_| bundles);
        entries.extend([Mode::SINGLE].into_iter().chain(modes).map(|mode| {
            Entry {
                label: Label {
                    kernel: if mode.packet == 1 {
                        "embree-single"
                    } else {
                        "embree-packet"
                    }
                    .to_owned(),
                    width: None,
                    triangle_packet: None,
                    packet: mode.packet,
                    precision: if robust {
                        Precision::Watertight
                    } else {
                        Precision::Fast
                    }
                    .to_string(),
                },
                contender: Box::new(EmbreeContender::new(built.clone(), mode)),
                embree: Some((built.clone(), mode)),
            }
        }));
    }
    entries
}

fn peer(kernel: &str, contender: impl Contender + 'static) -> Entry {
    Entry {
        label: Label {
            kernel: kernel.to_owned(),
            width: None,
            triangle_packet: None,
            packet: 1,
            precision: Precision::Fast.to_string(),
        },
        contender: Box::new(contender),
        embree: None,
    }
}

/// Measures all entries on one set of rays.
fn rows(scene: &Scene, set: &RaySet, entries: &[Entry], options: &Options) -> Vec<Row> {
    let mut prepared: Vec<_> = entries
        .iter()
        .map(|entry| entry.contender.prepare(set.kind.query()))
        .collect();
    let Measured { seconds, hits } = interleaved(&mut prepared, &set.rays, options.rounds);
    for (entry, hits) in entries.iter().zip(hits) {
        if hits.abs_diff(set.hits) as f64 > 1e-3 * set.rays.len() as f64 {
            eprintln!(
                "warning: {}, {} rays: {:?} hits {hits} times, the reference {}",
                scene.name, set.kind, entry.label, set.hits
            );
        }
    }
    let mrays = |seconds: &f64| set.rays.len() as f64 / seconds / 1e6;
    let speeds: Vec<Estimate> = seconds
        .iter()
        .map(|rounds| Estimate::of(rounds.iter().map(mrays).collect()))
        .collect();
    let compare = |index: usize| {
        let rival = rival(&entries[index].label, entries, &speeds)?;
        let ratios = seconds[rival].iter().zip(&seconds[index]);
        Some(Comparison {
            mode: describe(entries[rival].embree.as_ref()?, set.kind.query()),
            mrays_per_s: speeds[rival].median,
            ratio: Some(Estimate::of(
                ratios.map(|(embree, own)| embree / own).collect(),
            )),
        })
    };
    let row = |(index, entry): (usize, &Entry)| Row {
        scene: scene.name.clone(),
        triangles: scene.mesh.triangles.len(),
        label: entry.label.clone(),
        rays: set.kind,
        mrays_per_s: speeds[index],
        embree: match &entry.embree {
            Some(call) => Some(Comparison {
                mode: describe(call, set.kind.query()),
                mrays_per_s: speeds[index].median,
                ratio: None,
            }),
            None => compare(index),
        },
        isa: options.isa,
    };
    entries.iter().enumerate().map(row).collect()
}

fn describe((scene, mode): &(Rc<EmbreeScene>, Mode), query: Query) -> String {
    EmbreeContender::new(scene.clone(), *mode).describe(query)
}

/// The entry of Embree that a contender is compared with: single rays with single rays, packets with the fastest
/// packets; robust where the contender is watertight.
fn rival(label: &Label, entries: &[Entry], speeds: &[Estimate]) -> Option<usize> {
    let in_packets = label.packet > 1;
    let robust = label.precision != Precision::Fast.to_string();
    (0..entries.len())
        .filter(|&index| {
            let call = entries[index].embree.as_ref();
            call.is_some_and(|(scene, mode)| {
                scene.robust == robust && (mode.packet > 1) == in_packets
            })
        })
        .max_by(|&a, &b| speeds[a].median.total_cmp(&speeds[b].median))
}

fn builds(
    scene: &Scene,
    trees: &Trees<'_>,
    embree: Option<&Rc<Embree>>,
    options: &Options,
) -> Vec<BuildRow> {
    let row = |builder, quality: String, seconds| BuildRow {
        scene: scene.name.clone(),
        triangles: scene.mesh.triangles.len(),
        builder,
        quality,
        width: None,
        triangle_packet: None,
        seconds,
        sah_cost: None,
        memory_bytes: None,
    };
    let own = ours::builds()
        .into_iter()
        .filter(|build| is_wanted(&options.widths, &build.width))
        .map(|build| {
            let cost = (build.cost)(trees);
            BuildRow {
                width: Some(build.width),
                triangle_packet: Some(build.triangle_packet),
                sah_cost: Some(cost.sah_cost),
                memory_bytes: Some(cost.memory_bytes),
                ..row("residual", build.quality.to_owned(), cost.seconds)
            }
        });
    let theirs = [Quality::Medium, Quality::High]
        .into_iter()
        .filter_map(|quality| {
            let built = embree?.build(&scene.mesh, quality, false);
            Some(row("embree", quality.to_string(), built.seconds))
        });
    own.chain(theirs).collect()
}
