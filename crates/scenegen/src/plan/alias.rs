//! Alias tables (Vose 1991), built in `f64`.

/// One slot: its threshold, and the outcome on the other side of it.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Slot {
    threshold: f32,
    alias: u32,
}

/// A table over `weights`, which are finite, not negative, and not all zero.
fn table(weights: &[f64]) -> Vec<Slot> {
    let sum: f64 = weights.iter().sum();
    let scale = weights.len() as f64 / sum;
    let mut left: Vec<f64> = weights.iter().map(|w| w * scale).collect();
    let mut slots: Vec<Slot> = (0..weights.len() as u32)
        .map(|alias| Slot {
            threshold: 1.0,
            alias,
        })
        .collect();
    let (mut small, mut large): (Vec<usize>, Vec<usize>) =
        (0..weights.len()).partition(|&i| left[i] < 1.0);
    while let (Some(s), Some(&l)) = (small.pop(), large.last()) {
        slots[s] = Slot {
            threshold: left[s] as f32,
            alias: l as u32,
        };
        left[l] -= 1.0 - left[s];
        if left[l] < 1.0 {
            large.pop();
            small.push(l);
        }
    }
    // What rounding leaves over among the small ones is full up to rounding; but weight 0 stays 0.
    for s in small {
        if weights[s] == 0.0 {
            let heaviest = (0..weights.len()).max_by(|&a, &b| weights[a].total_cmp(&weights[b]));
            slots[s] = Slot {
                threshold: 0.0,
                alias: heaviest.unwrap_or(s) as u32,
            };
        }
    }
    slots
}

/// The rows that a renderer reads: threshold, alias, and the densities of slot and alias: their weights in
/// terms of `unit`.
pub(super) fn rows(weights: &[f64], unit: f64) -> impl Iterator<Item = [u32; 4]> {
    let density = move |k: usize| ((weights[k] / unit) as f32).to_bits();
    let row = move |(k, slot): (usize, Slot)| {
        let alias = slot.alias as usize;
        [
            slot.threshold.to_bits(),
            slot.alias,
            density(k),
            density(alias),
        ]
    };
    table(weights).into_iter().enumerate().map(row)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The probability of each outcome, enumerated from the table.
    fn probabilities(slots: &[Slot]) -> Vec<f64> {
        let n = slots.len() as f64;
        let mut p = vec![0.0; slots.len()];
        for (i, slot) in slots.iter().enumerate() {
            p[i] += f64::from(slot.threshold) / n;
            p[slot.alias as usize] += (1.0 - f64::from(slot.threshold)) / n;
        }
        p
    }

    #[test]
    fn the_table_has_exactly_the_probabilities() {
        // L-06 by enumeration: log-normal weights, zeros, one outlier.
        let mut state = 1_u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state) / 4_294_967_296.0
        };
        let mut weights: Vec<f64> = (0..10_000)
            .map(|_| {
                ((-2.0 * next().max(1e-12).ln()).sqrt()
                    * (next() * std::f64::consts::TAU).cos()
                    * 4.0)
                    .exp()
            })
            .collect();
        weights[17] = 0.0;
        weights[4711] = 1e6;
        let sum: f64 = weights.iter().sum();
        for (w, p) in weights.iter().zip(probabilities(&table(&weights))) {
            let error = (p - w / sum).abs();
            assert!(error <= 1e-5 * w / sum + 2f64.powi(-32), "{w} {p}");
        }
    }

    #[test]
    fn zero_weights_are_never_drawn() {
        for weights in [vec![0.0, 1.0], vec![1.0, 0.0], vec![0.0, 0.0, 3.0, 0.0]] {
            for (w, p) in weights.iter().zip(probabilities(&table(&weights))) {
                assert_eq!(*w == 0.0, p == 0.0);
            }
        }
    }
}
