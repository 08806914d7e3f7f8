//! Measures of point sets: discrepancies, distances, projections, nets, spectra, errors of integration.
//!
//! A set is a slice of points of the unit square, values in [0, 1); of others results mean nothing. Each
//! measure is a file with its source. None knows which strategy made the set. Results have the same bits for
//! any number of threads.

mod envelope;
mod extreme;
mod integration;
mod l2;
mod neighbour;
mod net;
mod projection;
mod quadrature;
mod spectrum;
mod star;
mod sum;
mod text;

pub use extreme::{EXACT_UP_TO, extreme_discrepancy};
pub use integration::{Convergence, Integrand, RmsError, convergence, error};
pub use l2::{centered, l2_star, mixture, wraparound};
pub use neighbour::{Neighbours, neighbours};
pub use net::t_value;
pub use projection::{Projection, projections};
pub use spectrum::{Periodogram, Ring};
pub use star::{Bracket, star_discrepancy};
pub use text::points_from_text;

use crate::sampling::voronoi::Domain;
use serde::Serialize;

/// Everything that is measured of one set. Distances and `t_value` are `None` where they do not exist.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Measures {
    /// What the set is called.
    pub name: String,
    /// n, the number of points.
    pub count: usize,
    /// [`star_discrepancy`].
    pub star_discrepancy: Bracket,
    /// [`extreme_discrepancy`].
    pub extreme_discrepancy: Bracket,
    /// [`l2_star`].
    pub l2_star: f64,
    /// [`centered`].
    pub centered: f64,
    /// [`wraparound`].
    pub wraparound: f64,
    /// [`mixture`].
    pub mixture: f64,
    /// Smallest distance of two points in the square.
    pub min_distance: Option<f64>,
    /// Mean distance to the nearest neighbour in the square.
    pub mean_distance: Option<f64>,
    /// Smallest distance of two points on the torus.
    pub toroidal_min_distance: Option<f64>,
    /// Mean distance to the nearest neighbour on the torus.
    pub toroidal_mean_distance: Option<f64>,
    /// `toroidal_min_distance` by that of a hexagonal lattice ([`Neighbours`]).
    pub relative_min_distance: Option<f64>,
    /// `toroidal_mean_distance` by the distance in a hexagonal lattice.
    pub relative_mean_distance: Option<f64>,
    /// Fraction of the n strata along x that are hit ([`Projection`]).
    pub projection_x: f64,
    /// Fraction of the n strata along y that are hit.
    pub projection_y: f64,
    /// Star discrepancy of the x coordinates alone.
    pub projection_x_discrepancy: f64,
    /// Star discrepancy of the y coordinates alone.
    pub projection_y_discrepancy: f64,
    /// [`t_value`].
    pub t_value: Option<u32>,
    /// [`Periodogram::anisotropy_decibels`] over frequencies up to `anisotropy_limit`.
    pub anisotropy: Option<f64>,
    /// [`spectrum_limit`] of the set.
    pub anisotropy_limit: usize,
}

/// The largest frequency that is measured of n points, in cycles across the square: twice that of a square
/// grid, 2 sqrt(n), but at most 128, where time is n 128^2.
pub fn spectrum_limit(n: usize) -> usize {
    (4 * n).isqrt().min(128)
}

/// Measures the points, values in [0, 1). O(n^2): seconds for 65 536 points.
pub fn measure(name: &str, points: &[[f64; 2]]) -> Measures {
    let bounded = neighbours(points, Domain::Square);
    let toroidal = neighbours(points, Domain::Torus);
    let [projection_x, projection_y] = projections(points);
    let anisotropy_limit = spectrum_limit(points.len());
    Measures {
        name: name.to_owned(),
        count: points.len(),
        star_discrepancy: star_discrepancy(points),
        extreme_discrepancy: extreme_discrepancy(points),
        l2_star: l2_star(points),
        centered: centered(points),
        wraparound: wraparound(points),
        mixture: mixture(points),
        min_distance: bounded.map(|d| d.minimum),
        mean_distance: bounded.map(|d| d.mean),
        toroidal_min_distance: toroidal.map(|d| d.minimum),
        toroidal_mean_distance: toroidal.map(|d| d.mean),
        relative_min_distance: toroidal.map(|d| d.relative_minimum),
        relative_mean_distance: toroidal.map(|d| d.relative_mean),
        projection_x: projection_x.strata,
        projection_y: projection_y.strata,
        projection_x_discrepancy: projection_x.star_discrepancy,
        projection_y_discrepancy: projection_y.star_discrepancy,
        t_value: t_value(points),
        anisotropy: Periodogram::new(points, anisotropy_limit).anisotropy_decibels(),
        anisotropy_limit,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::hash::{combine, mix64};

    /// n independent points of 53 bits a coordinate.
    pub(super) fn random_set(n: usize, seed: u64) -> Vec<[f64; 2]> {
        let key = mix64(seed ^ 0x6c61_625f_7365_7473);
        let unit = |i: usize| (combine(key, i as u64) >> 11) as f64 / 9_007_199_254_740_992.0;
        (0..n).map(|i| [unit(2 * i), unit(2 * i + 1)]).collect()
    }

    /// n points with few different coordinates, 0 and the last number below 1 among them: many are equal in
    /// one or both.
    pub(super) fn random_tied_set(n: usize, seed: u64) -> Vec<[f64; 2]> {
        let values = [0.0, 0.2, 0.25, 0.5, 0.5 + f64::EPSILON, 0.9, 1.0 - f64::EPSILON / 2.0];
        let few = |v: f64| values[(v * values.len() as f64) as usize];
        random_set(n, seed ^ 0xf00d).iter().map(|p| p.map(few)).collect()
    }

    /// Hammersley's set of 2^m points: i/n and the mirrored bits of i.
    pub(super) fn hammersley(m: u32) -> Vec<[f64; 2]> {
        let n = f64::from(1_u32 << m);
        let mirrored = |i: u32| f64::from(i.reverse_bits()) / 4_294_967_296.0;
        (0..1_u32 << m).map(|i| [f64::from(i) / n, mirrored(i)]).collect()
    }

    /// The set moved on the torus.
    pub(super) fn shifted(points: &[[f64; 2]], by: [f64; 2]) -> Vec<[f64; 2]> {
        points.iter().map(|p| [0, 1].map(|axis| (p[axis] + by[axis]).fract())).collect()
    }

    /// Names are promised to users of `--json`.
    #[test]
    fn names_of_fields() {
        let json = serde_json::to_value(measure("net", &hammersley(6))).unwrap();
        let names: Vec<_> = json.as_object().unwrap().keys().cloned().collect();
        for name in
            "name count star_discrepancy extreme_discrepancy l2_star centered wraparound mixture \
                     min_distance mean_distance projection_x projection_y t_value anisotropy"
                .split_whitespace()
        {
            assert!(names.iter().any(|n| n == name), "{name} of {names:?}");
        }
        assert_eq!(json["name"], "net");
        assert_eq!(json["count"], 64);
        assert_eq!(json["t_value"], 0);
        assert_eq!(json["projection_x"], 1.0);
        assert_eq!(json["star_discrepancy"]["low"], json["star_discrepancy"]["high"]);
        assert!(json["anisotropy"].is_f64());
    }

    /// Sets of no, one and coincident points have no infinite number and no NaN, which JSON cannot hold.
    #[test]
    fn small_and_degenerate_sets() {
        for points in [vec![], vec![[0.5, 0.0]], vec![[0.25, 0.75]; 16], random_tied_set(7, 0)] {
            let measured = measure("few", &points);
            let json = serde_json::to_value(&measured).unwrap();
            for (name, value) in json.as_object().unwrap() {
                let absent = ["distance", "t_value", "anisotropy"].iter().any(|n| name.contains(n));
                assert!(!value.is_null() || absent, "{name} of {points:?}");
            }
            assert_eq!(measured.min_distance.is_some(), points.len() > 1);
        }
    }
}
