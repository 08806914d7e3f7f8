//! A kernel that is as bad as its makers want: the in-house one's way, with errors of a chosen size.

use super::school::ids;
use glint::accel::resolve;
use glint::geometry::{Geometry, PrimitiveId, Ray};
use glint::math::{UNIT_ROUNDOFF, Vec3};

/// Tests every triangle, its corners projected along the ray and then displaced.
pub(super) struct Noisy<'a> {
    pub(super) geometry: &'a Geometry,
    /// By how much on each axis, in ulps of the corner's largest coordinate relative to the origin.
    pub(super) ulps: f64,
    /// Whether all triangles at a corner agree on where it is.
    pub(super) shared: bool,
}

impl Noisy<'_> {
    pub(super) fn closest(&self, ray: &Ray) -> PrimitiveId {
        ids(self.geometry)
            .into_iter()
            .filter(|&id| self.is_inside(ray, id))
            .map(|id| resolve(self.geometry, ray, id))
            .filter(|hit| hit.t > ray.t_min && hit.t < ray.t_max)
            .min_by(|a, b| (a.t, a.id).partial_cmp(&(b.t, b.id)).expect("numbers"))
            .map_or(PrimitiveId::MISS, |hit| hit.id)
    }

    fn is_inside(&self, ray: &Ray, id: PrimitiveId) -> bool {
        let salt = if self.shared { 0 } else { id.primitive + 1 };
        let vertices = self.geometry.mesh(id).vertices(id.primitive);
        let [a, b, c] = vertices.map(|corner| self.project(ray, corner, salt));
        let edge = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
        let edges = [edge(b, c), edge(c, a), edge(a, b)];
        let is_one_sided = edges.iter().all(|&e| e >= 0.0) || edges.iter().all(|&e| e <= 0.0);
        is_one_sided && edges != [0.0; 3]
    }

    fn project(&self, ray: &Ray, corner: Vec3, salt: u32) -> [f64; 2] {
        let (p, d) = (corner.as_dvec3() - ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let z = (0..3).fold(0, |best, k| if d[k].abs() > d[best].abs() { k } else { best });
        let off = self.ulps * f64::from(UNIT_ROUNDOFF) * p.abs().max_element();
        [1, 2].map(|k| {
            let axis = (z + k) % 3;
            // One way or the other, as the bits of the corner and the ray have it.
            let bits = [corner.x, corner.y, corner.z, ray.direction.x].map(f32::to_bits);
            let start = salt.wrapping_mul(0x9e37_79b9) ^ k as u32;
            let mix = |h: u32, x: &u32| (h ^ x).wrapping_mul(0x85eb_ca6b).rotate_left(13);
            let sign = if bits.iter().fold(start, mix).count_ones() % 2 == 0 { 1.0 } else { -1.0 };
            p[axis] - d[axis] / d[z] * p[z] + sign * off
        })
    }
}
