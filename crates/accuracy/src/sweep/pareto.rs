//! Of many ways to spend time, those that no other beats in both time and error.

/// Indices of the points (cost, error) for which no other point costs as little and errs as little, by cost. Of points that cost more,
/// only those count that err less by more than the part `least_gain` of the error, from 0 to 1: where errors are noisy, small gains mean
/// nothing.
///
/// ```
/// use residual_accuracy::sweep::{knee, pareto_front};
///
/// let points = [[1.0, 9.0], [2.0, 3.0], [3.0, 4.0], [8.0, 2.5]];
/// let front = pareto_front(&points, 0.0);
/// assert_eq!(front, [0, 1, 3]);
/// assert_eq!(pareto_front(&points, 0.5), [0, 1]);
/// assert_eq!(knee(&points, &front), Some(1));
/// ```
pub fn pareto_front(points: &[[f64; 2]], least_gain: f64) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| {
        let by_cost = points[a][0].total_cmp(&points[b][0]);
        by_cost.then(points[a][1].total_cmp(&points[b][1]))
    });
    let mut least = f64::INFINITY;
    order.retain(|&index| {
        let error = points[index][1];
        let is_better = error < least && error <= least * (1.0 - least_gain);
        if is_better {
            least = error;
        }
        is_better
    });
    order
}

/// The point of a front that is the farthest below the line between its ends, where both scales are logarithmic: before it, time
/// buys much, after it, little. `None` if none is below the line.
pub fn knee(points: &[[f64; 2]], front: &[usize]) -> Option<usize> {
    let place = |index: usize| points[index].map(f64::ln);
    let ([first, ..], [.., last]) = (front, front) else {
        return None;
    };
    let ([x0, y0], [x1, y1]) = (place(*first), place(*last));
    // Positive below the line, as the cost rises and the error falls along a front.
    let below = |index: usize| {
        let [x, y] = place(index);
        (y1 - y0) * (x - x0) - (x1 - x0) * (y - y0)
    };
    let farthest = front
        .iter()
        .copied()
        .max_by(|&a, &b| below(a).total_cmp(&below(b)));
    farthest.filter(|&index| below(index) > 1e-9)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_front_is_what_brute_force_says() {
        let points: Vec<[f64; 2]> = (0..200_u32)
            .map(|k| [7919, 104_729].map(|p| f64::from(k.wrapping_mul(p) % 97 + 1)))
            .collect();
        let front = pareto_front(&points, 0.0);
        for (index, point) in points.iter().enumerate() {
            let beaten = points
                .iter()
                .any(|o| o != point && o[0] <= point[0] && o[1] <= point[1]);
            let twin = front.iter().any(|&k| points[k] == *point);
            assert_eq!(twin, !beaten, "{point:?}");
            assert!(twin || !front.contains(&index));
        }
    }

    #[test]
    fn straight_fronts_have_no_knee() {
        let points = [1.0, 2.0, 4.0, 8.0].map(|x| [x, 1.0 / x]);
        assert_eq!(knee(&points, &pareto_front(&points, 0.0)), None);
        assert_eq!(knee(&[], &[]), None);
        let elbow = [[1.0, 8.0], [2.0, 1.0], [8.0, 0.9]];
        assert_eq!(knee(&elbow, &[0, 1, 2]), Some(1));
    }
}
