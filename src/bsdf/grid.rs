//! Tables of N functions on the D-dimensional unit cube, read by multilinear interpolation.

/// Values at a regular grid of nodes; the first coordinate varies fastest.
#[derive(Clone, Debug)]
pub(super) struct Grid<const D: usize, const N: usize> {
    nodes: [usize; D],
    values: Vec<[f32; N]>,
}

impl<const D: usize, const N: usize> Grid<D, N> {
    /// Tabulates `f` at `nodes[i]` >= 2 equidistant values in [0, 1] of each coordinate i.
    pub(super) fn new(nodes: [usize; D], f: impl Fn([f32; D]) -> [f32; N]) -> Self {
        let values = (0..nodes.iter().product())
            .map(|index: usize| {
                let mut rest = index;
                f(nodes.map(|n| {
                    let i = rest % n;
                    rest /= n;
                    i as f32 / (n - 1) as f32
                }))
            })
            .collect();
        Self { nodes, values }
    }

    /// The interpolated values at `x`; coordinates outside [0, 1] are clamped.
    #[inline]
    pub(super) fn get(&self, x: [f32; D]) -> [f32; N] {
        // The cell, and the position in it.
        let (mut base, mut stride) = (0, 1);
        let mut strides = [0; D];
        let mut fractions = [0.0; D];
        for d in 0..D {
            let cells = self.nodes[d] - 1;
            let position = x[d].clamp(0.0, 1.0) * cells as f32;
            let cell = (position as usize).min(cells - 1);
            fractions[d] = position - cell as f32;
            strides[d] = stride;
            base += cell * stride;
            stride *= self.nodes[d];
        }
        // The weighted sum over its 2^D corners.
        let mut sum = [0.0; N];
        for corner in 0..1_usize << D {
            let (mut index, mut weight) = (base, 1.0);
            for d in 0..D {
                if corner >> d & 1 == 1 {
                    index += strides[d];
                    weight *= fractions[d];
                } else {
                    weight *= 1.0 - fractions[d];
                }
            }
            for (sum, value) in sum.iter_mut().zip(self.values[index]) {
                *sum += weight * value;
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn multilinear_functions_are_exact() {
        let f = |[x, y, z]: [f32; 3]| [1.0 + 2.0 * x - y + 3.0 * x * y * z, z];
        let grid = Grid::new([3, 2, 5], f);
        for i in 0..1000 {
            let x = [i % 10, i / 10 % 10, i / 100].map(|k| k as f32 / 9.0);
            let (interpolated, exact) = (grid.get(x), f(x));
            assert!(
                (interpolated[0] - exact[0]).abs() < 1e-6
                    && (interpolated[1] - exact[1]).abs() < 1e-6
            );
        }
        assert_eq!(grid.get([-1.0, 2.0, 0.0]), f([0.0, 1.0, 0.0]));
    }
}
