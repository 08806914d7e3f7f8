//! Chi-square test of a sampler of directions against its density per solid angle.
//!
//! Source of the method: Subr and Arvo, "Statistical Hypothesis Testing for Assessing Monte Carlo
//! Estimators", 2007. Directions are counted in bins of equal solid angle; what is expected there is the
//! integral of the density.

use glint::math::{Frame, Vec3, fun};
use glint::sampling::CounterRng;
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Samples that one comparison draws.
const SAMPLES: usize = 500_000;

/// A cone around an axis, outside of which the density is zero.
#[derive(Clone, Copy)]
pub(super) struct Region {
    pub(super) axis: Vec3,
    /// 1 - cos of the half-angle; 2 for the whole sphere.
    pub(super) one_minus_cos: f32,
}

const RINGS: usize = 6;
const SECTORS: usize = 10;
/// Points a side of a bin, for the integral of the density.
const POINTS: usize = 64;

/// Probability of a deviation at least as large as the one between the directions that `sample` gives for
/// uniform points of the square and the density `pdf`. Fails if one sample in 10^4 is `None` or outside of
/// the region.
pub(super) fn p_value(
    region: Region,
    seed: u64,
    sample: impl Fn([f32; 2]) -> Option<Vec3>,
    pdf: impl Fn(Vec3) -> f64,
) -> f64 {
    let frame = Frame::from_normal(region.axis);
    let height = region.one_minus_cos;
    let mut observed = [0.0_f64; RINGS * SECTORS];
    let mut outside = 0;
    let mut rng = CounterRng::new(seed);
    for _ in 0..SAMPLES {
        let u = [rng.unit(), rng.unit()];
        let bin = sample(u).and_then(|direction| {
            let ring = 0.5 * (direction - region.axis).length_squared() / height;
            let local = frame.local_from_world(direction);
            let turns = (fun::atan2(local.y, local.x) / std::f32::consts::TAU).rem_euclid(1.0);
            let sector = ((turns * SECTORS as f32) as usize).min(SECTORS - 1);
            (ring <= 1.0)
                .then(|| ((ring * RINGS as f32) as usize).min(RINGS - 1) * SECTORS + sector)
        });
        match bin {
            Some(bin) => observed[bin] += 1.0,
            None => outside += 1,
        }
    }
    assert!(outside * 10_000 <= SAMPLES, "{outside} samples are nowhere");

    let mut expected = [0.0_f64; RINGS * SECTORS];
    let point_solid_angle =
        f64::from(height) * std::f64::consts::TAU / (RINGS * SECTORS * POINTS * POINTS) as f64;
    // Jittered, as the density may have kinks along lines of the grid.
    let mut cell = |i: usize, n: usize| (i as f32 + rng.unit()) / n as f32;
    for i in 0..RINGS * POINTS {
        for j in 0..SECTORS * POINTS {
            let h = height * cell(i, RINGS * POINTS);
            let r = (h * (2.0 - h)).sqrt();
            let (sin, cos) = fun::sin_cos_turns(cell(j, SECTORS * POINTS));
            let direction = frame.world_from_local(Vec3::new(r * cos, r * sin, 1.0 - h));
            expected[i / POINTS * SECTORS + j / POINTS] +=
                pdf(direction) * point_solid_angle * SAMPLES as f64;
        }
    }

    // Bins too small for the normal approximation are counted together, and with another if need be.
    let pairs = observed.into_iter().zip(expected);
    let (small, mut bins): (Vec<_>, Vec<_>) = pairs.partition(|&(_, e)| e < 20.0);
    let rest = small.into_iter().fold((0.0, 0.0), |(o, e), bin| (o + bin.0, e + bin.1));
    if rest.1 < 20.0 {
        bins[0] = (bins[0].0 + rest.0, bins[0].1 + rest.1);
    } else {
        bins.push(rest);
    }
    let statistic: f64 = bins.iter().map(|(o, e)| (o - e) * (o - e) / e).sum();
    ChiSquared::new((bins.len() - 1) as f64).unwrap().sf(statistic)
}

/// The level of each of `comparisons` tests whose false alarms together have a probability of at most
/// 1e-6 (Bonferroni).
pub(super) fn level(comparisons: usize) -> f64 {
    1e-6 / comparisons as f64
}
