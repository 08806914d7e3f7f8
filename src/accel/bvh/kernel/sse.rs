//! Edge functions of four triangles at once, in the instructions that every x86-64 has.

use super::Inside;
use crate::accel::bvh::block::{Block, SIZE};
use crate::accel::bvh::woop::{Shear, TRUSTED};
#[allow(clippy::wildcard_imports, reason = "the names say where they are from")]
use std::arch::x86_64::*;

/// See [`super::Kernel::inside`]. Without fused operations: the same bits as in every other kernel.
#[inline(always)]
pub(super) fn inside(shear: &Shear, block: &Block) -> Inside {
    // SAFETY: SSE2 is part of x86-64.
    unsafe { inside_sse2(shear, block) }
}

#[target_feature(enable = "sse2")]
#[inline]
fn inside_sse2(shear: &Shear, block: &Block) -> Inside {
    let [ox, oy, oz] = shear.origin.map(|o| _mm_set1_ps(o));
    let [sx, sy] = shear.shear.map(|s| _mm_set1_ps(s));
    // Corners relative to the origin, sheared.
    macro_rules! project {
        ($corner:literal) => {{
            let along = |axis| load4(shear.along(&block.corners[$corner], axis));
            let depth = _mm_sub_ps(along(2), oz);
            let (x, y) = (_mm_sub_ps(along(0), ox), _mm_sub_ps(along(1), oy));
            (_mm_sub_ps(x, _mm_mul_ps(sx, depth)), _mm_sub_ps(y, _mm_mul_ps(sy, depth)))
        }};
    }
    let (ax, ay) = project!(0);
    let (bx, by) = project!(1);
    let (cx, cy) = project!(2);
    let u = _mm_sub_ps(_mm_mul_ps(cx, by), _mm_mul_ps(cy, bx));
    let v = _mm_sub_ps(_mm_mul_ps(ax, cy), _mm_mul_ps(ay, cx));
    let w = _mm_sub_ps(_mm_mul_ps(bx, ay), _mm_mul_ps(by, ax));
    // The signs of all three; what is not a number has none, and is not trusted either.
    let zero = _mm_setzero_ps();
    let below = _mm_or_ps(_mm_cmplt_ps(u, zero), _mm_cmplt_ps(v, zero));
    let below = _mm_or_ps(below, _mm_cmplt_ps(w, zero));
    let above = _mm_or_ps(_mm_cmpgt_ps(u, zero), _mm_cmpgt_ps(v, zero));
    let above = _mm_or_ps(above, _mm_cmpgt_ps(w, zero));
    let inside = !_mm_movemask_ps(_mm_and_ps(below, above)) as u32 & 15;
    if inside == 0 {
        return Inside { inside: 0, unsure: 0 };
    }
    let size = |edge| _mm_andnot_ps(_mm_set1_ps(-0.0), edge);
    let sum = _mm_add_ps(_mm_add_ps(size(u), size(v)), size(w));
    let sure = _mm_and_ps(
        _mm_cmpge_ps(sum, _mm_set1_ps(*TRUSTED.start())),
        _mm_cmple_ps(sum, _mm_set1_ps(*TRUSTED.end())),
    );
    Inside { inside, unsure: inside & !(_mm_movemask_ps(sure) as u32) }
}

#[target_feature(enable = "sse2")]
#[inline]
fn load4(values: &[f32; SIZE]) -> __m128 {
    // SAFETY: reads the four values.
    unsafe { _mm_loadu_ps(values.as_ptr()) }
}
