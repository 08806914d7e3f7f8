//! An affine map in `f32` with its inverse, rounded once from `f64`.
//!
//! What a user writes is composed in `f64` ([`glam::DAffine3`]); this is what the inner loops use.

use super::{DAffine3, DVec3, Vec3};

/// `x' = linear x + translation`, stored as four columns (12 floats, column-major), as Embree reads it.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Affine {
    /// Images of the three axes, then the translation.
    pub columns: [[f32; 3]; 4],
}

impl Affine {
    /// The identity.
    pub const IDENTITY: Self =
        Self { columns: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]] };

    /// Rounds each component of a `f64` map.
    pub fn from_f64(map: &DAffine3) -> Self {
        let column = |v: DVec3| v.as_vec3().to_array();
        Self {
            columns: [
                column(map.matrix3.x_axis),
                column(map.matrix3.y_axis),
                column(map.matrix3.z_axis),
                column(map.translation),
            ],
        }
    }

    /// The same map in `f64`, exactly.
    pub fn to_f64(&self) -> DAffine3 {
        let column = |i: usize| Vec3::from_array(self.columns[i]).as_dvec3();
        DAffine3::from_cols(column(0), column(1), column(2), column(3))
    }

    /// The point `p` mapped with every operation in `f64`, in a fixed order; not rounded to `f32`.
    #[inline]
    pub fn transform_point_f64(&self, p: Vec3) -> DVec3 {
        let [x, y, z, w] = self.columns.map(|c| DVec3::new(c[0].into(), c[1].into(), c[2].into()));
        x * f64::from(p.x) + y * f64::from(p.y) + z * f64::from(p.z) + w
    }

    /// The vector `v` mapped by the linear part.
    #[inline]
    pub fn transform_vector(&self, v: Vec3) -> Vec3 {
        let [x, y, z, _] = self.columns.map(Vec3::from_array);
        x * v.x + y * v.y + z * v.z
    }

    /// The normal (covector) `n` mapped by the transposed inverse of the linear part, up to a positive
    /// factor when the map keeps handedness and a negative one when it mirrors; not normalised.
    #[inline]
    pub fn transform_normal(&self, n: Vec3) -> Vec3 {
        let [x, y, z, _] = self.columns.map(Vec3::from_array);
        y.cross(z) * n.x + z.cross(x) * n.y + x.cross(y) * n.z
    }
}
