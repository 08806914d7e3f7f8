//! The one routine that computes where a ray meets a triangle, and how far from it the next ray starts.
//!
//! Backends decide only which triangle is hit; this decides t, u and v, in `f64` and in a fixed order
//! of operations, so every backend, ISA and Embree version that agrees on the triangle gives the same
//! bits. Source of the test: Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection",
//! 1997, in the form that yields the normal on the way. Source of the offset: Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013, and pbrt 4th ed.,
//! section 6.8, with the magnitudes that Embree's robust kernel works on.

use super::Ray;
use crate::math::{DVec3, UNIT_ROUNDOFF, Vec3};

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    /// Ray parameter, at least the ray's `t_min`.
    pub t: f32,
    /// Weight of the second vertex, in [0, 1].
    pub u: f32,
    /// Weight of the third vertex, in [0, 1 - u].
    pub v: f32,
    /// The point on the triangle at (u, v).
    pub point: Vec3,
    /// Unit normal of the triangle, on the side its winding faces.
    pub normal: Vec3,
}

/// Where `ray` meets the plane of `vertices`, with the barycentrics clamped to the triangle.
///
/// The inputs are `f32` values (or `f64` images of them under an instance), so differences and products
/// below are exact or carry relative errors near 1e-16: after rounding, t, u and v are the true values but
/// for half a unit in the last place, except for slivers whose height is below 1e-9 of their length.
/// A ray that passes by within a backend's rounding may meet the plane far from a triangle that it sees nearly edge-on: t is
/// then where it passes the triangle's box.
/// A triangle seen edge-on or without area, which only a backend's rounding can find, is hit at its
/// first vertex, and its normal faces the ray if it has none.
#[inline(always)]
pub fn intersect_triangle(ray: &Ray, vertices: &[DVec3; 3]) -> TriangleHit {
    let [a, b, c] = *vertices;
    let direction = ray.direction.as_dvec3();
    let (ab, ac) = (b - a, c - a);
    // Cramer's rule on o + t d = a + u ab + v ac, with the normal as one of the two cross products.
    let area_vector = ab.cross(ac);
    let s = ray.origin.as_dvec3() - a;
    let det = -direction.dot(area_vector);
    let (t, u, v);
    if det != 0.0 && det.is_finite() {
        let inverse = 1.0 / det;
        let q = s.cross(direction);
        t = within_box(s.dot(area_vector) * inverse, ray, vertices) as f32;
        u = ((ac.dot(q) * inverse) as f32).clamp(0.0, 1.0);
        // Not `clamp`, whose check of its bounds would keep loops over this from being vectorised.
        v = ((-ab.dot(q) * inverse) as f32).max(0.0).min(1.0 - u);
    } else {
        t = (-s.dot(direction) / direction.length_squared()) as f32;
        (u, v) = (0.0, 0.0);
    }
    let length = area_vector.length();
    let normal = if length > 0.0 {
        (area_vector * (1.0 / length)).as_vec3()
    } else {
        -ray.direction.normalize()
    };
    let point = (a + ab * f64::from(u) + ac * f64::from(v)).as_vec3();
    TriangleHit { t: t.max(ray.t_min), u, v, point, normal }
}

/// The parameter of [`intersect_triangle`] before it is rounded, which may be before the ray's start; nothing if the triangle is
/// seen edge-on.
pub fn triangle_distance(ray: &Ray, vertices: &[DVec3; 3]) -> Option<f64> {
    let [a, b, c] = *vertices;
    let area_vector = (b - a).cross(c - a);
    let det = -ray.direction.as_dvec3().dot(area_vector);
    let t = (ray.origin.as_dvec3() - a).dot(area_vector) * (1.0 / det);
    (det != 0.0 && det.is_finite()).then(|| within_box(t, ray, vertices))
}

/// `t`, but not outside of where the ray passes the triangle's box, made wider by what rounding can displace
/// a triangle by that a backend finds (16 round-offs, as for offsets below): in there what is truly hit is anyway.
#[inline(always)]
pub fn within_box(t: f64, ray: &Ray, vertices: &[DVec3; 3]) -> f64 {
    let [a, b, c] = vertices.map(|v| v.to_array());
    let (origin, direction) =
        (ray.origin.as_dvec3().to_array(), ray.direction.as_dvec3().to_array());
    // Not `max` and `min`, whose care for what is not a number costs as much again.
    let larger = |x: f64, y: f64| if x > y { x } else { y };
    let smaller = |x: f64, y: f64| if x < y { x } else { y };
    let largest = |v: [f64; 3]| larger(larger(v[0].abs(), v[1].abs()), v[2].abs());
    let size = larger(larger(largest(a), largest(b)), largest(c)) + largest(origin);
    let margin = f64::from(16.0 * UNIT_ROUNDOFF) * size;
    let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
    for axis in 0..3 {
        let inverse = 1.0 / direction[axis];
        let low = smaller(smaller(a[axis], b[axis]), c[axis]) - margin - origin[axis];
        let high = larger(larger(a[axis], b[axis]), c[axis]) + margin - origin[axis];
        let (p, q) = (low * inverse, high * inverse);
        // Planes along the ray are nowhere or everywhere.
        let follows = direction[axis] != 0.0;
        enter = if follows { larger(enter, smaller(p, q)) } else { enter };
        leave = if follows { smaller(leave, larger(p, q)) } else { leave };
    }
    larger(enter, smaller(leave, t))
}

/// How far along the unit geometric normal a ray that leaves `point` on the triangle must start, so
/// that neither backend finds the same triangle again.
///
/// A backend computes the distance to the plane as a dot product of (vertex - origin) with the
/// normal: each of its components carries at most `UNIT_ROUNDOFF` of (|point| + extent) from the
/// rounding of the point itself, and of `extent` from the differences, the cross product and the dot
/// product (three operations deep each). Summed over three components and rounded up to the next
/// power of two: 16 round-offs of |point|, 16 of the extent. `instance_magnitude` adds what a
/// transformation to object space loses ([`super::Geometry::world_vertices`]).
#[inline(always)]
pub fn offset_distance(point: Vec3, vertices: &[DVec3; 3], instance_magnitude: f32) -> f32 {
    let p = point.as_dvec3();
    let extent = vertices.iter().fold(0.0_f64, |m, x| m.max((*x - p).abs().max_element())) as f32;
    16.0 * UNIT_ROUNDOFF * (point.abs().max_element() + extent + instance_magnitude)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLE: [DVec3; 3] = [DVec3::ZERO, DVec3::X, DVec3::Y];

    #[test]
    fn known_intersection() {
        let ray = Ray::new(Vec3::new(0.25, 0.5, 2.0), Vec3::new(0.0, 0.0, -0.5));
        let hit = intersect_triangle(&ray, &TRIANGLE);
        let point = Vec3::new(0.25, 0.5, 0.0);
        assert_eq!(hit, TriangleHit { t: 4.0, u: 0.25, v: 0.5, point, normal: Vec3::Z });
    }

    #[test]
    fn edge_on_is_the_first_vertex() {
        let ray = Ray::new(Vec3::new(-3.0, 0.0, 0.0), Vec3::X);
        let hit = intersect_triangle(&ray, &TRIANGLE);
        assert_eq!((hit.t, hit.point, hit.normal), (3.0, Vec3::ZERO, Vec3::Z));
        let needle = [DVec3::ZERO, DVec3::X, DVec3::X * 2.0];
        assert_eq!(intersect_triangle(&ray, &needle).normal, -Vec3::X);
    }

    #[test]
    fn outside_is_clamped_to_the_triangle() {
        let ray = Ray::new(Vec3::new(0.9, 0.9, 1.0), Vec3::new(0.0, 0.0, -1.0));
        let hit = intersect_triangle(&ray, &TRIANGLE);
        assert!(hit.u + hit.v <= 1.0 && hit.t == 1.0);
    }
}
