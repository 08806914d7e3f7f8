//! Packets in AVX-512: a ray in each lane, one child or triangle after the other.

use super::Avx512;
use super::avx512::{load4, sort4, sort16, to_f32};
use super::packets::{PacketDistances, PacketKernel, Touched};
use crate::accel::bvh::block::{Block, SIZE, VERTICES};
use crate::accel::bvh::node::{Node, WIDTH};
use crate::accel::bvh::packet::{Each, Packet};
use crate::accel::bvh::slot::Found;
use crate::accel::bvh::woop::{LARGEST, SMALLEST};
#[allow(clippy::wildcard_imports, reason = "the names say where they are from")]
use std::arch::x86_64::*;

impl PacketKernel for Avx512 {
    #[inline(always)]
    fn range(self, values: &Each) -> [f32; 2] {
        // SAFETY: `self` proves that the machine has the features.
        unsafe { range(values) }
    }

    #[inline(always)]
    fn active(self, packet: &Packet, entries: &Each) -> u16 {
        // SAFETY: `self` proves that the machine has the features.
        unsafe { active(packet, entries) }
    }

    #[inline(always)]
    fn open<const ORDERED: bool>(self, packet: &mut Packet, node: &Node, active: u16) -> usize {
        // SAFETY: as above.
        unsafe { open::<ORDERED>(packet, node, active) }
    }

    #[inline(always)]
    fn inside(
        self,
        packet: &Packet,
        block: &Block,
        active: u16,
        touched: &mut [Touched; SIZE],
    ) -> u32 {
        // SAFETY: as above.
        unsafe { inside(packet, block, active, touched) }
    }

    #[inline(always)]
    fn distances(self, packet: &Packet, block: &Block, lane: usize) -> PacketDistances {
        // SAFETY: as above.
        unsafe { distances(packet, block, lane) }
    }

    #[inline(always)]
    fn take<const ANY: bool>(self, packet: &mut Packet, t: &Each, rays: u16, found: Found) {
        // SAFETY: as above.
        unsafe { take::<ANY>(packet, t, rays, found) }
    }
}

/// See [`PacketKernel::range`].
#[target_feature(enable = "avx512f")]
#[inline]
fn range(values: &Each) -> [f32; 2] {
    [_mm512_reduce_min_ps(load(values)), _mm512_reduce_max_ps(load(values))]
}

/// See [`PacketKernel::active`].
#[target_feature(enable = "avx512f")]
#[inline]
fn active(packet: &Packet, entries: &Each) -> u16 {
    _mm512_cmp_ps_mask::<_CMP_LE_OQ>(load(entries), load(&packet.limit))
}

/// See [`PacketKernel::open`].
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx2,fma,bmi1,bmi2,popcnt")]
#[inline]
fn open<const ORDERED: bool>(packet: &mut Packet, node: &Node, active: u16) -> usize {
    let origin = load4(&node.origin);
    let exponents = _mm_cvtepu8_epi32(_mm_castps_si128(_mm_shuffle_ps::<0xff>(origin, origin)));
    let cells = _mm_castsi128_ps(_mm_slli_epi32::<23>(exponents));
    // Which children may any ray meet: those that the hull does.
    let hull = &packet.hull;
    let mut step = [[0.0; 4]; 2];
    let (mut near_base, mut far_base) = ([[0.0; 4]; 2], [[0.0; 4]; 2]);
    for k in 0..2 {
        let r = load4(&hull.reciprocal[k]);
        store4(&mut step[k], _mm_mul_ps(cells, r));
        store4(&mut near_base[k], _mm_fmsub_ps(origin, r, load4(&hull.near_offset[k])));
        store4(&mut far_base[k], _mm_fmsub_ps(origin, r, load4(&hull.far_offset[k])));
    }
    let mut entry = _mm512_set1_ps(hull.t_min);
    let mut exit = _mm512_set1_ps(hull.limit);
    let mut planes = [[[0.0; WIDTH]; 2]; 3];
    for axis in 0..3 {
        let near = packet.near[axis] as usize;
        let nearer = to_f32(&node.planes[axis], near);
        let farther = to_f32(&node.planes[axis], near ^ WIDTH);
        store(&mut planes[axis][0], nearer);
        store(&mut planes[axis][1], farther);
        let at = |planes, k: usize, base: &[[f32; 4]; 2]| {
            let (step, base) = (_mm512_set1_ps(step[k][axis]), _mm512_set1_ps(base[k][axis]));
            _mm512_fmadd_ps(planes, step, base)
        };
        let enters = _mm512_min_ps(at(nearer, 0, &near_base), at(nearer, 1, &near_base));
        let leaves = _mm512_max_ps(at(farther, 0, &far_base), at(farther, 1, &far_base));
        entry = _mm512_max_ps(enters, entry);
        exit = _mm512_min_ps(leaves, exit);
    }
    let met = _mm512_mask_cmp_ps_mask::<_CMP_LE_OQ>(node.present, entry, exit);
    let top = packet.top as usize;
    if met == 0 {
        return top;
    }
    // Farthest first, in order of the hull; distances that are not negative sort as integers.
    let count = met.count_ones() as usize;
    let lanes = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    let mut keys = [0_i32; WIDTH];
    let unsorted = match ORDERED {
        true => {
            let bits = _mm512_andnot_si512(_mm512_set1_epi32(15), _mm512_castps_si512(entry));
            _mm512_maskz_compress_epi32(met, _mm512_or_si512(bits, lanes))
        }
        false => _mm512_maskz_compress_epi32(met, lanes),
    };
    let sorted = match count {
        _ if !ORDERED => unsorted,
        ..=4 => _mm512_castsi128_si512(sort4(_mm512_castsi512_si128(unsorted))),
        _ => sort16(unsorted),
    };
    // SAFETY: writes sixteen values where there are sixteen.
    unsafe { _mm512_storeu_si512(keys.as_mut_ptr().cast(), sorted) };
    // The grid in the parameter of each ray.
    let mut grid = [[_mm512_setzero_ps(); 3]; 3];
    for (axis, [step, near_base, far_base]) in grid.iter_mut().enumerate() {
        let r = load(&packet.reciprocal[axis]);
        let origin = _mm512_set1_ps(node.origin[axis]);
        *step = _mm512_mul_ps(_mm512_set1_ps(node.step(axis)), r);
        *near_base = _mm512_fmsub_ps(origin, r, load(&packet.near_offset[axis]));
        *far_base = _mm512_fmsub_ps(origin, r, load(&packet.far_offset[axis]));
    }
    let (t_min, limit) = (load(&packet.t_min), load(&packet.limit));
    let mut top = top;
    for key in &keys[..count] {
        let child = *key as usize & (WIDTH - 1);
        let (mut entry, mut exit) = (t_min, limit);
        for ([nearer, farther], [step, near_base, far_base]) in planes.iter().zip(&grid) {
            let enters = _mm512_fmadd_ps(_mm512_set1_ps(nearer[child]), *step, *near_base);
            let leaves = _mm512_fmadd_ps(_mm512_set1_ps(farther[child]), *step, *far_base);
            entry = _mm512_max_ps(enters, entry);
            exit = _mm512_min_ps(leaves, exit);
        }
        let meets = _mm512_mask_cmp_ps_mask::<_CMP_LE_OQ>(active, entry, exit);
        let entry = _mm512_mask_mov_ps(_mm512_set1_ps(f32::INFINITY), meets, entry);
        packet.references[top] = node.child(child).0;
        store(&mut packet.entries[top], entry);
        top += usize::from(meets != 0);
    }
    top
}

/// See [`PacketKernel::inside`].
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx2,fma,bmi1,bmi2,popcnt")]
#[inline]
fn inside(packet: &Packet, block: &Block, active: u16, touched: &mut [Touched; SIZE]) -> u32 {
    // Every vertex relative to the origin of every ray, sheared, and the sum of its sizes.
    let axes = packet.axes.map(|axis| axis as usize % 4 % 3);
    let origins = axes.map(|axis| load(&packet.origin[axis]));
    let slopes = [load(&packet.slope[0]), load(&packet.slope[1])];
    let mut flat = [[_mm512_setzero_ps(); 3]; VERTICES];
    for (vertex, flat) in flat.iter_mut().enumerate() {
        let relative =
            |i: usize| _mm512_sub_ps(_mm512_set1_ps(block.along(axes[i], vertex)), origins[i]);
        let depth = relative(2);
        let x = _mm512_sub_ps(relative(0), _mm512_mul_ps(slopes[0], depth));
        let y = _mm512_sub_ps(relative(1), _mm512_mul_ps(slopes[1], depth));
        *flat = [x, y, _mm512_add_ps(_mm512_abs_ps(x), _mm512_abs_ps(y))];
    }
    let edge = |p: &[__m512; 3], q: &[__m512; 3]| {
        _mm512_sub_ps(_mm512_mul_ps(p[0], q[1]), _mm512_mul_ps(p[1], q[0]))
    };
    let zero = _mm512_setzero_ps();
    let mut any = 0;
    for (lane, touched) in touched.iter_mut().enumerate() {
        if !block.has(lane) {
            break;
        }
        // The operations of `plain::inside`, in its order.
        let [a, b, c] = block.numbers(lane).map(|vertex| &flat[vertex.min(VERTICES - 1)]);
        let (u, v, w) = (edge(c, b), edge(a, c), edge(b, a));
        let lowest = _mm512_min_ps(_mm512_min_ps(u, v), w);
        let highest = _mm512_max_ps(_mm512_max_ps(u, v), w);
        let inside = _mm512_mask_cmp_ps_mask::<_CMP_NLT_UQ>(active, lowest, zero)
            | _mm512_mask_cmp_ps_mask::<_CMP_NGT_UQ>(active, highest, zero);
        if inside == 0 {
            continue;
        }
        let corners = _mm512_add_ps(_mm512_add_ps(a[2], b[2]), c[2]);
        let error = _mm512_mul_ps(corners, load(&packet.error));
        let error = _mm512_max_ps(error, _mm512_set1_ps(SMALLEST));
        let certain = _mm512_cmp_ps_mask::<_CMP_GT_OQ>(lowest, error)
            | _mm512_cmp_ps_mask::<_CMP_LT_OQ>(highest, _mm512_sub_ps(_mm512_set1_ps(-0.0), error));
        let sum = _mm512_abs_ps(_mm512_add_ps(_mm512_add_ps(u, v), w));
        let sure = certain & _mm512_cmp_ps_mask::<_CMP_LT_OQ>(sum, _mm512_set1_ps(LARGEST));
        *touched = Touched { inside, unsure: inside & !sure };
        any |= 1 << lane;
    }
    any
}

/// See [`PacketKernel::distances`]: the operations of `plain::distances`, in its order and without fused ones.
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx2,fma,bmi1,bmi2,popcnt")]
#[inline]
fn distances(packet: &Packet, block: &Block, lane: usize) -> PacketDistances {
    let [a, b, c] = block.vertices(lane).map(|p| p.as_dvec3().to_array());
    let ab = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    let ac = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
    let normal = [
        ab[1] * ac[2] - ac[1] * ab[2],
        ab[2] * ac[0] - ac[2] * ab[0],
        ab[0] * ac[1] - ac[0] * ab[1],
    ];
    let normal = normal.map(|x| _mm512_set1_pd(x));
    let a = a.map(|x| _mm512_set1_pd(x));
    let mut t = [0.0; 16];
    for half in 0..2 {
        let along = |of: &[Each; 3], axis: usize| to_f64(&of[axis], 8 * half);
        let dot = |v: [__m512d; 3]| {
            let [x, y, z] = [0, 1, 2].map(|axis| _mm512_mul_pd(v[axis], normal[axis]));
            _mm512_add_pd(_mm512_add_pd(x, y), z)
        };
        let minus_det = dot([0, 1, 2].map(|axis| along(&packet.direction, axis)));
        let from_a = |axis: usize| _mm512_sub_pd(along(&packet.origin, axis), a[axis]);
        let height = dot([from_a(0), from_a(1), from_a(2)]);
        // 1 / -x is -(1 / x), to the bit.
        let inverse = _mm512_div_pd(_mm512_set1_pd(-1.0), minus_det);
        let values = _mm512_cvtpd_ps(_mm512_mul_pd(height, inverse));
        // SAFETY: writes eight of the sixteen values.
        unsafe { _mm256_storeu_ps(t.as_mut_ptr().wrapping_add(8 * half), values) };
    }
    let all = load(&t);
    let beyond = _mm512_cmp_ps_mask::<_CMP_GT_OQ>(all, load(&packet.t_min));
    let limit = load(&packet.limit);
    let nearer = _mm512_mask_cmp_ps_mask::<_CMP_LT_OQ>(beyond, all, limit);
    let level = _mm512_mask_cmp_ps_mask::<_CMP_EQ_OQ>(beyond, all, limit);
    PacketDistances { t, nearer, level }
}

/// See [`PacketKernel::take`].
#[target_feature(enable = "avx512f")]
#[inline]
fn take<const ANY: bool>(packet: &mut Packet, t: &Each, rays: u16, found: Found) {
    let limit = if ANY { _mm512_set1_ps(f32::NEG_INFINITY) } else { load(t) };
    let (leaf, lane) =
        (_mm512_set1_epi32(found.leaf.0 as i32), _mm512_set1_epi32(found.lane as i32));
    // SAFETY: each writes some of sixteen values where there are sixteen.
    unsafe { _mm512_mask_storeu_ps(packet.limit.as_mut_ptr(), rays, limit) };
    // SAFETY: as above.
    unsafe { _mm512_mask_storeu_epi32(packet.leaf.as_mut_ptr().cast(), rays, leaf) };
    // SAFETY: as above.
    unsafe { _mm512_mask_storeu_epi32(packet.lane.as_mut_ptr().cast(), rays, lane) };
}

#[target_feature(enable = "avx512f")]
#[inline]
fn load(values: &Each) -> __m512 {
    // SAFETY: reads the sixteen values.
    unsafe { _mm512_loadu_ps(values.as_ptr()) }
}

#[target_feature(enable = "avx512f")]
#[inline]
fn store(values: &mut Each, vector: __m512) {
    // SAFETY: writes sixteen values where there are sixteen.
    unsafe { _mm512_storeu_ps(values.as_mut_ptr(), vector) }
}

#[target_feature(enable = "avx512f")]
#[inline]
fn to_f64(values: &Each, first: usize) -> __m512d {
    assert!(first + 8 <= values.len());
    // SAFETY: reads eight of the values, which are there.
    _mm512_cvtps_pd(unsafe { _mm256_loadu_ps(values.as_ptr().wrapping_add(first)) })
}

#[target_feature(enable = "sse2")]
#[inline]
fn store4(values: &mut [f32; 4], vector: __m128) {
    // SAFETY: writes four values where there are four.
    unsafe { _mm_storeu_ps(values.as_mut_ptr(), vector) }
}
