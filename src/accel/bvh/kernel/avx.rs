//! Distances of four triangles at once, in the double-precision vectors that AVX has.

use super::Distances;
use crate::accel::bvh::block::{Block, SIZE};
use crate::accel::bvh::slot::Slot;
#[allow(clippy::wildcard_imports, reason = "the names say where they are from")]
use std::arch::x86_64::*;

/// See [`super::Kernel::distances`]: the operations of `plain`, in its order and without fused ones, so the same bits.
#[target_feature(enable = "avx")]
#[inline]
pub(super) fn distances(slot: &Slot, block: &Block) -> Distances {
    let all = |value: f32| _mm256_cvtps_pd(_mm_set1_ps(value));
    let corner = |vertex: usize, axis: usize| to_f64(&block.corners[vertex][axis]);
    let sub = |a, b| _mm256_sub_pd(a, b);
    let mul = |a, b| _mm256_mul_pd(a, b);
    let add = |a, b| _mm256_add_pd(a, b);
    let a = [corner(0, 0), corner(0, 1), corner(0, 2)];
    let ab = [sub(corner(1, 0), a[0]), sub(corner(1, 1), a[1]), sub(corner(1, 2), a[2])];
    let ac = [sub(corner(2, 0), a[0]), sub(corner(2, 1), a[1]), sub(corner(2, 2), a[2])];
    let normal = [
        sub(mul(ab[1], ac[2]), mul(ac[1], ab[2])),
        sub(mul(ab[2], ac[0]), mul(ac[2], ab[0])),
        sub(mul(ab[0], ac[1]), mul(ac[0], ab[1])),
    ];
    let dot = |x: __m256d, y: __m256d, z: __m256d| {
        add(add(mul(x, normal[0]), mul(y, normal[1])), mul(z, normal[2]))
    };
    let [dx, dy, dz] = slot.direction.to_array();
    let minus_det = dot(all(dx), all(dy), all(dz));
    let [ox, oy, oz] = slot.origin.to_array();
    let height = dot(sub(all(ox), a[0]), sub(all(oy), a[1]), sub(all(oz), a[2]));
    // 1 / -x is -(1 / x), to the bit.
    let distance = mul(height, _mm256_div_pd(_mm256_set1_pd(-1.0), minus_det));
    let distance = _mm256_cvtpd_ps(distance);
    let beyond = _mm_cmpgt_ps(distance, _mm_set1_ps(slot.t_min));
    let within = _mm_and_ps(beyond, _mm_cmple_ps(distance, _mm_set1_ps(slot.limit)));
    let size = _mm256_andnot_pd(_mm256_set1_pd(-0.0), minus_det);
    let regular = _mm256_and_pd(
        _mm256_cmp_pd::<_CMP_GT_OQ>(size, _mm256_setzero_pd()),
        _mm256_cmp_pd::<_CMP_LT_OQ>(size, _mm256_set1_pd(f64::INFINITY)),
    );
    let mut t = [0.0; SIZE];
    // SAFETY: writes four values where there are four.
    unsafe { _mm_storeu_ps(t.as_mut_ptr(), distance) };
    Distances {
        t,
        within: _mm_movemask_ps(within) as u32,
        edge_on: !_mm256_movemask_pd(regular) as u32 & 15,
    }
}

#[target_feature(enable = "avx")]
#[inline]
fn to_f64(values: &[f32; SIZE]) -> __m256d {
    // SAFETY: reads the four values.
    _mm256_cvtps_pd(unsafe { _mm_loadu_ps(values.as_ptr()) })
}
