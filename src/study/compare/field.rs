//! A number at every pixel, and blurs of it.

use rayon::prelude::*;

/// Numbers of the pixels of a picture, row-major, top row first.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    size: [usize; 2],
    values: Vec<f64>,
}

impl Field {
    /// `values` are as many as `size` has pixels, at least one.
    pub(super) fn new([width, height]: [u32; 2], values: Vec<f64>) -> Self {
        let size = [width as usize, height as usize];
        debug_assert_eq!(values.len(), size[0] * size[1]);
        Self { size, values }
    }

    /// The numbers.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Their mean.
    pub fn mean(&self) -> f64 {
        self.values.iter().sum::<f64>() / self.values.len().max(1) as f64
    }

    /// The same of every number.
    pub(super) fn map(&self, f: impl Fn(f64) -> f64 + Sync) -> Self {
        Self { size: self.size, values: self.values.par_iter().map(|v| f(*v)).collect() }
    }

    /// Of the numbers of two fields of one size.
    pub(super) fn zip(&self, other: &Self, f: impl Fn(f64, f64) -> f64 + Sync) -> Self {
        let pairs = self.values.par_iter().zip(&other.values);
        Self { size: self.size, values: pairs.map(|(a, b)| f(*a, *b)).collect() }
    }

    /// Correlates rows with `along_x` and columns with `along_y`, kernels of an odd length whose middle is at
    /// the pixel. Beyond the edges the nearest pixel goes on.
    pub(super) fn filtered(&self, along_x: &[f64], along_y: &[f64]) -> Self {
        let [width, height] = self.size;
        let radius = along_x.len() / 2;
        let mut rows = vec![0.0; self.values.len()];
        let along_rows = rows.par_chunks_mut(width).zip(self.values.par_chunks(width));
        along_rows.for_each(|(sums, row)| {
            let edge = |value| std::iter::repeat_n(value, radius);
            let middle = row.iter().copied();
            let wide: Vec<f64> = edge(row[0]).chain(middle).chain(edge(row[width - 1])).collect();
            for (k, weight) in along_x.iter().enumerate() {
                add(sums, *weight, &wide[k..][..width]);
            }
        });
        let radius = along_y.len() / 2;
        let mut values = vec![0.0; self.values.len()];
        values.par_chunks_mut(width).enumerate().for_each(|(y, sums)| {
            for (k, weight) in along_y.iter().enumerate() {
                let row = (y + k).saturating_sub(radius).min(height - 1);
                add(sums, *weight, &rows[row * width..][..width]);
            }
        });
        Self { size: self.size, values }
    }

    /// The mean of the numbers that are `margin` pixels away from all edges; `None` where there are none.
    pub(super) fn mean_within(&self, margin: usize) -> Option<f64> {
        let [width, height] = self.size;
        let rows = margin..height.saturating_sub(margin);
        let inner: Vec<f64> = rows
            .flat_map(|y| {
                self.values[y * width..][..width].get(margin..width.saturating_sub(margin))
            })
            .flatten()
            .copied()
            .collect();
        (!inner.is_empty()).then(|| inner.iter().sum::<f64>() / inner.len() as f64)
    }
}

/// Adds `weight` times the values to the sums.
fn add(sums: &mut [f64], weight: f64, values: &[f64]) {
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum += weight * value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kernels_are_centred_and_edges_go_on() {
        let field = Field::new([4, 1], vec![1.0, 2.0, 4.0, 8.0]);
        assert_eq!(field.filtered(&[1.0, 0.0, 0.0], &[1.0]).values(), [1.0, 1.0, 2.0, 4.0]);
        assert_eq!(field.filtered(&[0.0, 0.0, 1.0], &[1.0]).values(), [2.0, 4.0, 8.0, 8.0]);
        let field = Field::new([1, 3], vec![1.0, 2.0, 4.0]);
        assert_eq!(field.filtered(&[1.0], &[0.0, 0.0, 1.0]).values(), [2.0, 4.0, 4.0]);
        let wide = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        assert_eq!(field.filtered(&wide, &[1.0]).values(), field.values());
    }

    #[test]
    fn margins_are_left_out() {
        let field = Field::new([3, 3], (0..9).map(f64::from).collect());
        assert_eq!(field.mean_within(1), Some(4.0));
        assert_eq!(field.mean_within(0), Some(4.0));
        assert_eq!(field.mean_within(2), None);
    }
}
