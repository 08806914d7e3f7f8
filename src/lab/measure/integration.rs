//! Integrands on the unit square with known integrals, and how the error of a strategy falls with n.
//!
//! Source: D. Mitchell, Consequences of stratified sampling in graphics, SIGGRAPH 1996, for errors of edges
//! and of smooth functions by strategy. The zone plate is the usual test of aliasing. Knows no strategy: it
//! is a function that is called.

use super::quadrature::integral;
use super::sum::sum;
use crate::error::Result;
use crate::math::fun::double::{cos, exp, ln, sin};
use rayon::prelude::*;
use serde::Serialize;
use std::f64::consts::PI;

/// The middle of disc and Gaussian: not that of the square, so that symmetric sets gain nothing.
const CENTRE: [f64; 2] = [0.46, 0.53];
const DISC_RADIUS: f64 = 0.35;
const GAUSSIAN_SIGMA: f64 = 0.2;

/// A function on the unit square, with values in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integrand {
    /// 1 within 0.35 of (0.46, 0.53), 0 elsewhere: an edge, as of every object in a pixel.
    Disc,
    /// exp(-r^2/(2 s^2)), r the distance from (0.46, 0.53), s = 0.2: smooth, nearly without an edge.
    Gaussian,
    /// x y: smooth, but with a jump where the square repeats.
    Bilinear,
    /// (1 + sin((x^2 + y^2) scale))/2: the largest frequency, at the sides away from the origin, is scale/pi
    /// cycles across the square.
    ZonePlate {
        /// Radians, at most 1e6: the time of `exact` grows with it, and beyond it is not exact.
        scale: f64,
    },
}

impl Integrand {
    /// One of each kind.
    pub const ALL: [Self; 4] =
        [Self::Disc, Self::Gaussian, Self::Bilinear, Self::ZonePlate { scale: 60.0 }];

    /// Its name, in lower case.
    pub fn name(self) -> &'static str {
        match self {
            Self::Disc => "disc",
            Self::Gaussian => "gaussian",
            Self::Bilinear => "bilinear",
            Self::ZonePlate { .. } => "zone-plate",
        }
    }

    /// The value at a point of the unit square.
    pub fn value(self, [x, y]: [f64; 2]) -> f64 {
        let (dx, dy) = (x - CENTRE[0], y - CENTRE[1]);
        let from_centre = dx * dx + dy * dy;
        match self {
            Self::Disc => f64::from(from_centre < DISC_RADIUS * DISC_RADIUS),
            Self::Gaussian => exp(-from_centre / (2.0 * GAUSSIAN_SIGMA * GAUSSIAN_SIGMA)),
            Self::Bilinear => x * y,
            Self::ZonePlate { scale } => 0.5 + 0.5 * sin((x * x + y * y) * scale),
        }
    }

    /// The integral over the unit square, to 1e-12.
    pub fn exact(self) -> f64 {
        match self {
            Self::Disc => PI * DISC_RADIUS * DISC_RADIUS,
            // A product of two integrals; its kind has no other closed form than erf.
            Self::Gaussian => {
                let side = |centre: f64| {
                    integral(8, |x| {
                        let d = x - centre;
                        exp(-d * d / (2.0 * GAUSSIAN_SIGMA * GAUSSIAN_SIGMA))
                    })
                };
                side(CENTRE[0]) * side(CENTRE[1])
            }
            Self::Bilinear => 0.25,
            // sin(u + v) = sin u cos v + cos u sin v makes two Fresnel integrals: S(1) C(1) + C(1) S(1),
            // halved. Panels are so narrow that x^2 scale grows by less than 2 in each.
            Self::ZonePlate { scale } => {
                let panels = scale.abs().min(1e6).ceil() as usize + 1;
                let s = integral(panels, |x| sin(x * x * scale));
                let c = integral(panels, |x| cos(x * x * scale));
                0.5 + s * c
            }
        }
    }
}

/// The mean of the integrand over the points less its integral. Without points the mean is 0.
pub fn error(points: &[[f64; 2]], integrand: Integrand) -> f64 {
    error_against(points, integrand, integrand.exact())
}

fn error_against(points: &[[f64; 2]], integrand: Integrand, exact: f64) -> f64 {
    let total = sum(points.iter().map(|p| integrand.value(*p)));
    total / points.len().max(1) as f64 - exact
}

/// How the error of a strategy falls with the number of points.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Convergence {
    /// The errors, in the order of the counts that were asked for.
    pub errors: Vec<RmsError>,
    /// The slope of log(error) over log(n) by least squares: -1/2 for independent points, -3/4 for an edge
    /// and a jittered grid, -1 for a smooth function and the same. Errors below 1e-9, which are those of
    /// rounding, are left out; `None` when fewer than three n remain.
    pub slope: Option<f64>,
}

/// The error of sets of one size.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RmsError {
    /// Points of a set: the mean of what the strategy made, which may differ from what it was asked for.
    pub count: f64,
    /// Root of the mean square error over seeds.
    pub rms_error: f64,
}

/// Root mean square errors of `strategy(n, seed)` for each n of `counts`, over the seeds `0..seeds`, in
/// parallel. The result does not depend on the number of threads.
///
/// # Errors
/// The first error of the strategy, by count and then by seed.
pub fn convergence<Strategy>(
    strategy: Strategy,
    integrand: Integrand,
    counts: &[usize],
    seeds: u64,
) -> Result<Convergence>
where
    Strategy: Fn(usize, u64) -> Result<Vec<[f64; 2]>> + Sync,
{
    let exact = integrand.exact();
    let one_set = |n: usize, seed: u64| {
        let points = strategy(n, seed)?;
        Ok((points.len() as f64, error_against(&points, integrand, exact)))
    };
    let one_size = |&n: &usize| {
        let sets: Vec<_> = (0..seeds).into_par_iter().map(|seed| one_set(n, seed)).collect();
        let sets = sets.into_iter().collect::<Result<Vec<(f64, f64)>>>()?;
        let mean = |f: fn(&(f64, f64)) -> f64| sum(sets.iter().map(f)) / seeds.max(1) as f64;
        Ok(RmsError { count: mean(|set| set.0), rms_error: mean(|set| set.1 * set.1).sqrt() })
    };
    let errors = counts.iter().map(one_size).collect::<Result<Vec<_>>>()?;
    let slope = slope(&errors);
    Ok(Convergence { errors, slope })
}

/// The slope of the least-squares line through (ln count, ln error).
fn slope(errors: &[RmsError]) -> Option<f64> {
    let seen = errors.iter().filter(|e| e.count > 0.0 && e.rms_error > 1e-9);
    let logs: Vec<_> = seen.map(|e| (ln(e.count), ln(e.rms_error))).collect();
    let n = logs.len() as f64;
    let mean_x = sum(logs.iter().map(|l| l.0)) / n;
    let mean_y = sum(logs.iter().map(|l| l.1)) / n;
    let spread = sum(logs.iter().map(|l| (l.0 - mean_x) * (l.0 - mean_x)));
    let shared = sum(logs.iter().map(|l| (l.0 - mean_x) * (l.1 - mean_y)));
    (logs.len() >= 3 && spread > 1e-12).then(|| shared / spread)
}

#[cfg(test)]
mod tests {
    use super::super::tests::random_set;
    use super::*;
    use crate::error::Error;

    /// The middle of each cell of a fine grid: errors fall with the square of its pitch, and for the edge
    /// like those of its hundred thousand cells.
    #[test]
    fn integrals_against_a_fine_grid() {
        let side = 2000;
        let at = |i: i32| (f64::from(i) + 0.5) / f64::from(side);
        let grid: Vec<_> = (0..side * side).map(|i| [at(i / side), at(i % side)]).collect();
        for integrand in Integrand::ALL {
            let allowed = if integrand == Integrand::Disc { 3e-6 } else { 2e-5 };
            let found = error(&grid, integrand);
            assert!(found.abs() < allowed, "{}: {found:e}", integrand.name());
            assert!(grid.iter().all(|p| (0.0..=1.0).contains(&integrand.value(*p))));
        }
        assert_eq!(error(&grid[..0], Integrand::Bilinear), -0.25);
        assert_eq!(error(&[[0.5, 0.5]], Integrand::Bilinear), 0.0);
    }

    /// Fresnel's integrals by their power series, good to 1e-13 for small scales; and more panels change
    /// nothing.
    #[test]
    fn zone_plates_to_the_twelfth_digit() {
        for scale in [0.5, 1.0, 2.0, 5.0] {
            // integral of exp(i s x^2) = sum (i s)^k / (k! (2 k + 1))
            let (mut term, mut c, mut s) = (1.0, 0.0, 0.0);
            for k in 0..60_u32 {
                let sign = if k % 4 < 2 { 1.0 } else { -1.0 };
                let part = sign * term / f64::from(2 * k + 1);
                *(if k % 2 == 0 { &mut c } else { &mut s }) += part;
                term *= scale / f64::from(k + 1);
            }
            let found = Integrand::ZonePlate { scale }.exact();
            assert!((found - 0.5 - s * c).abs() < 1e-13, "{scale}: {found}");
        }
        for scale in [60.0, 1000.0, 30_000.0] {
            let panels = 3 * scale as usize;
            let s = integral(panels, |x| sin(x * x * scale));
            let c = integral(panels, |x| cos(x * x * scale));
            let found = Integrand::ZonePlate { scale }.exact();
            assert!((found - 0.5 - s * c).abs() < 1e-13, "{scale}");
        }
    }

    /// 64 seeds know an rms error to 9 %; six sizes over 2^10 know the slope to 0.015. An error of 0.15 is
    /// caught: ten standard deviations, which chance exceeds less than once in 1e9.
    #[test]
    fn independent_points_have_slope_one_half() {
        let strategy = |n: usize, seed: u64| Ok(random_set(n, seed.wrapping_mul(7919) + n as u64));
        let counts = [16, 64, 256, 1024, 4096, 16_384];
        for integrand in Integrand::ALL {
            let found = convergence(strategy, integrand, &counts, 64).unwrap();
            assert_eq!(found.errors.len(), counts.len());
            let slope = found.slope.unwrap();
            assert!((slope + 0.5).abs() < 0.15, "{}: {slope}", integrand.name());
        }
    }

    #[test]
    fn slopes_are_exact_and_errors_come_through() {
        // x y at (1/2 + 1/n, 1/2): the error is 1/(2 n) in every set.
        let strategy = |n: usize, _| Ok(vec![[0.5 + 1.0 / n as f64, 0.5]; n]);
        let found = convergence(strategy, Integrand::Bilinear, &[4, 8, 64], 3).unwrap();
        assert!((found.slope.unwrap() + 1.0).abs() < 1e-12, "{found:?}");
        assert_eq!(found.errors[1], RmsError { count: 8.0, rms_error: 0.0625 });
        // Errors of 1/4 and 0: the root of the mean square, not the mean.
        let mixed = |_, seed: u64| Ok(vec![[0.5, 1.0 - 0.5 * seed as f64]]);
        let mixed = convergence(mixed, Integrand::Bilinear, &[1], 2).unwrap();
        assert_eq!(mixed.errors[0].rms_error, 0.031_25_f64.sqrt());
        let one = convergence(strategy, Integrand::Bilinear, &[4], 3).unwrap();
        assert_eq!(one.slope, None);
        let none = convergence(strategy, Integrand::Bilinear, &[4, 8], 0).unwrap();
        assert_eq!(none.slope, None);
        let perfect = |_, _| Ok(vec![[0.5, 0.5]]);
        let none = convergence(perfect, Integrand::Bilinear, &[4, 8], 2).unwrap();
        assert_eq!(none.slope, None);
        let fails = |n: usize, seed: u64| match seed {
            0 => Ok(vec![[0.5, 0.5]]),
            _ => Err(Error::Usage(format!("{n} {seed}"))),
        };
        let error = convergence(fails, Integrand::Disc, &[4, 8], 9).unwrap_err();
        assert_eq!(error.to_string(), "4 1");
    }
}
