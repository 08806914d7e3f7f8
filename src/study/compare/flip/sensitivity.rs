//! What an eye cannot resolve from afar is blurred: a filter for lightness, and two wider ones for colours.
//!
//! Source: section 4.1.1 of the paper: contrast sensitivity as sums of Gaussians whose transforms are
//! `a sqrt(pi / b) exp(-pi^2 d^2 / b)`, d in degrees.

use crate::math::fun::double::exp;
use crate::study::compare::field::Field;
use std::f64::consts::PI;

/// Gaussians (a, b) of a channel.
type Sensitivity = &'static [(f64, f64)];

/// Of lightness, red against green, and yellow against blue (table 1).
const CHANNELS: [Sensitivity; 3] =
    [&[(1.0, 0.0047)], &[(1.0, 0.0053)], &[(34.1, 0.04), (13.5, 0.025)]];

/// Opponent colours as they are seen.
pub(super) fn filtered(planes: &[Field; 3], pixels_per_degree: f64) -> [Field; 3] {
    // Three standard deviations of the widest of all.
    let radius = (3.0 * (0.04 / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil() as i32;
    [0, 1, 2].map(|channel| {
        // A sum of Gaussians in the plane: each is a product, so that it is applied along rows and columns.
        let parts = CHANNELS[channel].iter().map(|(a, b)| {
            let degrees = (-radius..=radius).map(|i| f64::from(i) / pixels_per_degree);
            let kernel: Vec<f64> = degrees.map(|d| exp(-PI * PI * d * d / b)).collect();
            let sum: f64 = kernel.iter().sum();
            let unit: Vec<f64> = kernel.iter().map(|weight| weight / sum).collect();
            (a * (PI / b).sqrt() * sum * sum, planes[channel].filtered(&unit, &unit))
        });
        let (mut total, mut seen) = (0.0, planes[channel].map(|_| 0.0));
        for (weight, part) in parts {
            total += weight;
            seen = seen.zip(&part, |seen, part| seen + weight * part);
        }
        seen.map(|value| value / total)
    })
}
