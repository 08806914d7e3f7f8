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
        Self::from_values(nodes, values)
    }

    /// From the values themselves, the first coordinate varying fastest.
    pub(super) fn from_values(nodes: [usize; D], values: Vec<[f32; N]>) -> Self {
        debug_assert_eq!(values.len(), nodes.iter().product::<usize>());
        Self { nodes, values }
    }

    /// The interpolated values at `x`; coordinates outside [0, 1] are clamped.
    #[inline]
    pub(super) fn get(&self, x: [f32; D]) -> [f32; N] {
        // The cell's corners: corner bit d is the upper end of coordinate d.
        let mut offsets = [0; CORNERS];
        let mut fractions = [0.0; D];
        let mut stride = 1;
        for d in 0..D {
            let cells = self.nodes[d] - 1;
            let position = x[d].clamp(0.0, 1.0) * cells as f32;
            let cell = (position as usize).min(cells - 1);
            fractions[d] = position - cell as f32;
            for corner in 0..1 << d {
                offsets[corner] += cell * stride;
                offsets[corner + (1 << d)] = offsets[corner] + stride;
            }
            stride *= self.nodes[d];
        }
        let mut corners = [[0.0; N]; CORNERS];
        for corner in 0..1 << D {
            corners[corner] = self.values[offsets[corner]];
        }
        // Interpolate one coordinate after the other.
        for d in (0..D).rev() {
            for corner in 0..1 << d {
                let (low, high) = (corners[corner], corners[corner + (1 << d)]);
                for n in 0..N {
                    corners[corner][n] = low[n] + fractions[d] * (high[n] - low[n]);
                }
            }
        }
        corners[0]
    }
}

/// Corners of a cell of the largest dimension in use, 4.
const CORNERS: usize = 16;

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
