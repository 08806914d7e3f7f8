//! A set of points together with what is measured of it: what tables list and pages show.

use super::measure::{Integrand, Measures, Periodogram, convergence, measure, spectrum_limit};
use crate::error::Result;
use crate::sampling::hash::{combine, mix64};
use crate::sampling::voronoi::Domain;
use crate::sampling::{Strategy, to_f64};
use serde::Serialize;

/// A set, and all about it.
#[derive(Clone, Debug)]
pub struct Exhibit {
    /// What made it, in a few words; empty for a set of the user's.
    pub description: &'static str,
    /// In [0, 1)^2.
    pub points: Vec<[f64; 2]>,
    /// Whether it goes on beyond the edges of the square.
    pub domain: Domain,
    /// What making it took: counts and lengths by name.
    pub facts: Vec<(&'static str, f64)>,
    /// The energy that each step of a relaxation began with; empty for other sets.
    pub energies: Vec<f64>,
    /// Of this set; its name as well.
    pub measures: Measures,
    /// The mean of this set's and of those of the seeds after its own, up to ten in all.
    pub spectrum: Periodogram,
}

impl Exhibit {
    /// How many sets of a random strategy make a spectrum, and how many points of them at most.
    const SPECTRA: u64 = 10;
    const SPECTRAL_POINTS: usize = 40_960;

    /// The set of a strategy.
    ///
    /// # Errors
    /// As [`Strategy::points`].
    pub fn of_strategy(strategy: Strategy, count: u32, seed: u64) -> Result<Self> {
        let set = strategy.points(count, seed)?;
        let points: Vec<[f64; 2]> = set.points.iter().map(|p| p.map(to_f64)).collect();
        let sets = Self::SPECTRA.min((Self::SPECTRAL_POINTS / points.len()) as u64).max(1);
        let mut spectral = vec![points.clone()];
        for k in (1..sets).filter(|_| strategy.is_random()) {
            spectral.push(unit_points(strategy, count, seed.wrapping_add(k))?);
        }
        let is_bounded = strategy == Strategy::BoundedVoronoi;
        Ok(Self {
            description: strategy.description(),
            domain: if is_bounded { Domain::Square } else { Domain::Torus },
            facts: set.facts,
            energies: set.energies,
            measures: measure(strategy.name(), &points),
            spectrum: Periodogram::mean_of(&spectral, spectrum_limit(points.len())),
            points,
        })
    }

    /// A set of the user's, points in [0, 1)^2.
    pub fn of_points(name: &str, points: Vec<[f64; 2]>) -> Self {
        Self {
            description: "",
            domain: Domain::Square,
            facts: Vec::new(),
            energies: Vec::new(),
            measures: measure(name, &points),
            spectrum: Periodogram::new(&points, spectrum_limit(points.len())),
            points,
        }
    }
}

/// The measures of a strategy's set alone.
///
/// # Errors
/// As [`Strategy::points`].
pub fn measured(strategy: Strategy, count: u32, seed: u64) -> Result<Measures> {
    Ok(measure(strategy.name(), &unit_points(strategy, count, seed)?))
}

/// How the error of integrating falls with the number of points.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Slopes {
    /// Of the strategy.
    pub name: &'static str,
    /// Numbers of points.
    pub counts: Vec<u32>,
    /// What became of each integrand.
    pub fits: Vec<Fit>,
}

/// The errors of one integrand.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Fit {
    /// What is integrated.
    pub integrand: &'static str,
    /// Root mean square error for each count.
    pub rms_errors: Vec<f64>,
    /// Of the count, fitted: -0.5 for random points.
    pub exponent: Option<f64>,
}

/// Root mean square errors over so many sets, of the seeds after `seed`, of each count that the strategy allows, for every
/// integrand. Sets that depend on no seed are moved around the torus instead: one of them alone would be good or bad by
/// luck of its count.
///
/// # Errors
/// As [`Strategy::points`].
pub fn slopes(strategy: Strategy, counts: &[u32], seed: u64, sets_of_count: u64) -> Result<Slopes> {
    let counts: Vec<u32> = counts.iter().copied().filter(|n| strategy.allows(*n)).collect();
    let sizes: Vec<usize> = counts.iter().map(|n| *n as usize).collect();
    // Each set serves all integrands.
    let one = |n: u32, k: u64| {
        let mut points = strategy.points(n, seed.wrapping_add(k))?.points;
        if !strategy.is_random() {
            let bits = combine(mix64(seed), k);
            let shift = [bits as u32, (bits >> 32) as u32];
            points.iter_mut().for_each(|p| *p = [0, 1].map(|c| p[c].wrapping_add(shift[c])));
        }
        Ok(points.iter().map(|p| p.map(to_f64)).collect::<Vec<_>>())
    };
    let mut sets = Vec::new();
    for n in &counts {
        let of_count: Result<Vec<_>> = (0..sets_of_count).map(|k| one(*n, k)).collect();
        sets.push(of_count?);
    }
    let found = |n: usize, k: u64| {
        let place = sizes.iter().position(|size| *size == n).unwrap_or(0);
        Ok(sets[place][k as usize].clone())
    };
    let mut fits = Vec::new();
    for integrand in Integrand::ALL {
        let convergence = convergence(found, integrand, &sizes, sets_of_count)?;
        let rms_errors = convergence.errors.iter().map(|e| e.rms_error).collect();
        fits.push(Fit { integrand: integrand.name(), rms_errors, exponent: convergence.slope });
    }
    Ok(Slopes { name: strategy.name(), counts, fits })
}

fn unit_points(strategy: Strategy, count: u32, seed: u64) -> Result<Vec<[f64; 2]>> {
    Ok(strategy.points(count, seed)?.points.iter().map(|p| p.map(to_f64)).collect())
}
