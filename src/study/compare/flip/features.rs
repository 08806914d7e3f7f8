//! Edges and points of one picture that the other has not.
//!
//! Source: section 4.2 of the paper: derivatives of a Gaussian as wide as what an eye takes for an edge.

use crate::math::fun::double::{exp, pow};
use crate::study::compare::field::Field;

/// Width of an edge in degrees, and the exponent of differences.
const WIDTH: f64 = 0.082;
const EXPONENT: f64 = 0.5;

/// Kernels of a Gaussian and its derivatives.
struct Kernels {
    gaussian: Vec<f64>,
    first: Vec<f64>,
    second: Vec<f64>,
}

/// How much the features of two pictures, relative luminance in [0, 1], differ: 0 to 1.
pub(super) fn differences(a: &Field, b: &Field, pixels_per_degree: f64) -> Field {
    let kernels = Kernels::new(0.5 * WIDTH * pixels_per_degree);
    let lost = |derivative: &[f64]| {
        let strength = |field: &Field| {
            let along_x = field.filtered(derivative, &kernels.gaussian);
            along_x
                .zip(&field.filtered(&kernels.gaussian, derivative), |x, y| (x * x + y * y).sqrt())
        };
        strength(a).zip(&strength(b), |a, b| (a - b).abs())
    };
    let (edges, points) = (lost(&kernels.first), lost(&kernels.second));
    edges.zip(&points, |edge, point| {
        pow(edge.max(point) * std::f64::consts::FRAC_1_SQRT_2, EXPONENT)
    })
}

impl Kernels {
    /// Of a standard deviation in pixels, three of them to each side.
    fn new(deviation: f64) -> Self {
        let radius = (3.0 * deviation).ceil() as i32;
        let sampled = |f: &dyn Fn(f64, f64) -> f64| {
            let places = (-radius..=radius).map(|i| f64::from(i) / deviation);
            places.map(|x| f(x, exp(-0.5 * x * x))).collect::<Vec<f64>>()
        };
        Self {
            gaussian: balanced(sampled(&|_, g| g)),
            first: balanced(sampled(&|x, g| -x * g)),
            second: balanced(sampled(&|x, g| (x * x - 1.0) * g)),
        }
    }
}

/// Scaled so that positive weights sum to 1 and negative ones to -1.
fn balanced(kernel: Vec<f64>) -> Vec<f64> {
    let sum = |sign: f64| kernel.iter().map(|w| (w * sign).max(0.0)).sum::<f64>();
    let (positive, negative) = (sum(1.0), sum(-1.0));
    kernel
        .iter()
        .map(|w| if *w > 0.0 { w / positive } else { w / negative.max(f64::MIN_POSITIVE) })
        .collect()
}
