//! Where a ray's line meets a triangle, decided exactly: in `f64` where its error bound allows, in whole
//! numbers elsewhere.

use super::dyadic::Dyadic;
use super::triple::{Approximate, ERROR, Exact, triple};
use crate::geometry::Ray;
use crate::math::DVec3;
use std::cell::LazyCell;
use std::cmp::Ordering;

/// Where on a closed triangle a line passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Through its interior.
    Inside,
    /// Through an edge, between its ends.
    Edge,
    /// Through a corner.
    Vertex,
    /// Along its plane: seen edge-on, it has no one distance. A backend may report it or not.
    EdgeOn,
    /// It has no area: its corners lie on one line. A backend may report it or not.
    Flat,
}

impl Place {
    /// Whether it is there at one distance for everyone to see.
    pub fn is_proper(self) -> bool {
        matches!(self, Self::Inside | Self::Edge | Self::Vertex)
    }
}

/// A line that meets a closed triangle.
#[derive(Clone, Debug)]
pub(super) struct Crossing {
    ray: Ray,
    vertices: [DVec3; 3],
    pub(super) place: Place,
    /// Bounds of the parameter, at most 2^-35 of it apart, at a proper place; elsewhere of those of the corners.
    pub(super) t: [f64; 2],
}

impl Crossing {
    /// `None` if the line passes by. `vertices` are finite, and so is `ray`, whose direction is not 0.
    pub(super) fn new(ray: &Ray, vertices: &[DVec3; 3]) -> Option<Self> {
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let [a, b, c] = vertices.map(|v| v - origin);
        let sides = [triple(direction, b, c), triple(direction, c, a), triple(direction, a, b)];
        let is = |sign| sides.iter().any(|side| side.sign() == Some(sign));
        if is(Ordering::Greater) && is(Ordering::Less) {
            return None;
        }
        let exact = LazyCell::new(|| Exact::new(ray, vertices));
        let signs = match sides.map(Approximate::sign) {
            [Some(u), Some(v), Some(w)] => [u, v, w],
            _ => exact.sides().map(|side| side.sign()),
        };
        if signs.contains(&Ordering::Greater) && signs.contains(&Ordering::Less) {
            return None;
        }
        let on_edges = signs.iter().filter(|sign| sign.is_eq()).count();
        let place = match on_edges {
            0 => Place::Inside,
            1 => Place::Edge,
            2 => Place::Vertex,
            _ if !meets_on_line(&exact, direction) => return None,
            _ if exact.is_flat() => Place::Flat,
            _ => Place::EdgeOn,
        };
        let t = if place.is_proper() {
            approximate_parameter(&sides, triple(a, b, c)).unwrap_or_else(|| {
                let [numerator, denominator] = exact.parameter();
                numerator.ratio_bounds(&denominator)
            })
        } else {
            depths([a, b, c], direction)
        };
        Some(Self { ray: *ray, vertices: *vertices, place, t })
    }

    /// The order along the ray. Both are of the same ray, at proper places.
    pub(super) fn compare(&self, other: &Self) -> Ordering {
        self.compare_if_clear(other.t).unwrap_or_else(|| {
            let [n, d] = self.exact_parameter();
            let [other_n, other_d] = other.exact_parameter();
            (&(&n * &other_d) - &(&other_n * &d)).sign()
        })
    }

    /// Before, at or behind the parameter `t`, which may be infinite. At a proper place.
    pub(super) fn compare_to(&self, t: f32) -> Ordering {
        let t = f64::from(t);
        self.compare_if_clear([t; 2]).unwrap_or_else(|| {
            let [n, d] = self.exact_parameter();
            (&n - &(&Dyadic::new(t) * &d)).sign()
        })
    }

    /// Whether it is strictly within the ray's interval; for places without one distance, whether it can be.
    pub(super) fn is_within(&self) -> bool {
        let Ray { t_min, t_max, .. } = self.ray;
        if self.place.is_proper() {
            self.compare_to(t_min).is_gt() && self.compare_to(t_max).is_lt()
        } else {
            self.t[1] >= f64::from(t_min) && self.t[0] <= f64::from(t_max)
        }
    }

    fn compare_if_clear(&self, other: [f64; 2]) -> Option<Ordering> {
        let ([low, high], [other_low, other_high]) = (self.t, other);
        match () {
            () if high < other_low || other_low == f64::INFINITY => Some(Ordering::Less),
            () if other_high < low => Some(Ordering::Greater),
            () => None,
        }
    }

    fn exact_parameter(&self) -> [Dyadic; 2] {
        Exact::new(&self.ray, &self.vertices).parameter()
    }
}

/// Bounds of numerator / sum of `sides`, if `f64` gives good ones.
fn approximate_parameter(sides: &[Approximate; 3], numerator: Approximate) -> Option<[f64; 2]> {
    let [u, v, w] = sides;
    let denominator = (u.value + v.value + w.value).abs();
    // Those of the three, and two roundings of their sum.
    let error =
        u.error + v.error + w.error + (u.value.abs() + v.value.abs() + w.value.abs()) * ERROR;
    let t = numerator.value / (u.value + v.value + w.value);
    // n / d - n' / d' = (n - n') / d - (n' / d') (d - d') / d, and |d| is at least |d'| less its error. Doubled
    // for what is rounded here.
    let off = 2.0 * (numerator.error + t.abs() * error) / (denominator - error);
    // False for NaN, which 0 / 0 gives. Where it is true little was lost to cancellation, so that t is about as large
    // as a distance by a direction, 2^-426 to 2^407: no under- or overflow.
    let is_good = denominator > 2.0 * error && off <= t.abs() * GOOD;
    is_good.then_some([t - off, t + off])
}

/// Relative error up to which bounds of a parameter are good enough: 1/4096 of a unit in the last place of `f32`.
const GOOD: f64 = 1.0 / (1_u64 << 36) as f64;

/// Whether the line meets the segment that is all one sees of a triangle whose three sides are 0: projected along
/// the line its corners are on one line with (0, 0), and between two of them it is where no coordinate
/// has one sign in all corners.
fn meets_on_line(exact: &Exact, direction: DVec3) -> bool {
    let z = (0..3).find(|&k| direction[k] != 0.0).unwrap_or(0);
    let corners = exact.project([(z + 1) % 3, (z + 2) % 3, z]);
    (0..2).all(|k| {
        let signs = corners.each_ref().map(|corner| corner[k].sign());
        !signs.iter().all(|sign| sign.is_gt()) && !signs.iter().all(|sign| sign.is_lt())
    })
}

/// Bounds of the parameters of those points of the triangle that are on the line: between those of the feet of its
/// corners on the line.
fn depths(corners: [DVec3; 3], direction: DVec3) -> [f64; 2] {
    let depths = corners.map(|p| p.dot(direction) / direction.length_squared());
    // Less than 24 units of round-off of the largest coordinate, counted as in `triple`; doubled and more.
    let size = corners.iter().fold(0.0, |m: f64, p| m.max(p.abs().max_element()));
    let off = 4.0 * ERROR * size / direction.abs().max_element();
    let range = |low: f64, high: f64, x: f64| [low.min(x - off), high.max(x + off)];
    depths
        .into_iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| range(low, high, x))
}
