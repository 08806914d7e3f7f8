//! Integrals of smooth functions of one variable, by Gauss-Legendre panels.
//!
//! Source: P. Davis and P. Rabinowitz, Methods of Numerical Integration, 1984, chapter 2: the nodes are
//! roots of Legendre's polynomial, found by Newton's method.

use super::sum::sum;
use crate::math::fun::double::cos;
use std::f64::consts::PI;

/// Nodes of a panel. The rule is exact for polynomials of twice this degree, less one.
const NODES: usize = 16;

/// The integral of f over [0, 1] in panels of equal width. To 1e-15 of max |f| where f turns by less than
/// about pi in a panel.
pub(super) fn integral(panels: usize, f: impl Fn(f64) -> f64) -> f64 {
    let rule = rule();
    let width = 1.0 / panels as f64;
    let panel = |i: usize| sum(rule.iter().map(|(x, weight)| weight * f((i as f64 + x) * width)));
    width * sum((0..panels).map(panel))
}

/// Nodes in [0, 1] and weights, which add to 1.
fn rule() -> [(f64, f64); NODES] {
    std::array::from_fn(|i| {
        // Close to root i from above; Newton's method doubles the digits each time.
        let mut x = cos(PI * (i as f64 + 0.75) / (NODES as f64 + 0.5));
        let mut slope = 0.0;
        for _ in 0..6 {
            let (value, derivative) = legendre(x);
            slope = derivative;
            x -= value / derivative;
        }
        (0.5 + 0.5 * x, 1.0 / ((1.0 - x * x) * slope * slope))
    })
}

/// Legendre's polynomial of degree [`NODES`] at x, and its derivative, by the three-term recurrence.
fn legendre(x: f64) -> (f64, f64) {
    let (mut before, mut value) = (1.0, x);
    for k in 2..=NODES {
        let k = k as f64;
        (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
    }
    (value, NODES as f64 * (before - x * value) / (1.0 - x * x))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_and_waves() {
        let monomial =
            |degree: usize| move |x: f64| (0..degree).fold(1.0, |product, _| product * x);
        for degree in 0..2 * NODES {
            let exact = 1.0 / (degree as f64 + 1.0);
            assert!((integral(1, monomial(degree)) - exact).abs() < 1e-15, "{degree}");
        }
        // One degree more is too much, or the test would see nothing.
        let beyond = integral(1, monomial(4 * NODES)) - 1.0 / (4.0 * NODES as f64 + 1.0);
        assert!(beyond.abs() > 1e-14, "{beyond}");
        for k in 1..40_u32 {
            let wave = |x: f64| cos(PI * f64::from(k) * x) + 1.0;
            assert!((integral(k as usize, wave) - 1.0).abs() < 1e-14, "{k}");
        }
    }
}
