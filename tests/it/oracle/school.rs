//! A second oracle, of whole numbers and school geometry: slow, and with nothing in common with the first.

use glint::accel::oracle::Place;
use glint::geometry::{Geometry, NONE, PrimitiveId, Ray};
use glint::math::DVec3;
use num_bigint::BigInt;
use num_rational::BigRational;
use std::cmp::Ordering;

type Vector = [BigInt; 3];

/// A number as a multiple of 2^-320, which all coordinates are: `f32`, and sums of products of two of them.
fn whole(x: f64) -> BigInt {
    let bits = x.abs().to_bits();
    let (exponent, fraction) = ((bits >> 52) as i32, bits & ((1 << 52) - 1));
    if bits == 0 {
        return BigInt::ZERO;
    }
    assert!(exponent > 0, "subnormal");
    let mantissa = fraction | 1 << 52;
    // x is the mantissa times 2^(exponent - 1075).
    let shift = exponent - 1075 + 320;
    let lost = (-shift).max(0);
    assert!(mantissa.trailing_zeros() as i32 >= lost, "{x} is not a multiple");
    let size = BigInt::from(mantissa >> lost) << shift.max(0);
    if x < 0.0 { -size } else { size }
}

fn vector(v: DVec3) -> Vector {
    v.to_array().map(whole)
}

fn minus(p: &Vector, q: &Vector) -> Vector {
    [0, 1, 2].map(|k| &p[k] - &q[k])
}

fn dot(p: &Vector, q: &Vector) -> BigInt {
    &p[0] * &q[0] + &p[1] * &q[1] + &p[2] * &q[2]
}

fn cross(p: &Vector, q: &Vector) -> Vector {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &p[i] * &q[j] - &p[j] * &q[i])
}

fn is_zero(p: &Vector) -> bool {
    p.iter().all(|x| *x == BigInt::ZERO)
}

/// A parameter along a ray: numerator and positive denominator.
#[derive(Clone, Debug)]
pub(super) struct Parameter(BigInt, BigInt);

impl Parameter {
    /// Its order with a finite number.
    pub(super) fn cmp_f64(&self, t: f64) -> Ordering {
        let t = BigRational::from_float(t).expect("finite");
        (&self.0 * t.denom()).cmp(&(t.numer() * &self.1))
    }

    fn cmp(&self, other: &Self) -> Ordering {
        (&self.0 * &other.1).cmp(&(&other.0 * &self.1))
    }
}

/// Where the line meets the triangle, and at which parameter if there is one.
pub(super) fn meet(ray: &Ray, triangle: &[DVec3; 3]) -> Option<(Place, Option<Parameter>)> {
    let (o, d) = (vector(ray.origin.as_dvec3()), vector(ray.direction.as_dvec3()));
    let [a, b, c] = triangle.map(vector);
    let normal = cross(&minus(&b, &a), &minus(&c, &a));
    let slope = dot(&normal, &d);
    if slope == BigInt::ZERO {
        // A line along the plane meets a triangle where it meets its rim.
        let rim = [(&a, &b), (&b, &c), (&c, &a)].into_iter().any(|(p, q)| on_segment(&o, &d, p, q));
        let place = if is_zero(&normal) { Place::Flat } else { Place::EdgeOn };
        return rim.then_some((place, None));
    }
    // With a positive denominator.
    let distance = dot(&normal, &minus(&a, &o));
    let (slope, distance) =
        if slope < BigInt::ZERO { (-slope, -distance) } else { (slope, distance) };
    // The point in the plane times the slope, and then its areas with the edges, seen along an axis.
    let point: Vector = std::array::from_fn(|k| &o[k] * &slope + &distance * &d[k]);
    let axis = (0..3).find(|&k| normal[k] != BigInt::ZERO).expect("it has area");
    let sign = |p: &Vector, q: &Vector| {
        let from_p: Vector = std::array::from_fn(|k| &point[k] - &p[k] * &slope);
        (&cross(&minus(q, p), &from_p)[axis] * &normal[axis]).cmp(&BigInt::ZERO)
    };
    let signs = [sign(&a, &b), sign(&b, &c), sign(&c, &a)];
    let place = match signs.iter().filter(|sign| sign.is_eq()).count() {
        _ if signs.contains(&Ordering::Less) => return None,
        0 => Place::Inside,
        1 => Place::Edge,
        _ => Place::Vertex,
    };
    Some((place, Some(Parameter(distance, slope))))
}

/// Whether the line o + t d meets the closed segment from p to q.
fn on_segment(o: &Vector, d: &Vector, p: &Vector, q: &Vector) -> bool {
    // (p - o) x d + s (q - p) x d = 0
    let (from, along) = (cross(&minus(p, o), d), cross(&minus(q, p), d));
    let Some(k) = (0..3).find(|&k| along[k] != BigInt::ZERO) else { return is_zero(&from) };
    let rest: Vector = std::array::from_fn(|i| &from[i] * &along[k] - &from[k] * &along[i]);
    // s = -from / along is between 0 and 1.
    let s = -&from[k] * &along[k];
    is_zero(&rest) && s >= BigInt::ZERO && s <= &along[k] * &along[k]
}

/// The triangles met first within the interval of the ray, with their parameter, and all that are grazed anywhere
/// along the line.
pub(super) struct Truth {
    pub(super) nearest: Vec<(PrimitiveId, Place)>,
    pub(super) t: Option<Parameter>,
    pub(super) grazed: Vec<PrimitiveId>,
}

/// Every triangle, one after the other.
pub(super) fn closest(geometry: &Geometry, ray: &Ray) -> Truth {
    let mut truth = Truth { nearest: Vec::new(), t: None, grazed: Vec::new() };
    for id in ids(geometry) {
        match meet(ray, &geometry.world_vertices(id).0) {
            Some((place, Some(t))) => {
                let is_before_end =
                    ray.t_max == f32::INFINITY || t.cmp_f64(ray.t_max.into()).is_lt();
                if t.cmp_f64(ray.t_min.into()).is_le() || !is_before_end {
                    continue;
                }
                let order = truth.t.as_ref().map_or(Ordering::Less, |first| t.cmp(first));
                if order.is_lt() {
                    truth.nearest.clear();
                    truth.t = Some(t);
                }
                if order.is_le() {
                    truth.nearest.push((id, place));
                }
            }
            Some((_, None)) => truth.grazed.push(id),
            None => {}
        }
    }
    truth
}

/// Every triangle of the world.
pub(super) fn ids(geometry: &Geometry) -> Vec<PrimitiveId> {
    let mut ids = Vec::new();
    for (instance, placed) in (0..).zip(&geometry.instances) {
        for (mesh, number) in geometry.objects[placed.object as usize].meshes.iter().zip(0..) {
            let id = |primitive| PrimitiveId { instance, geometry: number, primitive };
            ids.extend((0..mesh.triangles.len() as u32).map(id));
        }
    }
    for (mesh, number) in geometry.meshes.iter().zip(0..) {
        let id = |primitive| PrimitiveId { instance: NONE, geometry: number, primitive };
        ids.extend((0..mesh.triangles.len() as u32).map(id));
    }
    ids
}
