//! Circles of a graph.

use std::collections::{BTreeMap, BTreeSet};

/// What each node leads to.
pub(crate) type Graph = BTreeMap<usize, BTreeSet<usize>>;

/// Strongly connected components of more than one node: all that reach each other. A node that leads to itself is none.
pub(crate) fn circles(graph: &Graph) -> Vec<Vec<usize>> {
    let reached: BTreeMap<usize, BTreeSet<usize>> = graph
        .keys()
        .map(|&node| (node, reachable(graph, node)))
        .collect();
    let reaches = |from: usize, to: usize| reached.get(&from).is_some_and(|set| set.contains(&to));
    let mut circles: Vec<Vec<usize>> = Vec::new();
    for &node in graph.keys() {
        if circles.iter().any(|circle| circle.contains(&node)) {
            continue;
        }
        let is_in_circle = |other: &usize| reaches(node, *other) && reaches(*other, node);
        let circle: Vec<usize> = graph.keys().copied().filter(is_in_circle).collect();
        if circle.len() > 1 {
            circles.push(circle);
        }
    }
    circles
}

/// All that a node leads to, by one edge or more.
fn reachable(graph: &Graph, start: usize) -> BTreeSet<usize> {
    let mut reached = BTreeSet::new();
    let mut open = vec![start];
    while let Some(node) = open.pop() {
        for &next in graph.get(&node).into_iter().flatten() {
            if reached.insert(next) {
                open.push(next);
            }
        }
    }
    reached
}

#[cfg(test)]
mod tests {
    use super::*;

    fn graph(edges: &[(usize, usize)]) -> Graph {
        let mut graph = Graph::new();
        for &(from, to) in edges {
            graph.entry(from).or_default().insert(to);
        }
        graph
    }

    #[test]
    fn components_are_found_apart_from_what_leads_to_them() {
        let found = circles(&graph(&[
            (0, 1),
            (1, 2),
            (2, 1),
            (2, 3),
            (3, 4),
            (4, 5),
            (5, 3),
            (5, 6),
        ]));
        assert_eq!(found, [vec![1, 2], vec![3, 4, 5]]);
    }

    #[test]
    fn a_node_that_leads_to_itself_is_no_circle() {
        assert!(circles(&graph(&[(0, 0), (0, 1), (2, 1)])).is_empty());
    }
}
