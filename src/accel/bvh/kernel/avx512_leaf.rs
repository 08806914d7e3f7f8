//! Leaves in AVX-512: all vertices at once, then the edges of eight triangles, then their distances.

use super::avx2_leaf::numbers;
use super::{Distances, Inside};
use crate::accel::bvh::block::{Block, SIZE};
use crate::accel::bvh::slot::Slot;
use crate::accel::bvh::woop::{LARGEST, SMALLEST, Shear};
#[allow(clippy::wildcard_imports, reason = "the names say where they are from")]
use std::arch::x86_64::*;

/// See [`super::Kernel::inside`]. Without fused operations: the same bits as in every other kernel.
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx2,fma,bmi1,bmi2,popcnt")]
#[inline]
pub(super) fn inside(shear: &Shear, block: &Block) -> Inside {
    // Vertices relative to the origin, sheared, and the sums of their sizes.
    let relative = |axis: usize| {
        let places = nine(block, shear.axes[axis] as usize);
        _mm512_sub_ps(places, _mm512_set1_ps(shear.origin[axis]))
    };
    let depth = relative(2);
    let slope = |axis: usize| _mm512_mul_ps(_mm512_set1_ps(shear.shear[axis]), depth);
    let x = _mm512_sub_ps(relative(0), slope(0));
    let y = _mm512_sub_ps(relative(1), slope(1));
    let sizes = _mm512_add_ps(_mm512_abs_ps(x), _mm512_abs_ps(y));
    // From vertices to corners.
    let numbers = numbers(block);
    let corner = |numbers: __m256i| (pick(x, numbers), pick(y, numbers), pick(sizes, numbers));
    let (ax, ay, a) = corner(numbers);
    let (bx, by, b) = corner(_mm256_srli_epi32::<4>(numbers));
    let (cx, cy, c) = corner(_mm256_srli_epi32::<8>(numbers));
    let edge = |px, py, qx, qy| _mm256_sub_ps(_mm256_mul_ps(px, qy), _mm256_mul_ps(py, qx));
    let (u, v, w) = (edge(cx, cy, bx, by), edge(ax, ay, cx, cy), edge(bx, by, ax, ay));
    let lowest = _mm256_min_ps(_mm256_min_ps(u, v), w);
    let highest = _mm256_max_ps(_mm256_max_ps(u, v), w);
    // What is not a number has no sign, and is not trusted either.
    let zero = _mm256_setzero_ps();
    let is_front = _mm256_cmp_ps_mask::<_CMP_NLT_UQ>(lowest, zero);
    let is_back = _mm256_cmp_ps_mask::<_CMP_NGT_UQ>(highest, zero);
    // The sign of a triangle's numbers says that it is absent.
    let inside = (is_front | is_back) & !_mm256_movepi32_mask(numbers);
    // Certain are edges larger than their error, and none that may have left the range of `f32`.
    let corners = _mm256_add_ps(_mm256_add_ps(a, b), c);
    let error = _mm256_mul_ps(corners, _mm256_set1_ps(shear.error));
    let error = _mm256_max_ps(error, _mm256_set1_ps(SMALLEST));
    let certain = _mm256_cmp_ps_mask::<_CMP_GT_OQ>(lowest, error)
        | _mm256_cmp_ps_mask::<_CMP_LT_OQ>(highest, _mm256_xor_ps(error, _mm256_set1_ps(-0.0)));
    let sum = _mm256_andnot_ps(_mm256_set1_ps(-0.0), _mm256_add_ps(_mm256_add_ps(u, v), w));
    let sure = certain & _mm256_cmp_ps_mask::<_CMP_LT_OQ>(sum, _mm256_set1_ps(LARGEST));
    Inside { inside: inside.into(), unsure: (inside & !sure).into() }
}

/// See [`super::Kernel::distances`]: the operations of `plain`, in its order and without fused ones, so the same bits.
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx2,fma,bmi1,bmi2,popcnt")]
#[inline]
pub(super) fn distances(slot: &Slot, block: &Block) -> Distances {
    let all = |value: f32| _mm512_cvtps_pd(_mm256_set1_ps(value));
    let places = [0, 1, 2].map(|axis| nine(block, axis));
    let numbers = numbers(block);
    let corner = |numbers: __m256i| places.map(|places| _mm512_cvtps_pd(pick(places, numbers)));
    let a = corner(numbers);
    let b = corner(_mm256_srli_epi32::<4>(numbers));
    let c = corner(_mm256_srli_epi32::<8>(numbers));
    let sub = |a, b| _mm512_sub_pd(a, b);
    let mul = |a, b| _mm512_mul_pd(a, b);
    let add = |a, b| _mm512_add_pd(a, b);
    let ab = [sub(b[0], a[0]), sub(b[1], a[1]), sub(b[2], a[2])];
    let ac = [sub(c[0], a[0]), sub(c[1], a[1]), sub(c[2], a[2])];
    let normal = [
        sub(mul(ab[1], ac[2]), mul(ac[1], ab[2])),
        sub(mul(ab[2], ac[0]), mul(ac[2], ab[0])),
        sub(mul(ab[0], ac[1]), mul(ac[0], ab[1])),
    ];
    let dot = |x: __m512d, y: __m512d, z: __m512d| {
        add(add(mul(x, normal[0]), mul(y, normal[1])), mul(z, normal[2]))
    };
    let [dx, dy, dz, _] = slot.direction;
    let minus_det = dot(all(dx), all(dy), all(dz));
    let [ox, oy, oz, _] = slot.origin;
    let height = dot(sub(all(ox), a[0]), sub(all(oy), a[1]), sub(all(oz), a[2]));
    // 1 / -x is -(1 / x), to the bit.
    let t = _mm512_cvtpd_ps(mul(height, _mm512_div_pd(_mm512_set1_pd(-1.0), minus_det)));
    let beyond = _mm256_cmp_ps_mask::<_CMP_GT_OQ>(t, _mm256_set1_ps(slot.t_min));
    let within = _mm256_mask_cmp_ps_mask::<_CMP_LE_OQ>(beyond, t, _mm256_set1_ps(slot.limit));
    let mut distances = Distances { t: [0.0; SIZE], within: within.into() };
    // SAFETY: writes eight values where there are eight.
    unsafe { _mm256_storeu_ps(distances.t.as_mut_ptr(), t) };
    distances
}

#[target_feature(enable = "avx512f")]
#[inline]
fn nine(block: &Block, axis: usize) -> __m512 {
    let (eight, last) = block.nine(axis);
    // SAFETY: reads the eight values.
    let eight = _mm512_castps256_ps512(unsafe { _mm256_loadu_ps(eight.as_ptr()) });
    _mm512_mask_mov_ps(eight, 1 << 8, _mm512_set1_ps(last))
}

/// The values of these vertices, by the lowest four bits of each number.
#[target_feature(enable = "avx512f,avx512vl,avx2")]
#[inline]
fn pick(vertices: __m512, numbers: __m256i) -> __m256 {
    let numbers = _mm512_castsi256_si512(numbers);
    _mm512_castps512_ps256(_mm512_permutexvar_ps(numbers, vertices))
}
