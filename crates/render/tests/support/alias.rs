//! Alias tables (Walker 1974, Vose 1991), the plainest way.

/// Threshold and alias of each slot, for weights of any scale. Slots of weight 0 are never picked.
pub(crate) fn alias_table(weights: &[f64]) -> Vec<(f32, u32)> {
    let scale = weights.len() as f64 / weights.iter().sum::<f64>();
    let mut rest: Vec<f64> = weights.iter().map(|w| w * scale).collect();
    let (mut small, mut large): (Vec<usize>, Vec<usize>) =
        (0..rest.len()).partition(|&k| rest[k] < 1.0);
    let mut table: Vec<(f32, u32)> = (0..rest.len() as u32).map(|k| (1.0, k)).collect();
    while let (Some(&less), Some(&more)) = (small.last(), large.last()) {
        small.pop();
        table[less] = (rest[less] as f32, more as u32);
        rest[more] -= 1.0 - rest[less];
        if rest[more] < 1.0 {
            large.pop();
            small.push(more);
        }
    }
    table
}

#[test]
fn alias_table_keeps_the_weights() {
    let weights = [0.0, 1.0, 2.0, 0.5, 8.0, 0.0, 3.5];
    let table = alias_table(&weights);
    let mut mass = [0.0; 7];
    for (slot, &(threshold, alias)) in table.iter().enumerate() {
        mass[slot] += f64::from(threshold) / 7.0;
        mass[alias as usize] += (1.0 - f64::from(threshold)) / 7.0;
    }
    for (mass, weight) in mass.iter().zip(weights) {
        assert!((mass - weight / 15.0).abs() < 1e-7, "{mass} {weight}");
    }
}
