//! Leaves in AVX: the edges of eight triangles at once, their distances four at a time.

use super::{Distances, Inside};
use crate::accel::bvh::block::{Block, SIZE};
use crate::accel::bvh::slot::Slot;
use crate::accel::bvh::woop::{LARGEST, SMALLEST, Shear};
#[allow(clippy::wildcard_imports, reason = "the names say where they are from")]
use std::arch::x86_64::*;

/// See [`super::Kernel::inside`]. Without fused operations: the same bits as in every other kernel.
#[target_feature(enable = "avx")]
#[inline]
pub(super) fn inside(shear: &Shear, block: &Block) -> Inside {
    let [ox, oy, oz] = shear.origin.map(|o| _mm256_set1_ps(o));
    let [sx, sy] = shear.shear.map(|s| _mm256_set1_ps(s));
    // Corners relative to the origin, sheared.
    macro_rules! project {
        ($corner:literal) => {{
            let along = |axis| load8(along(shear, &block.corners[$corner], axis));
            let depth = _mm256_sub_ps(along(2), oz);
            let (x, y) = (_mm256_sub_ps(along(0), ox), _mm256_sub_ps(along(1), oy));
            (_mm256_sub_ps(x, _mm256_mul_ps(sx, depth)), _mm256_sub_ps(y, _mm256_mul_ps(sy, depth)))
        }};
    }
    let (ax, ay) = project!(0);
    let (bx, by) = project!(1);
    let (cx, cy) = project!(2);
    let edge = |px, py, qx, qy| _mm256_sub_ps(_mm256_mul_ps(px, qy), _mm256_mul_ps(py, qx));
    let (u, v, w) = (edge(cx, cy, bx, by), edge(ax, ay, cx, cy), edge(bx, by, ax, ay));
    // The signs of all three; what is not a number has none, and is not trusted either.
    let zero = _mm256_setzero_ps();
    let is_below = |x| _mm256_cmp_ps::<_CMP_LT_OQ>(x, zero);
    let is_above = |x| _mm256_cmp_ps::<_CMP_GT_OQ>(x, zero);
    let below = _mm256_or_ps(_mm256_or_ps(is_below(u), is_below(v)), is_below(w));
    let above = _mm256_or_ps(_mm256_or_ps(is_above(u), is_above(v)), is_above(w));
    // The sign of a number of a triangle says that it is absent.
    let absent = load8(bytemuck::must_cast_ref(&block.triangles));
    let outside = _mm256_or_ps(_mm256_and_ps(below, above), absent);
    let inside = !_mm256_movemask_ps(outside) as u32 & 0xff;
    // Certain are edges larger than their error, and none that may have left the range of `f32`.
    let size = |x| _mm256_andnot_ps(_mm256_set1_ps(-0.0), x);
    let sum = |a, b| _mm256_add_ps(a, b);
    let a = sum(size(ax), size(ay));
    let corners = sum(sum(a, sum(size(bx), size(by))), sum(size(cx), size(cy)));
    let error = _mm256_max_ps(
        _mm256_mul_ps(corners, _mm256_set1_ps(shear.error)),
        _mm256_set1_ps(SMALLEST),
    );
    let least = _mm256_min_ps(_mm256_min_ps(size(u), size(v)), size(w));
    let all = sum(sum(size(u), size(v)), size(w));
    let sure = _mm256_and_ps(
        _mm256_cmp_ps::<_CMP_GT_OQ>(least, error),
        _mm256_cmp_ps::<_CMP_LT_OQ>(all, _mm256_set1_ps(LARGEST)),
    );
    Inside { inside, unsure: inside & !(_mm256_movemask_ps(sure) as u32) }
}

/// The corners along axis `i` of the shear.
#[inline(always)]
fn along<'a>(shear: &Shear, corner: &'a [[f32; SIZE]; 3], i: usize) -> &'a [f32; SIZE] {
    let axis = shear.axes[i];
    debug_assert!(axis < 3);
    // SAFETY: axes are 0, 1, 2 in some order: `Shear::new` makes no others, and without one they are zero.
    unsafe { corner.get_unchecked(axis as usize) }
}

/// See [`super::Kernel::distances`]: the operations of `plain`, in its order and without fused ones, so the same bits.
#[target_feature(enable = "avx")]
#[inline]
pub(super) fn distances(slot: &Slot, block: &Block) -> Distances {
    let mut all = Distances { t: [0.0; SIZE], within: 0 };
    for half in 0..2 {
        let first = 4 * half;
        let all_lanes = |value: f32| _mm256_cvtps_pd(_mm_set1_ps(value));
        let corner = |vertex: usize, axis: usize| to_f64(&block.corners[vertex][axis], first);
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
        let [dx, dy, dz, _] = slot.direction;
        let minus_det = dot(all_lanes(dx), all_lanes(dy), all_lanes(dz));
        let [ox, oy, oz, _] = slot.origin;
        let height =
            dot(sub(all_lanes(ox), a[0]), sub(all_lanes(oy), a[1]), sub(all_lanes(oz), a[2]));
        // 1 / -x is -(1 / x), to the bit.
        let t = _mm256_cvtpd_ps(mul(height, _mm256_div_pd(_mm256_set1_pd(-1.0), minus_det)));
        let beyond = _mm_cmpgt_ps(t, _mm_set1_ps(slot.t_min));
        let within = _mm_and_ps(beyond, _mm_cmple_ps(t, _mm_set1_ps(slot.limit)));
        // SAFETY: writes four of the eight values.
        unsafe { _mm_storeu_ps(all.t.as_mut_ptr().wrapping_add(first), t) };
        all.within |= (_mm_movemask_ps(within) as u32) << first;
    }
    all
}

#[target_feature(enable = "avx")]
#[inline]
fn load8(values: &[f32; SIZE]) -> __m256 {
    // SAFETY: reads the eight values.
    unsafe { _mm256_loadu_ps(values.as_ptr()) }
}

#[target_feature(enable = "avx")]
#[inline]
fn to_f64(values: &[f32; SIZE], first: usize) -> __m256d {
    assert!(first + 4 <= SIZE);
    // SAFETY: reads four of the values, which are there.
    _mm256_cvtps_pd(unsafe { _mm_loadu_ps(values.as_ptr().wrapping_add(first)) })
}
