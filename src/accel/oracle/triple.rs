//! Triple products of a ray and a triangle: in `f64` with a bound of the error, and exactly.
//!
//! With a, b, c the corners relative to the ray's origin and d its direction, all that is asked of a ray and a
//! triangle are signs and ratios of \[d,b,c\], \[d,c,a\], \[d,a,b\] (on which side of an edge the ray passes) and
//! \[a,b,c\] (six times a volume): the line meets the plane at t = \[a,b,c\] / (\[d,b,c\] + \[d,c,a\] + \[d,a,b\]), and
//! the three terms of that sum are the barycentric weights. Knows nothing of what a sign means.

use super::dyadic::Dyadic;
use crate::geometry::Ray;
use crate::math::DVec3;
use std::cmp::Ordering;

/// A number known up to an error.
#[derive(Clone, Copy, Debug)]
pub(super) struct Approximate {
    pub(super) value: f64,
    /// The truth is at most this far away.
    pub(super) error: f64,
}

impl Approximate {
    /// The sign of the truth, if it is certain.
    pub(super) fn sign(self) -> Option<Ordering> {
        if self.value > self.error {
            Some(Ordering::Greater)
        } else if self.value < -self.error {
            Some(Ordering::Less)
        } else {
            // Without an error every product below has a factor that is exactly 0.
            (self.error == 0.0).then_some(Ordering::Equal)
        }
    }
}

/// 16 units of round-off of `f64`.
pub(super) const ERROR: f64 = 8.0 * f64::EPSILON;

/// p . (q x r), where each coordinate carries at most one rounding (of a difference of two exact numbers).
///
/// Each of the six products p_i q_j r_k passes through at most eight roundings: of its three factors, the product in
/// the cross product, its difference, the product of the dot product, and its two sums. So the result is off by
/// at most (1 + u)^8 - 1 < 9 u of the sum of their absolute values, u = 2^-53, and so is that sum as computed
/// here: 16 u of it is a bound of the error. Nothing is rounded by underflow or lost by overflow: coordinates are
/// multiples of 2^-298 below 2^260 (f32 times f32 plus f32 has these bounds), so products of three are
/// multiples of 2^-894 below 2^780.
pub(super) fn triple(p: DVec3, q: DVec3, r: DVec3) -> Approximate {
    let (p_size, q_size, r_size) = (p.abs(), q.abs(), r.abs());
    let size = p_size.x * (q_size.y * r_size.z + q_size.z * r_size.y)
        + p_size.y * (q_size.z * r_size.x + q_size.x * r_size.z)
        + p_size.z * (q_size.x * r_size.y + q_size.y * r_size.x);
    Approximate { value: p.dot(q.cross(r)), error: size * ERROR }
}

/// A vector of exact numbers.
pub(super) type Exact3 = [Dyadic; 3];

/// A ray and a triangle, exactly.
pub(super) struct Exact {
    pub(super) direction: Exact3,
    /// Corners relative to the origin.
    pub(super) corners: [Exact3; 3],
}

impl Exact {
    pub(super) fn new(ray: &Ray, vertices: &[DVec3; 3]) -> Self {
        let exact = |v: DVec3| v.to_array().map(Dyadic::new);
        let origin = exact(ray.origin.as_dvec3());
        let relative = |v: &DVec3| minus(&exact(*v), &origin);
        let [a, b, c] = vertices;
        let corners = [relative(a), relative(b), relative(c)];
        Self { direction: exact(ray.direction.as_dvec3()), corners }
    }

    /// \[d,b,c\], \[d,c,a\], \[d,a,b\].
    pub(super) fn sides(&self) -> [Dyadic; 3] {
        let [a, b, c] = &self.corners;
        [(b, c), (c, a), (a, b)].map(|(p, q)| dot(&self.direction, &cross(p, q)))
    }

    /// Numerator and denominator of the parameter at which the line meets the plane; the denominator is
    /// positive unless the plane is parallel or there is none.
    pub(super) fn parameter(&self) -> [Dyadic; 2] {
        let [a, b, c] = &self.corners;
        let [u, v, w] = self.sides();
        let (numerator, denominator) = (dot(a, &cross(b, c)), &(&u + &v) + &w);
        if denominator.sign().is_lt() {
            [-numerator, -denominator]
        } else {
            [numerator, denominator]
        }
    }

    /// Whether the corners lie on one line.
    pub(super) fn is_flat(&self) -> bool {
        let [a, b, c] = &self.corners;
        cross(&minus(b, a), &minus(c, a)).iter().all(|x| x.sign().is_eq())
    }

    /// Corners projected along the ray, which then is at (0, 0), up to a factor: along the last of `axes`, which
    /// are in cyclic order.
    pub(super) fn project(&self, axes: [usize; 3]) -> [[Dyadic; 2]; 3] {
        let ([x, y, z], d) = (axes, &self.direction);
        let [a, b, c] = &self.corners;
        [a, b, c].map(|p| [x, y].map(|k| &(&p[k] * &d[z]) - &(&p[z] * &d[k])))
    }
}

fn minus(p: &Exact3, q: &Exact3) -> Exact3 {
    [0, 1, 2].map(|k| &p[k] - &q[k])
}

fn dot(p: &Exact3, q: &Exact3) -> Dyadic {
    &(&(&p[0] * &q[0]) + &(&p[1] * &q[1])) + &(&p[2] * &q[2])
}

fn cross(p: &Exact3, q: &Exact3) -> Exact3 {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &(&p[i] * &q[j]) - &(&p[j] * &q[i]))
}
