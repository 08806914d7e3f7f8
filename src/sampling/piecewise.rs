//! Piecewise-constant densities on [0, 1) and the unit square, sampled by inverting their cumulative sum.
//!
//! Source: pbrt 4th ed., section A.5 (PiecewiseConstant1D, PiecewiseConstant2D). The inverse is
//! monotonic, so a stratified square stays stratified.

use crate::math::ONE_MINUS_EPSILON;

/// Density proportional to a table of non-negative values over equal cells of [0, 1).
#[derive(Clone, Debug)]
pub struct PiecewiseConstant1d {
    /// Cumulative probability at the cell boundaries: n + 1 values from 0 to 1.
    cdf: Vec<f32>,
    integral: f64,
}

impl PiecewiseConstant1d {
    /// Density proportional to `values`; uniform when they sum to zero.
    pub fn new(values: impl ExactSizeIterator<Item = f64> + Clone) -> Self {
        let n = values.len();
        let total: f64 = values.clone().sum();
        let mut running = 0.0;
        let mut cdf = Vec::with_capacity(n + 1);
        cdf.push(0.0);
        for (i, value) in values.enumerate() {
            running += value;
            let fraction = if total > 0.0 { running / total } else { (i + 1) as f64 / n as f64 };
            cdf.push(fraction as f32);
        }
        cdf[n] = 1.0;
        Self { cdf, integral: total / n as f64 }
    }

    /// Integral of the table over [0, 1).
    pub fn integral(&self) -> f64 {
        self.integral
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        self.cdf.len() - 1
    }

    /// Whether there are no cells.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// (position in [0, 1), its density, its cell) for `u` in [0, 1).
    #[inline]
    pub fn sample(&self, u: f32) -> (f32, f32, usize) {
        let cell = self.cdf.partition_point(|&c| c <= u).clamp(1, self.len()) - 1;
        let (low, high) = (self.cdf[cell], self.cdf[cell + 1]);
        let within = if high > low { (u - low) / (high - low) } else { 0.5 };
        let n = self.len() as f32;
        (((cell as f32 + within) / n).min(ONE_MINUS_EPSILON), (high - low) * n, cell)
    }

    /// Density at `x` in [0, 1).
    #[inline]
    pub fn pdf(&self, x: f32) -> f32 {
        let cell = self.cell(x);
        (self.cdf[cell + 1] - self.cdf[cell]) * self.len() as f32
    }

    #[inline]
    fn cell(&self, x: f32) -> usize {
        ((x * self.len() as f32) as usize).min(self.len() - 1)
    }
}

/// Density proportional to a table over the unit square: rows along the second coordinate.
#[derive(Clone, Debug)]
pub struct PiecewiseConstant2d {
    rows: Vec<PiecewiseConstant1d>,
    marginal: PiecewiseConstant1d,
}

impl PiecewiseConstant2d {
    /// Density proportional to `values`, row-major, `width` cells a row.
    pub fn new(values: &[f64], width: usize) -> Self {
        let rows: Vec<_> = values
            .chunks_exact(width)
            .map(|row| PiecewiseConstant1d::new(row.iter().copied()))
            .collect();
        let sums: Vec<f64> = rows.iter().map(PiecewiseConstant1d::integral).collect();
        Self { marginal: PiecewiseConstant1d::new(sums.into_iter()), rows }
    }

    /// Integral of the table over the square.
    pub fn integral(&self) -> f64 {
        self.marginal.integral()
    }

    /// (point, density) for a uniform point of the square.
    #[inline]
    pub fn sample(&self, [u, v]: [f32; 2]) -> ([f32; 2], f32) {
        let (y, pdf_y, row) = self.marginal.sample(v);
        let (x, pdf_x, _) = self.rows[row].sample(u);
        ([x, y], pdf_x * pdf_y)
    }

    /// Density at `point`.
    #[inline]
    pub fn pdf(&self, [x, y]: [f32; 2]) -> f32 {
        let row = self.marginal.cell(y);
        self.marginal.pdf(y) * self.rows[row].pdf(x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_land_in_proportion_and_know_their_density() {
        let values = [1.0, 0.0, 3.0, 4.0, 8.0, 0.0];
        let density = PiecewiseConstant2d::new(&values, 3);
        let mut counts = [0.0; 6];
        let n = 512;
        for i in 0..n * n {
            let u = [((i % n) as f32 + 0.5) / n as f32, ((i / n) as f32 + 0.5) / n as f32];
            let (p, pdf) = density.sample(u);
            let cell = (p[1] * 2.0) as usize * 3 + (p[0] * 3.0) as usize;
            counts[cell] += 1.0 / (n * n) as f64;
            assert!((f64::from(pdf) - values[cell] / 16.0 * 6.0).abs() < 1e-3);
            assert_eq!(pdf, density.pdf(p));
        }
        for (count, value) in counts.iter().zip(values) {
            assert!((count - value / 16.0).abs() < 0.01);
        }
        assert!((density.integral() - 16.0 / 6.0).abs() < 1e-12);
    }

    #[test]
    fn all_zero_is_uniform() {
        let density = PiecewiseConstant1d::new([0.0; 4].into_iter());
        assert_eq!(density.sample(0.3), (0.3, 1.0, 1));
    }
}
