//! An orthonormal frame around a normal: world directions to local ones (z up) and back.
//!
//! Source: Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.

use super::Vec3;

/// Right-handed orthonormal frame; `normal` is the local z axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Frame {
    /// Local x axis in world space.
    pub tangent: Vec3,
    /// Local y axis in world space.
    pub bitangent: Vec3,
    /// Local z axis in world space.
    pub normal: Vec3,
}

impl Frame {
    /// A frame with z along the unit vector `normal`; the rotation about it is arbitrary but fixed.
    #[inline(always)]
    pub fn from_normal(normal: Vec3) -> Self {
        let sign = 1.0_f32.copysign(normal.z);
        let a = -1.0 / (sign + normal.z);
        let b = normal.x * normal.y * a;
        Self {
            tangent: Vec3::new(1.0 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x),
            bitangent: Vec3::new(b, sign + normal.y * normal.y * a, -normal.y),
            normal,
        }
    }

    /// A frame with z along the unit vector `normal` and x as close to `tangent` as that allows
    /// (Gram-Schmidt); falls back to [`Frame::from_normal`] where the two are parallel.
    #[inline(always)]
    pub fn from_normal_tangent(normal: Vec3, tangent: Vec3) -> Self {
        let projected = tangent - normal * normal.dot(tangent);
        let length_squared = projected.length_squared();
        // A NaN or a vanishing projection fails the comparison and takes the fallback.
        if length_squared > 1e-6 * tangent.length_squared() {
            // A second projection removes what cancellation left in the first.
            let tangent = projected / length_squared.sqrt();
            let tangent = (tangent - normal * normal.dot(tangent)).normalize();
            Self { tangent, bitangent: normal.cross(tangent), normal }
        } else {
            Self::from_normal(normal)
        }
    }

    /// World components of the local vector `v`.
    #[inline(always)]
    pub fn world_from_local(&self, v: Vec3) -> Vec3 {
        self.tangent * v.x + self.bitangent * v.y + self.normal * v.z
    }

    /// Local components of the world vector `v`.
    #[inline(always)]
    pub fn local_from_world(&self, v: Vec3) -> Vec3 {
        Vec3::new(self.tangent.dot(v), self.bitangent.dot(v), self.normal.dot(v))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::fun;

    #[test]
    fn orthonormal_for_every_direction() {
        for i in 0..10_000 {
            let z = 1.0 - 2.0 * (i as f32 + 0.5) / 10_000.0;
            let (s, c) = fun::sin_cos_turns(i as f32 * 0.618_034);
            let r = (1.0 - z * z).sqrt();
            for frame in [
                Frame::from_normal(Vec3::new(r * c, r * s, z)),
                Frame::from_normal_tangent(Vec3::new(r * c, r * s, z), Vec3::X),
                Frame::from_normal_tangent(Vec3::new(r * c, r * s, z), Vec3::new(r * c, r * s, z)),
            ] {
                let v = Vec3::new(0.3, -0.5, 0.8);
                assert!((frame.local_from_world(frame.world_from_local(v)) - v).length() < 2e-6);
                assert!((frame.tangent.cross(frame.bitangent) - frame.normal).length() < 2e-6);
            }
        }
    }
}
