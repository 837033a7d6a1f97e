//! Whether two renderers render the same scene.

use serde_json::{Value, json};

use super::pool::Pool;

/// The converged means of two renderers.
#[derive(Clone, Debug)]
pub struct Agreement {
    /// Name of the scene.
    pub scene: String,
    /// The renderers.
    pub renderers: [String; 2],
    /// The means of their converged images, red, green and blue.
    pub means: [[f64; 3]; 2],
}

impl Agreement {
    /// Beyond this difference of a mean, two renderers are said to differ.
    pub const NOTABLE: f64 = 0.01;
    /// Beyond this one, they do not render the same scene.
    pub const TOLERABLE: f64 = 0.03;

    /// Compares two converged images.
    pub fn of(scene: &str, renderers: [&str; 2], pools: [&Pool<'_>; 2]) -> Self {
        Self {
            scene: scene.to_owned(),
            renderers: renderers.map(str::to_owned),
            means: pools.map(Pool::mean),
        }
    }

    /// The second's means over the first's; 1 where both are black.
    pub fn ratios(&self) -> [f64; 3] {
        let [first, second] = self.means;
        [0, 1, 2].map(|k| match first[k] == second[k] {
            true => 1.0,
            false => second[k] / first[k],
        })
    }

    /// The largest relative difference of a channel.
    pub fn difference(&self) -> f64 {
        let differences = self.ratios().map(|ratio| (ratio - 1.0).abs());
        differences.into_iter().fold(0.0, f64::max)
    }

    /// As a JSON object.
    pub fn to_json(&self) -> Value {
        json!({
            "kind": "means",
            "scene": self.scene,
            "renderers": self.renderers,
            "means": self.means,
            "ratios": self.ratios(),
        })
    }

    /// As a line, or two.
    pub fn to_text(&self) -> String {
        let list = |values: [f64; 3], digits: usize| {
            values.map(|value| format!("{value:.digits$}")).join(" ")
        };
        let [ours, theirs] = &self.renderers;
        let verdict = match self.difference() {
            d if d <= Self::NOTABLE => "they agree",
            d if d <= Self::TOLERABLE => "they differ, but little",
            _ => "they do not render the same",
        };
        format!(
            "converged means: {ours} {}, {theirs} {}; ratios {}: {verdict}\n",
            list(self.means[0], 4),
            list(self.means[1], 4),
            list(self.ratios(), 4),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn agreement(second: [f64; 3]) -> Agreement {
        Agreement {
            scene: "s".to_owned(),
            renderers: ["a", "b"].map(str::to_owned),
            means: [[0.5, 0.4, 0.0], second],
        }
    }

    #[test]
    fn the_worst_channel_counts() {
        let same = agreement([0.5, 0.4, 0.0]);
        assert_eq!(same.difference(), 0.0);
        assert!(same.to_text().contains("they agree"));
        let little = agreement([0.5, 0.392, 0.0]);
        assert!((little.difference() - 0.02).abs() < 1e-12);
        assert!(little.to_text().contains("but little"));
        let light = agreement([0.5, 0.4, 0.1]);
        assert!(light.difference() > Agreement::TOLERABLE);
        assert!(light.to_text().contains("not render the same"));
    }
}
