//! A density on [0, 1) as its quantiles: inverted by one lookup, without search or branch.
//!
//! Between neighbouring quantiles the density is constant, so cells are narrow where the density is high. A
//! search per cell of position ([`crate::sampling::PiecewiseConstant1d`]) takes 40 to 90 ns a camera ray, and
//! cannot be vectorised: every camera ray inverts two tables.

/// Equal shares of probability.
pub(super) const SHARES: usize = 2048;

/// Positions in [0, 1]: share i of the probability of `values`, a density over equal cells of [0, 1), is
/// between positions i and i + 1. Uniform where the values sum to zero.
pub(super) fn quantiles(values: &[f64]) -> [f32; SHARES + 1] {
    let cells = values.len() as f64;
    let total: f64 = values.iter().sum();
    let probability = |v: f64| if total > 0.0 { v / total } else { 1.0 / cells };
    let mut quantiles = [1.0; SHARES + 1];
    let mut next = 0;
    // Walk along the cumulative distribution; it is linear in each cell.
    let mut start = 0.0;
    for (cell, &value) in values.iter().enumerate() {
        let end = start + probability(value);
        while next < SHARES && next as f64 / SHARES as f64 <= end && end > start {
            let within = (next as f64 / SHARES as f64 - start) / (end - start);
            quantiles[next] = ((cell as f64 + within) / cells) as f32;
            next += 1;
        }
        start = end;
    }
    quantiles
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::PiecewiseConstant1d;

    /// Against bisection, for densities with gaps, peaks and nothing at all.
    #[test]
    fn agree_with_bisection() {
        let peak = |i: usize| if i == 700 { 1e6 } else { 1e-3 };
        let gaps = |i: usize| if (i / 100).is_multiple_of(2) { i as f64 } else { 0.0 };
        for values in [vec![0.0; 64], (0..1000).map(peak).collect(), (0..1024).map(gaps).collect()]
        {
            let quantiles = quantiles(&values);
            let bisection = PiecewiseConstant1d::new(values.iter().copied());
            // Off the shares themselves, where a gap has two answers.
            for (i, pair) in quantiles.windows(2).enumerate() {
                let (low, high) = [0.001, 0.999]
                    .map(|part| bisection.sample((i as f32 + part) / SHARES as f32).0)
                    .into();
                assert!(
                    pair[0] <= low + 1e-5 && high <= pair[1] + 1e-5,
                    "{i}: {pair:?} {low} {high}"
                );
            }
        }
    }
}
