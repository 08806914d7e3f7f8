//! Points that are the centroids of their own Voronoi cells: jittered points after Lloyd's relaxation.
//!
//! Source: as [`crate::sampling::voronoi`]. Random points would do as a start, and take more steps.

use super::fraction::{Fraction, from_f64, to_f64};
use super::strata::Strata;
use super::{PointSet, random_point};
use crate::sampling::CounterRng;
use crate::sampling::voronoi::{Domain, relax};

/// Steps at most, and the gain of energy a step below which it is done.
const STEPS: u32 = 500;
const TOLERANCE: f64 = 1e-5;

/// `count` points, and what became of their energy.
pub(super) fn points(count: u32, domain: Domain, seed: u64) -> PointSet {
    let mut rng = CounterRng::new(seed);
    let strata = Strata::new(count);
    let start = (0..count).map(|i| strata.point(i, random_point(&mut rng)).map(to_f64));
    let mut points: Vec<[f64; 2]> = start.collect();
    let energies = relax(&mut points, domain, STEPS, TOLERANCE);
    let points = points.iter().map(|p| p.map(from_f64)).collect::<Vec<[Fraction; 2]>>();
    let energy = |at: Option<&f64>| at.copied().unwrap_or(0.0);
    let facts = vec![
        ("steps", energies.len() as f64),
        ("energy at first", energy(energies.first())),
        ("energy at last", energy(energies.last())),
    ];
    PointSet { points, facts, energies }
}
