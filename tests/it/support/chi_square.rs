//! Pearson's chi-square test that directions are drawn with the density that is claimed for them.
//!
//! The sphere is cut into cells of about equal probability by a quadtree over (cos theta, phi), refined where
//! a pilot run put its samples, so narrow lobes are resolved as well as broad ones. The density is integrated
//! over each cell by adaptive Gauss quadrature. One more cell counts the samples that were absorbed; its
//! probability is what the density is short of 1. Cells that expect fewer than 5 samples are pooled.
//!
//! Source: K. Pearson, Philosophical Magazine 50, 1900; its use for BSDFs is that of the Mitsuba renderer.

use glint::math::{Vec3, fun::double};
use glint::sampling::CounterRng;
use statrs::distribution::{ChiSquared, ContinuousCDF};
use std::f64::consts::TAU;

/// Samples of the pilot run, and the number of cells that it aims at: more cells resolve more, but dilute a
/// given deviation.
const PILOT: usize = 8192;
const CELLS: usize = 48;

/// Significance of one of `comparisons` tests so that all together raise a false alarm with probability
/// 1e-6 (Sidak 1967).
pub(crate) fn sidak(comparisons: usize) -> f64 {
    1.0 - double::pow(1.0 - 1e-6, 1.0 / comparisons as f64)
}

/// p-value of the hypothesis that `sample` (`None`: absorbed) has the density `pdf` over solid angle, from
/// `count` samples of the stream `seed`; 0 where samples fall but the density is 0, or if it exceeds 1 in all.
pub(crate) fn p_value(
    sample: impl Fn(&mut CounterRng) -> Option<Vec3>,
    pdf: impl Fn(Vec3) -> f32,
    count: usize,
    seed: u64,
) -> f64 {
    // Cells, from a pilot run of its own.
    let mut rng = CounterRng::new(seed ^ 0x7069_6c6f_7400_0000);
    let pilot = (0..PILOT).filter_map(|_| sample(&mut rng)).map(Point::of).collect();
    let mut expected = Vec::new();
    let tree = Tree::new(Cell::SPHERE, pilot, &pdf, &mut expected, 0);
    let total: f64 = expected.iter().sum();
    if total > 1.002 {
        return 0.0;
    }
    expected.push((1.0 - total).max(0.0));

    // Counts; the last cell is absorption.
    let mut observed = vec![0.0; expected.len()];
    let mut rng = CounterRng::new(seed);
    for _ in 0..count {
        let cell = sample(&mut rng).map_or(expected.len() - 1, |w| tree.find(Point::of(w)));
        observed[cell] += 1.0;
    }

    // Pool the small cells, from the smallest up, and compare.
    let mut cells: Vec<(f64, f64)> =
        expected.iter().map(|p| p * count as f64).zip(observed).collect();
    cells.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut statistic, mut pools) = (0.0, 0);
    let mut pool = (0.0, 0.0);
    for (expected, observed) in cells {
        if expected == 0.0 && observed > 0.0 {
            return 0.0;
        }
        pool = (pool.0 + expected, pool.1 + observed);
        if pool.0 >= 5.0 {
            statistic += (pool.1 - pool.0) * (pool.1 - pool.0) / pool.0;
            pools += 1;
            pool = (0.0, 0.0);
        }
    }
    assert!(pools > 1, "the density is concentrated in one cell");
    ChiSquared::new(f64::from(pools - 1))
        .expect("a positive number of degrees of freedom")
        .sf(statistic)
}

/// A direction in cylindrical coordinates, which preserve area.
#[derive(Clone, Copy)]
struct Point {
    z: f64,
    phi: f64,
}

impl Point {
    fn of(w: Vec3) -> Self {
        let phi = double::atan2(w.y.into(), w.x.into());
        Self { z: f64::from(w.z), phi: if phi < 0.0 { phi + TAU } else { phi } }
    }
}

/// A rectangle of directions.
#[derive(Clone, Copy)]
struct Cell {
    z: [f64; 2],
    phi: [f64; 2],
}

impl Cell {
    const SPHERE: Self = Self { z: [-1.0, 1.0], phi: [0.0, TAU] };

    fn centre(&self) -> Point {
        Point { z: 0.5 * (self.z[0] + self.z[1]), phi: 0.5 * (self.phi[0] + self.phi[1]) }
    }

    /// Which of [`Cell::quarters`] holds `point`.
    fn quarter_of(&self, point: Point) -> usize {
        let centre = self.centre();
        usize::from(point.z >= centre.z) + 2 * usize::from(point.phi >= centre.phi)
    }

    fn quarters(&self) -> [Self; 4] {
        let centre = self.centre();
        let z = [[self.z[0], centre.z], [centre.z, self.z[1]]];
        let phi = [[self.phi[0], centre.phi], [centre.phi, self.phi[1]]];
        [0, 1, 2, 3].map(|i| Self { z: z[i & 1], phi: phi[i >> 1] })
    }

    fn split(&self, points: &[Point]) -> [Vec<Point>; 4] {
        let mut parts = [const { Vec::new() }; 4];
        for &point in points {
            parts[self.quarter_of(point)].push(point);
        }
        parts
    }

    /// Integral of the density over the cell: Gauss-Legendre, 4 x 4 points.
    fn gauss(&self, pdf: &impl Fn(Vec3) -> f32) -> f64 {
        const NODES: [(f64, f64); 4] = [
            (-0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
            (-0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
            (0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
            (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
        ];
        let at = |range: [f64; 2], x: f64| 0.5 * (range[0] + range[1] + x * (range[1] - range[0]));
        let mut sum = 0.0;
        for (x, weight_x) in NODES {
            let z = at(self.z, x);
            let r = (1.0 - z * z).max(0.0).sqrt();
            for (y, weight_y) in NODES {
                let phi = at(self.phi, y);
                let w = Vec3::new(
                    (r * double::cos(phi)) as f32,
                    (r * double::sin(phi)) as f32,
                    z as f32,
                );
                sum += weight_x * weight_y * f64::from(pdf(w));
            }
        }
        0.25 * (self.z[1] - self.z[0]) * (self.phi[1] - self.phi[0]) * sum
    }

    /// The same, halving until the quadrature settles and no more than a few pilot samples, the sign of a peak
    /// that it may have missed, lie in one piece.
    fn integrate(
        &self,
        pilot: &[Point],
        pdf: &impl Fn(Vec3) -> f32,
        estimate: f64,
        depth: usize,
    ) -> f64 {
        let quarters = self.quarters();
        let parts = quarters.map(|quarter| quarter.gauss(pdf));
        let sum: f64 = parts.iter().sum();
        let settled = (sum - estimate).abs() <= 1e-7 + 3e-4 * sum;
        if depth == 0 || settled && pilot.len() <= 32 {
            return sum;
        }
        let pilots = self.split(pilot);
        (0..4).map(|i| quarters[i].integrate(&pilots[i], pdf, parts[i], depth - 1)).sum()
    }
}

/// The quadtree; leaves are numbered.
enum Tree {
    Leaf(usize),
    Split(Cell, Box<[Self; 4]>),
}

impl Tree {
    /// Splits where pilot samples crowd, and everywhere down to an eighth of the sphere's extent in both
    /// coordinates (so that no cell crosses the horizon, where densities jump). Appends the leaves'
    /// probabilities to `expected`.
    fn new(
        cell: Cell,
        pilot: Vec<Point>,
        pdf: &impl Fn(Vec3) -> f32,
        expected: &mut Vec<f64>,
        depth: usize,
    ) -> Self {
        if depth >= 2 && pilot.len() <= PILOT / CELLS || depth == 24 {
            expected.push(cell.integrate(&pilot, pdf, cell.gauss(pdf), 7));
            return Self::Leaf(expected.len() - 1);
        }
        let mut pilots = cell.split(&pilot).into_iter();
        let children = cell.quarters().map(|quarter| {
            Self::new(quarter, pilots.next().unwrap_or_default(), pdf, expected, depth + 1)
        });
        Self::Split(cell, Box::new(children))
    }

    fn find(&self, point: Point) -> usize {
        match self {
            Self::Leaf(index) => *index,
            Self::Split(cell, children) => children[cell.quarter_of(point)].find(point),
        }
    }
}
