//! Choosing an index in proportion to a weight, in constant time.
//!
//! Source: M. Vose, "A Linear Algorithm for Generating Random Numbers with a Given Distribution",
//! IEEE Trans. Software Eng. 17(9), 1991.

/// Alias table over finite non-negative weights.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AliasTable {
    /// (threshold within the bin, where the rest of the bin leads).
    bins: Vec<(f32, u32)>,
    pmf: Vec<f32>,
}

impl AliasTable {
    /// A table of `weights`; empty when they do not have a positive finite sum.
    pub fn new(weights: &[f64]) -> Self {
        let n = weights.len();
        let total: f64 = weights.iter().sum();
        if n == 0 || total <= 0.0 || !total.is_finite() {
            return Self::default();
        }
        // Vose: bins below the mean are filled up by bins above it.
        let mut scaled: Vec<f64> = weights.iter().map(|w| w / total * n as f64).collect();
        let (mut small, mut large): (Vec<usize>, Vec<usize>) =
            (0..n).partition(|&i| scaled[i] < 1.0);
        let mut bins: Vec<(f32, u32)> = (0..n as u32).map(|i| (1.0, i)).collect();
        while let (Some(&less), Some(&more)) = (small.last(), large.last()) {
            small.pop();
            bins[less] = (scaled[less] as f32, more as u32);
            scaled[more] -= 1.0 - scaled[less];
            if scaled[more] < 1.0 {
                large.pop();
                small.push(more);
            }
        }
        // What is left differs from 1 by rounding only; a weight of zero is never chosen.
        for i in small.into_iter().chain(large) {
            if weights[i] > 0.0 {
                bins[i] = (1.0, i as u32);
            }
        }
        Self { bins, pmf: weights.iter().map(|w| (w / total) as f32).collect() }
    }

    /// Whether there is nothing to choose from.
    pub fn is_empty(&self) -> bool {
        self.bins.is_empty()
    }

    /// Number of weights.
    pub fn len(&self) -> usize {
        self.bins.len()
    }

    /// An index chosen by `u` in [0, 1), and its probability. The table must not be empty.
    #[inline]
    pub fn sample(&self, u: f32) -> (usize, f32) {
        // In f64: an f32 product could not tell neighbours apart among many thousands of bins.
        let position = f64::from(u) * self.bins.len() as f64;
        let bin = (position as usize).min(self.bins.len() - 1);
        let (threshold, alias) = self.bins[bin];
        let index =
            if position - bin as f64 >= f64::from(threshold) { alias as usize } else { bin };
        (index, self.pmf[index])
    }

    /// Probability of index `i`.
    #[inline]
    pub fn pmf(&self, i: usize) -> f32 {
        self.pmf[i]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frequencies_equal_the_weights() {
        let weights = [0.0, 1.0, 5.0, 0.25, 0.0, 3.75];
        let table = AliasTable::new(&weights);
        let n = 1_000_000;
        let mut counts = [0_u32; 6];
        for i in 0..n {
            let (index, pmf) = table.sample((i as f32 + 0.5) / n as f32);
            assert_eq!(pmf, table.pmf(index));
            counts[index] += 1;
        }
        for (count, weight) in counts.iter().zip(weights) {
            assert!((f64::from(*count) / f64::from(n) - weight / 10.0).abs() < 1e-5);
        }
    }

    #[test]
    fn nothing_to_choose_from() {
        for weights in [&[][..], &[0.0, 0.0], &[f64::INFINITY]] {
            assert!(AliasTable::new(weights).is_empty());
        }
    }
}
