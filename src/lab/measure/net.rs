//! The quality t of a set as a (t, m, 2)-net in base 2.
//!
//! Source: H. Niederreiter, Random Number Generation and Quasi-Monte Carlo Methods, SIAM 1992, chapter 4. An
//! elementary interval is [a/2^i, (a+1)/2^i) x [b/2^j, (b+1)/2^j). Knows nothing of who made the points.

/// The smallest t such that every elementary interval of area 2^(t-m) holds exactly 2^t of the n = 2^m
/// points, values in [0, 1): 0 is best, m is true of every set. `None` when n is no power of two. O(n m^2).
pub fn t_value(points: &[[f64; 2]]) -> Option<u32> {
    if !points.len().is_power_of_two() {
        return None;
    }
    let m = points.len().ilog2();
    let mut counts = vec![0; points.len()];
    (0..=m).find(|t| {
        // i + j = m - t: 2^(m-t) boxes, each 2^i across and 2^j up.
        let boxes = m - t;
        (0..=boxes).all(|i| is_balanced(points, i, boxes - i, &mut counts[..1 << boxes]))
    })
}

/// Whether all 2^i x 2^j boxes hold as many points as there are `counts` (one a box) to share them. Products
/// with powers of two are exact, so a point on a line between boxes is in the upper one.
fn is_balanced(points: &[[f64; 2]], i: u32, j: u32, counts: &mut [usize]) -> bool {
    let each = points.len() / counts.len();
    counts.fill(0);
    points.iter().all(|[x, y]| {
        let cell =
            |v: f64, bits: u32| ((v * f64::from(1_u32 << bits)) as usize).min((1 << bits) - 1);
        let count = &mut counts[(cell(*y, j) << i) + cell(*x, i)];
        *count += 1;
        *count <= each
    })
}

#[cfg(test)]
mod tests {
    use super::super::tests::{hammersley, random_set};
    use super::*;

    /// From the definition, without a thought for time.
    fn brute_force(points: &[[f64; 2]]) -> u32 {
        let m = points.len().ilog2();
        let holds = |t: u32, i: u32, a: u32, b: u32| {
            let (columns, rows) = (f64::from(1 << i), f64::from(1 << (m - t - i)));
            let (a, b) = (f64::from(a), f64::from(b));
            let inside = points.iter().filter(|[x, y]| {
                (a / columns..(a + 1.0) / columns).contains(x)
                    && (b / rows..(b + 1.0) / rows).contains(y)
            });
            inside.count() == 1 << t
        };
        let is_net = |t: u32| {
            (0..=m - t)
                .all(|i| (0..1 << i).all(|a| (0..1 << (m - t - i)).all(|b| holds(t, i, a, b))))
        };
        (0..=m).find(|t| is_net(*t)).unwrap()
    }

    #[test]
    fn hammersley_sets_are_perfect() {
        for m in 0..12 {
            assert_eq!(t_value(&hammersley(m)), Some(0));
        }
    }

    /// A grid of 2^h x 2^h has 2^h points in each column: t = h, for columns of width 2^-h are the narrowest
    /// that all hold the same number.
    #[test]
    fn a_grid_is_as_bad_as_its_columns() {
        for h in 0..6_u32 {
            let side = 1 << h;
            let at = |i: u32| (f64::from(i) + 0.5) / f64::from(side);
            let grid: Vec<_> = (0..side * side).map(|i| [at(i / side), at(i % side)]).collect();
            assert_eq!(t_value(&grid), Some(h));
        }
    }

    #[test]
    fn against_the_definition() {
        let mut seen = [0; 8];
        for seed in 0..60 {
            let mut points = hammersley(6);
            // From a net to noise: replace some of its points.
            let replaced = (seed as usize) % 16;
            points[..replaced].copy_from_slice(&random_set(replaced, seed));
            let t = t_value(&points).unwrap();
            assert_eq!(t, brute_force(&points));
            seen[t as usize] += 1;
        }
        assert!(seen[0] > 0 && seen.iter().filter(|n| **n > 0).count() >= 3, "{seen:?}");
    }

    /// t up to 5 takes eight columns of 32 points each: probability 3e-8 (multinomial), 6e-7 over all seeds.
    #[test]
    fn random_points_are_no_net() {
        for seed in 0..20 {
            assert!(t_value(&random_set(256, seed)).unwrap() > 5);
        }
        assert_eq!(t_value(&random_set(255, 0)), None);
        assert_eq!(t_value(&[]), None);
        assert_eq!(t_value(&[[0.9, 0.1]]), Some(0));
    }
}
