//! What is found out, as tables for people and as JSON for programs.

use residual_accuracy::Estimate;
use serde_json::{Value, json};

use crate::isa::Isa;
use crate::rays::RayKind;

/// What a contender is, in words.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// `single`, `packet`, `hybrid`, `scalar`; `obvhs-bvh2`, `obvhs-cwbvh`; `embree-single`, `embree-packet`.
    pub kernel: String,
    /// Children of a node, if known.
    pub width: Option<usize>,
    /// Triangles of a packet, if known.
    pub triangle_packet: Option<usize>,
    /// Rays traced together.
    pub packet: usize,
    /// `fast`, `watertight` or `exact`.
    pub precision: String,
}

/// Embree's call that a contender is compared with.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Embree's call and settings.
    pub mode: String,
    /// Its million rays a second.
    pub mrays_per_s: f64,
    /// The contender's speed in Embree's, round by round; `None` where the contender is this call.
    pub ratio: Option<Estimate>,
}

/// One contender on one kind of rays.
#[derive(Clone, Debug)]
pub struct Row {
    /// Name of the scene.
    pub scene: String,
    /// Its triangles.
    pub triangles: usize,
    /// The contender.
    pub label: Label,
    /// The rays.
    pub rays: RayKind,
    /// Million rays a second.
    pub mrays_per_s: Estimate,
    /// `None` without Embree.
    pub embree: Option<Comparison>,
    /// The instruction set of the kernel.
    pub isa: Isa,
}

/// One build.
#[derive(Clone, Debug)]
pub struct BuildRow {
    /// Name of the scene.
    pub scene: String,
    /// Its triangles.
    pub triangles: usize,
    /// `residual` or `embree`.
    pub builder: &'static str,
    /// Its name of the quality.
    pub quality: String,
    /// Children of a node, if known.
    pub width: Option<usize>,
    /// Triangles of a packet, if known.
    pub triangle_packet: Option<usize>,
    /// CPU seconds, one thread.
    pub seconds: f64,
    /// By the surface area heuristic, in node tests; Embree does not tell.
    pub sah_cost: Option<f64>,
    /// Size of the hierarchy; Embree does not tell.
    pub memory_bytes: Option<usize>,
}

impl Row {
    /// One object.
    pub fn to_json(&self) -> Value {
        let embree = self.embree.as_ref();
        let ratio = embree.and_then(|embree| embree.ratio);
        json!({
            "kind": "trace",
            "scene": self.scene,
            "triangles": self.triangles,
            "kernel": self.label.kernel,
            "width": self.label.width,
            "triangle_packet": self.label.triangle_packet,
            "packet": self.label.packet,
            "precision": self.label.precision,
            "rays": self.rays.to_string(),
            "mrays_per_s": self.mrays_per_s.median,
            "mrays_ci95": self.mrays_per_s.interval,
            "embree_mrays_per_s": embree.map(|embree| embree.mrays_per_s),
            "embree_mode": embree.map(|embree| &embree.mode),
            "ratio": ratio.map(|ratio| ratio.median),
            "ratio_ci95": ratio.map(|ratio| ratio.interval),
            "isa": self.isa.to_string(),
            "compiled_for": Isa::compiled_for().to_string(),
        })
    }

    fn to_text(&self) -> String {
        let Label {
            kernel,
            width,
            triangle_packet,
            packet,
            precision,
        } = &self.label;
        let shape = match (width, triangle_packet) {
            (Some(width), Some(packet)) => format!("{width}/{packet}"),
            _ => "-".to_owned(),
        };
        let mrays = interval(&self.mrays_per_s, 2);
        let embree = self.embree.as_ref().map_or_else(String::new, |embree| {
            let ratio = embree.ratio.map(|ratio| interval(&ratio, 3));
            let ratio = ratio.unwrap_or_default();
            format!("{ratio:<22} {:8.2}  {}", embree.mrays_per_s, embree.mode)
        });
        format!(
            "{:<8} {kernel:<14} {shape:>6} {packet:>5}  {precision:<10}  {mrays:<24} {embree}",
            self.rays
        )
    }
}

impl BuildRow {
    fn mtriangles_per_s(&self) -> f64 {
        self.triangles as f64 / self.seconds / 1e6
    }

    /// One object.
    pub fn to_json(&self) -> Value {
        json!({
            "kind": "build",
            "scene": self.scene,
            "triangles": self.triangles,
            "builder": self.builder,
            "quality": self.quality,
            "width": self.width,
            "triangle_packet": self.triangle_packet,
            "threads": 1,
            "seconds": self.seconds,
            "mtriangles_per_s": self.mtriangles_per_s(),
            "sah_cost": self.sah_cost,
            "memory_bytes": self.memory_bytes,
        })
    }

    fn to_text(&self) -> String {
        let or_dash = |text: Option<String>| text.unwrap_or_else(|| "-".to_owned());
        let shape = self.width.zip(self.triangle_packet);
        format!(
            "{:<9} {:<7} {:>6} {:9.3} {:14.3} {:>9} {:>9}",
            self.builder,
            self.quality,
            or_dash(shape.map(|(width, packet)| format!("{width}/{packet}"))),
            self.seconds,
            self.mtriangles_per_s(),
            or_dash(self.sah_cost.map(|cost| format!("{cost:.2}"))),
            or_dash(
                self.memory_bytes
                    .map(|bytes| format!("{:.1}", bytes as f64 / 1e6))
            ),
        )
    }
}

/// A table of contenders.
pub fn trace_table(rows: &[Row]) -> String {
    let mut text = format!(
        "{:<8} {:<14} {:>6} {:>5}  {:<10}  {:<24} {:<22} {:>8}  {}\n",
        "rays",
        "kernel",
        "width",
        "rays",
        "precision",
        "Mrays/s [95 %]",
        "ratio [95 %]",
        "Embree",
        "its call"
    );
    for (index, row) in rows.iter().enumerate() {
        if index > 0 && rows[index - 1].rays != row.rays {
            text.push('\n');
        }
        text.push_str(row.to_text().trim_end());
        text.push('\n');
    }
    text
}

/// A table of builds.
pub fn build_table(rows: &[BuildRow]) -> String {
    let mut text = format!(
        "{:<9} {:<7} {:>6} {:>9} {:>14} {:>9} {:>9}\n",
        "builder", "quality", "width", "seconds", "Mtriangles/s", "SAH cost", "MB"
    );
    for row in rows {
        text.push_str(&row.to_text());
        text.push('\n');
    }
    text
}

pub(crate) fn interval(estimate: &Estimate, digits: usize) -> String {
    let [lo, hi] = estimate.interval;
    format!(
        "{:6.digits$} [{lo:.digits$}, {hi:.digits$}]",
        estimate.median
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_have_the_fields_that_readers_expect() {
        let estimate = Estimate::of(vec![2.0, 3.0, 1.0]);
        let row = Row {
            scene: "room".to_owned(),
            triangles: 12,
            label: Label {
                kernel: "single".to_owned(),
                width: Some(8),
                triangle_packet: Some(4),
                packet: 1,
                precision: "watertight".to_owned(),
            },
            rays: RayKind::Ao,
            mrays_per_s: estimate,
            embree: Some(Comparison {
                mode: "rtcOccluded1 HIGH ROBUST".to_owned(),
                mrays_per_s: 2.0,
                ratio: Some(estimate),
            }),
            isa: Isa::Avx2,
        };
        let json = row.to_json();
        assert_eq!(json["rays"], "ao");
        assert_eq!(json["ratio_ci95"], json!([1.0, 3.0]));
        assert_eq!(json["mrays_per_s"], 2.0);
        assert_eq!(json["isa"], "avx2");
        assert_eq!(json["embree_mode"], "rtcOccluded1 HIGH ROBUST");
        let alone = Row {
            embree: None,
            ..row
        };
        assert!(alone.to_json()["ratio"].is_null());
        assert!(trace_table(&[alone]).contains("8/4"));
    }
}
