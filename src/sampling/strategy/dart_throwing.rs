//! Poisson disk sampling by dart throwing: uniform points, each kept if no point that is there already is near.
//!
//! Source: R. L. Cook, "Stochastic Sampling in Computer Graphics", ACM TOG 5(1), 1986. Every dart is compared with every
//! point, so the cost is quadratic, times the darts a point takes; both are counted and reported.
//! [`super::poisson_disk`] draws from the same distribution in linear time.

use super::fraction::{Fraction, distance_squared};
use super::poisson_disk::Radius;
use super::{PointSet, random_point};
use crate::sampling::CounterRng;

/// Darts in a row that may miss before the radius is given up as too large.
const REJECTION_LIMIT: u32 = 20_000;

/// `count` points on the torus, and what they cost.
pub(super) fn points(count: u32, seed: u64) -> PointSet {
    let mut rng = CounterRng::new(seed);
    let mut points: Vec<[Fraction; 2]> = Vec::with_capacity(count as usize);
    let mut radius = Radius::wanted(count);
    let (mut darts, mut comparisons, mut missed) = (0_u64, 0_u64, 0);
    while points.len() < count as usize {
        let dart = random_point(&mut rng);
        let near = points.iter().position(|p| distance_squared(*p, dart) < radius.squared());
        darts += 1;
        comparisons += near.map_or(points.len(), |i| i + 1) as u64;
        match near {
            None => {
                points.push(dart);
                missed = 0;
            }
            Some(_) => missed += 1,
        }
        if missed == REJECTION_LIMIT {
            radius.shrink();
            missed = 0;
        }
    }
    let facts = vec![
        ("radius", radius.distance()),
        ("radius given up", f64::from(radius.times_shrunk())),
        ("darts", darts as f64),
        ("distances", comparisons as f64),
    ];
    PointSet::new(points, facts)
}
