//! Leaves in AVX2: nine vertices as eight and one, the edges of eight triangles at once, their distances four at a time.

use super::{Distances, Inside};
use crate::accel::bvh::block::{Block, SIZE};
use crate::accel::bvh::slot::Slot;
use crate::accel::bvh::woop::{LARGEST, SMALLEST, Shear};
#[allow(clippy::wildcard_imports, reason = "the names say where they are from")]
use std::arch::x86_64::*;

/// A number for each of nine vertices: of eight, and of the last in all lanes.
type Nine = [__m256; 2];

/// See [`super::Kernel::inside`]. Without fused operations: the same bits as in every other kernel.
#[target_feature(enable = "avx2")]
#[inline]
pub(super) fn inside(shear: &Shear, block: &Block) -> Inside {
    // Vertices relative to the origin, sheared, and the sums of their sizes.
    let relative = |axis: usize| {
        let origin = _mm256_set1_ps(shear.origin[axis]);
        nine(block, shear.axes[axis] as usize).map(|places| _mm256_sub_ps(places, origin))
    };
    let depth = relative(2);
    let flat = |axis: usize| -> Nine {
        let (places, slope) = (relative(axis), _mm256_set1_ps(shear.shear[axis]));
        [0, 1].map(|part| _mm256_sub_ps(places[part], _mm256_mul_ps(slope, depth[part])))
    };
    let (x, y) = (flat(0), flat(1));
    let size = |x| _mm256_andnot_ps(_mm256_set1_ps(-0.0), x);
    let sizes = [0, 1].map(|part| _mm256_add_ps(size(x[part]), size(y[part])));
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
    let is_front = _mm256_cmp_ps::<_CMP_NLT_UQ>(lowest, zero);
    let is_back = _mm256_cmp_ps::<_CMP_NGT_UQ>(highest, zero);
    // The sign of a triangle's numbers says that it is absent.
    let present = !_mm256_movemask_ps(_mm256_castsi256_ps(numbers));
    let inside = (_mm256_movemask_ps(_mm256_or_ps(is_front, is_back)) & present) as u32;
    // Certain are edges larger than their error, and none that may have left the range of `f32`.
    let corners = _mm256_add_ps(_mm256_add_ps(a, b), c);
    let error = _mm256_mul_ps(corners, _mm256_set1_ps(shear.error));
    let error = _mm256_max_ps(error, _mm256_set1_ps(SMALLEST));
    let certain = _mm256_or_ps(
        _mm256_cmp_ps::<_CMP_GT_OQ>(lowest, error),
        _mm256_cmp_ps::<_CMP_LT_OQ>(highest, _mm256_xor_ps(error, _mm256_set1_ps(-0.0))),
    );
    let sum = size(_mm256_add_ps(_mm256_add_ps(u, v), w));
    let small = _mm256_cmp_ps::<_CMP_LT_OQ>(sum, _mm256_set1_ps(LARGEST));
    let sure = _mm256_movemask_ps(_mm256_and_ps(certain, small)) as u32;
    Inside { inside, unsure: inside & !sure }
}

/// See [`super::Kernel::distances`]: the operations of `plain`, in its order and without fused ones, so the same bits.
#[target_feature(enable = "avx2")]
#[inline]
pub(super) fn distances(slot: &Slot, block: &Block) -> Distances {
    let mut all = Distances { t: [0.0; SIZE], within: 0 };
    let places = [0, 1, 2].map(|axis| nine(block, axis));
    let numbers = numbers(block);
    let numbers = [numbers, _mm256_srli_epi32::<4>(numbers), _mm256_srli_epi32::<8>(numbers)];
    let corners = numbers.map(|numbers| [0, 1, 2].map(|axis| pick(places[axis], numbers)));
    for half in 0..2 {
        let all_lanes = |value: f32| _mm256_cvtps_pd(_mm_set1_ps(value));
        let corner = |vertex: usize, axis: usize| {
            let all = corners[vertex][axis];
            _mm256_cvtps_pd(match half {
                0 => _mm256_castps256_ps128(all),
                _ => _mm256_extractf128_ps::<1>(all),
            })
        };
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
        unsafe { _mm_storeu_ps(all.t.as_mut_ptr().wrapping_add(4 * half), t) };
        all.within |= (_mm_movemask_ps(within) as u32) << (4 * half);
    }
    all
}

/// The corners' numbers of the triangles, a lane each.
#[target_feature(enable = "avx2")]
#[inline]
pub(super) fn numbers(block: &Block) -> __m256i {
    // SAFETY: reads the eight values.
    _mm256_cvtepi16_epi32(unsafe { _mm_loadu_si128(block.corners.as_ptr().cast()) })
}

#[target_feature(enable = "avx2")]
#[inline]
fn nine(block: &Block, axis: usize) -> Nine {
    let (eight, last) = block.nine(axis);
    // SAFETY: reads the eight values.
    [unsafe { _mm256_loadu_ps(eight.as_ptr()) }, _mm256_set1_ps(last)]
}

/// The values of these vertices, by the lowest four bits of each number.
#[target_feature(enable = "avx2")]
#[inline]
fn pick([eight, last]: Nine, numbers: __m256i) -> __m256 {
    let is_last = _mm256_castsi256_ps(_mm256_slli_epi32::<28>(numbers));
    _mm256_blendv_ps(_mm256_permutevar8x32_ps(eight, numbers), last, is_last)
}
