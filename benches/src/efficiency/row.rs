//! What is found out, as a table for people and as JSON for programs.

use residual_accuracy::Estimate;
use serde_json::{Value, json};

use super::contender::{Label, Series};
use super::pool::Pool;

/// A contender with one number of samples.
#[derive(Clone, Debug)]
pub struct Row {
    /// Name of the scene.
    pub scene: String,
    /// Who rendered.
    pub label: Label,
    /// Samples per pixel that were taken.
    pub samples: u32,
    /// Images.
    pub runs: usize,
    /// Their relative mean squared errors.
    pub relmse: Estimate,
    /// CPU seconds of an image.
    pub cpu_s: Estimate,
    /// 1 ÷ (relative mean squared error × CPU seconds) of an image.
    pub efficiency: Estimate,
    /// The efficiency over that of the peer's best sampler for as many samples, round by round; `None` for peers, and without one.
    pub of_best_peer: Option<Estimate>,
}

/// Rows of all series; `ours` is the renderer that is compared with the others' best.
pub fn rows(scene: &str, ours: &str, all: &[Series]) -> Vec<Row> {
    let errors = errors(all);
    let efficiencies: Vec<Vec<f64>> = all
        .iter()
        .zip(&errors)
        .map(|(series, errors)| {
            let runs = series.runs.iter().zip(errors);
            runs.map(|(run, error)| 1.0 / (error * run.cpu_s)).collect()
        })
        .collect();
    let median = |index: usize| Estimate::of(efficiencies[index].clone()).median;
    let best_peer = |samples: u32| {
        let peers = (0..all.len())
            .filter(|&index| all[index].label.renderer != ours && all[index].asked_for == samples);
        peers.max_by(|&a, &b| median(a).total_cmp(&median(b)))
    };
    let row = |(index, series): (usize, &Series)| {
        let is_ours = series.label.renderer == ours;
        let best = best_peer(series.asked_for).filter(|_| is_ours);
        let ratios = |best: usize| {
            let pairs = efficiencies[index].iter().zip(&efficiencies[best]);
            Estimate::of(pairs.map(|(own, best)| own / best).collect())
        };
        Row {
            scene: scene.to_owned(),
            label: series.label.clone(),
            samples: series.samples,
            runs: series.runs.len(),
            relmse: Estimate::of(errors[index].clone()),
            cpu_s: Estimate::of(series.runs.iter().map(|run| run.cpu_s).collect()),
            efficiency: Estimate::of(efficiencies[index].clone()),
            of_best_peer: best.map(ratios),
        }
    };
    all.iter().enumerate().map(row).collect()
}

/// The errors of all images, each measured against those of its renderer.
fn errors(all: &[Series]) -> Vec<Vec<f64>> {
    let mut errors = vec![Vec::new(); all.len()];
    for series in all {
        let renderer = &series.label.renderer;
        let alike: Vec<usize> = (0..all.len())
            .filter(|&index| all[index].label.renderer == *renderer)
            .collect();
        if errors[alike[0]].is_empty() {
            let of_pool = Pool::of(alike.iter().map(|&index| &all[index])).errors();
            for (index, own) in alike.into_iter().zip(of_pool) {
                errors[index] = own;
            }
        }
    }
    errors
}

impl Row {
    /// As a JSON object.
    pub fn to_json(&self) -> Value {
        json!({
            "kind": "error",
            "scene": self.scene,
            "renderer": self.label.renderer,
            "variant": self.label.variant,
            "sampler": self.label.sampler,
            "spp": self.samples,
            "runs": self.runs,
            "relmse": self.relmse.median,
            "relmse_ci95": self.relmse.interval,
            "cpu_s": self.cpu_s.median,
            "cpu_s_ci95": self.cpu_s.interval,
            "efficiency": self.efficiency.median,
            "efficiency_ci95": self.efficiency.interval,
            "of_best_peer": self.of_best_peer.map(|ratio| ratio.median),
            "of_best_peer_ci95": self.of_best_peer.map(|ratio| ratio.interval),
        })
    }
}

/// Rows for people: by their samples, then as they are.
pub fn table(rows: &[Row]) -> String {
    let widest = rows.iter().map(|row| row.label.variant.chars().count());
    let width = widest.max().unwrap_or(0).max("variant".len());
    let mut text = format!(
        "{:>5}  {:<10} {:<width$} {:<12} {:>30}  {:>24}  {:>22}  {:>20}\n",
        "spp",
        "renderer",
        "variant",
        "sampler",
        "relMSE [95 %]",
        "CPU s [95 %]",
        "1/(relMSE·s) [95 %]",
        "of the peer's best",
    );
    let mut rows: Vec<_> = rows.iter().collect();
    rows.sort_by_key(|row| row.samples);
    for row in rows {
        let Label {
            renderer,
            variant,
            sampler,
        } = &row.label;
        let small = |e: &Estimate| {
            let [low, high] = e.interval;
            format!("{:.3e} [{low:.3e}, {high:.3e}]", e.median)
        };
        let fixed = |e: &Estimate, digits: usize| {
            let [low, high] = e.interval;
            format!("{:.digits$} [{low:.digits$}, {high:.digits$}]", e.median)
        };
        text.push_str(&format!(
            "{:>5}  {renderer:<10} {variant:<width$} {sampler:<12} {:>30}  {:>24}  {:>22}  {:>20}\n",
            row.samples,
            small(&row.relmse),
            fixed(&row.cpu_s, 3),
            fixed(&row.efficiency, 1),
            row.of_best_peer
                .map_or("-".to_owned(), |ratio| fixed(&ratio, 2)),
        ));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::super::contender::Run;
    use super::*;

    /// Images that differ from 1 by `spread`, each pixel this or that way by chance.
    fn series(renderer: &str, sampler: &str, spread: f32, cpu_s: f64) -> Series {
        let mut random = renderer.len() as u64 + 1000 * sampler.len() as u64;
        let mut pixel = || {
            random = random
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            let sign = if random >> 63 == 0 { 1.0 } else { -1.0 };
            [1.0 + sign * spread; 3]
        };
        let mut run = |_| Run {
            image: (0..500).map(|_| pixel()).collect(),
            cpu_s,
        };
        Series {
            label: Label {
                renderer: renderer.to_owned(),
                variant: "v".to_owned(),
                sampler: sampler.to_owned(),
            },
            asked_for: 64,
            samples: 64,
            runs: (0..40).map(&mut run).collect(),
        }
    }

    #[test]
    fn ours_are_compared_with_the_most_efficient_peer() {
        let all = [
            series("ours", "sobol", 0.1, 2.0),
            series("peer", "slow", 0.1, 4.0),
            series("peer", "noisy", 0.4, 1.0),
        ];
        let rows = rows("scene", "ours", &all);
        // Error² × seconds: 0.01 · 2, 0.01 · 4 and 0.16 · 1, relative to 1.01.
        let efficiency: Vec<f64> = rows.iter().map(|row| row.efficiency.median).collect();
        for (found, expected) in efficiency.iter().zip([50.5, 25.25, 6.31]) {
            assert!((found / expected - 1.0).abs() < 0.05, "{efficiency:?}");
        }
        let ratio = rows[0].of_best_peer.unwrap().median;
        assert!((ratio - 2.0).abs() < 0.1, "{ratio}");
        assert!(rows[1].of_best_peer.is_none() && rows[2].of_best_peer.is_none());
        let text = table(&rows);
        assert_eq!(text.lines().count(), 4, "{text}");
        assert_eq!(rows[2].to_json()["sampler"], "noisy");
    }

    #[test]
    fn without_a_peer_there_is_no_ratio() {
        let rows = rows("scene", "ours", &[series("ours", "sobol", 0.1, 2.0)]);
        assert!(rows[0].of_best_peer.is_none());
        assert!(rows[0].to_json()["of_best_peer"].is_null());
    }
}
