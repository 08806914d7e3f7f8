//! Distances to nearest neighbours, on the square and on the torus.
//!
//! Source: A. Lagae and P. Dutré, A comparison of methods for generating Poisson disk distributions, Computer
//! Graphics Forum 27, 2008, for distances relative to those of the hexagonal lattice. The search is a k-d
//! tree (J. Friedman, J. Bentley and R. Finkel, 1977): a grid would be linear for even sets, but quadratic
//! for clusters, where the tree still takes O(n log n). Knows nothing of who made the points.

use super::sum::mean;
use crate::sampling::voronoi::Domain;
use rayon::prelude::*;

/// Distances of the points of a set to their nearest neighbours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbours {
    /// The smallest: 0 when two points coincide.
    pub minimum: f64,
    /// The mean; about 0.5/sqrt(n) for independent points.
    pub mean: f64,
    /// `minimum` by the smallest distance in a hexagonal lattice as dense, sqrt(2/(sqrt(3) n)): no set of the
    /// torus has more than 1. Good blue noise has about 0.75.
    pub relative_minimum: f64,
    /// `mean` by the same distance.
    pub relative_mean: f64,
}

/// The distances in a set of at least two points, values in [0, 1); `None` for fewer. On the torus the square repeats
/// itself in all directions, as a tile, but a point is not its own neighbour. O(n log n), parallel.
pub fn neighbours(points: &[[f64; 2]], domain: Domain) -> Option<Neighbours> {
    if points.len() < 2 {
        return None;
    }
    let tree = Tree::new(points);
    let distances: Vec<f64> = tree
        .points
        .par_iter()
        .enumerate()
        .map(|(i, p)| tree.nearest(i, p, domain).sqrt())
        .collect();
    let minimum = distances.iter().copied().fold(f64::INFINITY, f64::min);
    let mean = mean(&distances);
    let hexagonal = (2.0 / (3.0_f64.sqrt() * points.len() as f64)).sqrt();
    Some(Neighbours {
        minimum,
        mean,
        relative_minimum: minimum / hexagonal,
        relative_mean: mean / hexagonal,
    })
}

/// Points of a leaf, at most.
const LEAF: usize = 8;

/// A k-d tree: its nodes in depth-first order, and the points in the order of its leaves.
struct Tree {
    points: Vec<[f64; 2]>,
    nodes: Vec<Node>,
}

struct Node {
    /// The smallest box around the points.
    low: [f64; 2],
    high: [f64; 2],
    /// Where its points are.
    start: usize,
    end: usize,
    /// The second child; the first follows its parent. 0: a leaf.
    second: usize,
}

impl Tree {
    fn new(points: &[[f64; 2]]) -> Self {
        let mut points = points.to_vec();
        let mut nodes = Vec::new();
        // By value, so that the tree and the order of sums depend on nothing but the set.
        points.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        let end = points.len();
        build(&mut points, 0, end, &mut nodes);
        Self { points, nodes }
    }

    /// The squared distance of point number `own` to the nearest other.
    fn nearest(&self, own: usize, p: &[f64; 2], domain: Domain) -> f64 {
        let mut nearest = f64::INFINITY;
        let mut open = vec![(0, 0.0)];
        while let Some((index, distance)) = open.pop() {
            if distance >= nearest {
                continue;
            }
            let node: &Node = &self.nodes[index];
            if node.second == 0 {
                for (i, q) in (node.start..).zip(&self.points[node.start..node.end]) {
                    if i != own {
                        nearest = nearest.min(squared(p, q, q, domain));
                    }
                }
            } else {
                let child =
                    |i: usize| (i, squared(p, &self.nodes[i].low, &self.nodes[i].high, domain));
                let (a, b) = (child(index + 1), child(node.second));
                // The nearer child is opened first.
                let (near, far) = if a.1 <= b.1 { (a, b) } else { (b, a) };
                open.extend([far, near]);
            }
        }
        nearest
    }
}

/// Adds the node of the points in `start..end`, and all below it.
fn build(points: &mut [[f64; 2]], start: usize, end: usize, nodes: &mut Vec<Node>) {
    let part = &mut points[start..end];
    let fold =
        |axis: usize, from: f64, f: fn(f64, f64) -> f64| part.iter().map(|p| p[axis]).fold(from, f);
    let low = [0, 1].map(|axis| fold(axis, f64::INFINITY, f64::min));
    let high = [0, 1].map(|axis| fold(axis, f64::NEG_INFINITY, f64::max));
    let node = nodes.len();
    nodes.push(Node { low, high, start, end, second: 0 });
    if end - start <= LEAF {
        return;
    }
    // Half of the points on each side of the longer extent: 2^20 points are 17 levels, coincident or not.
    let axis = usize::from(high[1] - low[1] > high[0] - low[0]);
    let middle = part.len() / 2;
    part.select_nth_unstable_by(middle, |a, b| a[axis].total_cmp(&b[axis]));
    build(points, start, start + middle, nodes);
    nodes[node].second = nodes.len();
    build(points, start + middle, end, nodes);
}

/// The squared distance from p to the box from `low` to `high`: a point where they are equal.
fn squared(p: &[f64; 2], low: &[f64; 2], high: &[f64; 2], domain: Domain) -> f64 {
    let [x, y] = [0, 1].map(|axis| {
        let (below, above) = (low[axis] - p[axis], p[axis] - high[axis]);
        let direct = below.max(above).max(0.0);
        match domain {
            Domain::Square => direct,
            // Around the torus: down to the upper end of the box, or up to its lower end.
            Domain::Torus if direct > 0.0 => direct.min(1.0 + above.min(below)),
            Domain::Torus => 0.0,
        }
    });
    x * x + y * y
}

#[cfg(test)]
mod tests {
    use super::super::tests::{random_set, random_tied_set, shifted};
    use super::*;

    fn brute_force(points: &[[f64; 2]], domain: Domain) -> (f64, f64) {
        let distance = |p: &[f64; 2], q: &[f64; 2]| {
            let [x, y] = [0, 1].map(|axis| {
                let direct = (p[axis] - q[axis]).abs();
                if domain == Domain::Square { direct } else { direct.min(1.0 - direct) }
            });
            (x * x + y * y).sqrt()
        };
        let nearest: Vec<f64> = (0..points.len())
            .map(|i| {
                let others = (0..points.len()).filter(|j| *j != i);
                others.map(|j| distance(&points[i], &points[j])).fold(f64::INFINITY, f64::min)
            })
            .collect();
        let minimum = nearest.iter().copied().fold(f64::INFINITY, f64::min);
        (minimum, nearest.iter().sum::<f64>() / points.len() as f64)
    }

    /// Points within 1e-6 of three places, one of them a corner of the square.
    fn clusters(n: usize, seed: u64) -> Vec<[f64; 2]> {
        let centres = [[0.0, 0.0], [0.3, 0.7], [0.301, 0.7]];
        let spread = random_set(n, seed);
        let near = |(i, p): (usize, &[f64; 2])| {
            let wrapped = |v: f64| if v < 0.0 { v + 1.0 } else { v };
            [0, 1].map(|axis| wrapped(centres[i % 3][axis] + 1e-6 * (p[axis] - 0.5)))
        };
        spread.iter().enumerate().map(near).collect()
    }

    #[test]
    fn against_brute_force() {
        for seed in 0..60 {
            let n = 2 + 7 * seed as usize;
            for points in [random_set(n, seed), random_tied_set(n, seed), clusters(n, seed)] {
                for domain in [Domain::Square, Domain::Torus] {
                    let found = neighbours(&points, domain).unwrap();
                    let (minimum, mean) = brute_force(&points, domain);
                    assert!((found.minimum - minimum).abs() <= 1e-15, "{seed} {domain:?}");
                    assert!((found.mean - mean).abs() <= 1e-14, "{seed} {domain:?}");
                }
            }
        }
    }

    #[test]
    fn closed_forms() {
        // 14 rows of 13 points make nearly a hexagonal lattice: rows are sqrt(3)/2 as far apart as points.
        let row = |i: u32| f64::from(i / 13);
        let hexagonal: Vec<_> = (0..13 * 14)
            .map(|i| [(f64::from(i % 13) + 0.5 * (row(i) % 2.0)) / 13.0, row(i) / 14.0])
            .collect();
        let found = neighbours(&hexagonal, Domain::Torus).unwrap();
        let step = (0.25_f64 / 169.0 + 1.0 / 196.0).sqrt().min(1.0 / 13.0);
        assert!((found.minimum - step).abs() < 1e-14 && found.relative_minimum > 0.95, "{found:?}");
        assert!(found.relative_minimum <= 1.0);

        let at = |i: u32| (f64::from(i) + 0.5) / 8.0;
        let grid: Vec<_> = (0..64).map(|i| [at(i / 8), at(i % 8)]).collect();
        for domain in [Domain::Square, Domain::Torus] {
            let found = neighbours(&grid, domain).unwrap();
            assert_eq!((found.minimum, found.mean), (0.125, 0.125));
            assert!((found.relative_minimum - (3.0_f64.sqrt() / 2.0).sqrt()).abs() < 1e-15);
        }
        let corners = [[0.0, 0.0], [0.9375, 0.9375]];
        let torus = neighbours(&corners, Domain::Torus).unwrap().minimum;
        assert_eq!(torus, 2.0_f64.sqrt() / 16.0);
        assert_eq!(neighbours(&corners, Domain::Square).unwrap().minimum, 2.0_f64.sqrt() * 0.9375);
        assert_eq!(neighbours(&corners[..1], Domain::Torus), None);
        assert_eq!(neighbours(&[], Domain::Square), None);
    }

    /// Only the torus has no edges.
    #[test]
    fn shifts() {
        let points = random_set(400, 1);
        let moved = shifted(&points, [0.43, 0.78]);
        let mean = |set: &[[f64; 2]], domain| neighbours(set, domain).unwrap().mean;
        let difference = |domain| (mean(&points, domain) - mean(&moved, domain)).abs();
        assert!(difference(Domain::Torus) < 1e-14);
        assert!(difference(Domain::Square) > 1e-6);
    }

    /// Clusters and coincident points take no more than n log n: quadratic time would be minutes here.
    #[test]
    fn large_clusters() {
        let found = neighbours(&clusters(200_000, 0), Domain::Torus).unwrap();
        assert!(found.minimum > 0.0 && found.mean < 1e-8, "{found:?}");
        let found = neighbours(&vec![[0.5, 0.5]; 200_000], Domain::Square).unwrap();
        assert_eq!((found.minimum, found.mean), (0.0, 0.0));
    }
}
