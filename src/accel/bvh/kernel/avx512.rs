//! Eight children at once in AVX-512's 256-bit form: boxes, sorting networks in registers, stacks written and pruned by compression.
//!
//! Source of the networks: K. Batcher, "Sorting Networks and their Applications", AFIPS 1968, with each merge's first
//! step against the reversed other half.

use super::{Inside, Kernel, Task};
use crate::accel::bvh::block::Block;
use crate::accel::bvh::node::{Node, WIDTH};
use crate::accel::bvh::slot::Slot;
use crate::accel::bvh::woop::{Shear, TRUSTED};
use bytemuck::Pod;
#[allow(clippy::wildcard_imports, reason = "the names say where they are from")]
use std::arch::x86_64::*;

/// Proof that the machine has the instructions.
#[derive(Clone, Copy)]
pub(in crate::accel::bvh) struct Avx512(());

impl Avx512 {
    /// The kernel, if the machine has it.
    #[inline]
    pub(in crate::accel::bvh) fn detect() -> Option<Self> {
        use std::arch::is_x86_feature_detected as has;
        let vectors = has!("avx512f") && has!("avx512bw") && has!("avx512dq") && has!("avx512vl");
        let scalars = has!("avx2") && has!("fma") && has!("bmi1") && has!("bmi2");
        (vectors && scalars && has!("popcnt")).then_some(Self(()))
    }

    /// Runs a task compiled for these instructions.
    pub(in crate::accel::bvh) fn run<T: Task>(self, task: T) {
        // SAFETY: `self` proves that the machine has the features.
        unsafe { run(self, task) }
    }
}

#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx2,fma,bmi1,bmi2,popcnt")]
fn run<T: Task>(kernel: Avx512, task: T) {
    task.run(kernel);
}

impl Kernel for Avx512 {
    #[inline(always)]
    fn open<const ORDERED: bool>(self, slot: &mut Slot, node: &Node) -> usize {
        // SAFETY: `self` proves that the machine has the features.
        unsafe { open::<ORDERED>(slot, node) }
    }

    #[inline(always)]
    fn prune(self, slot: &mut Slot) -> usize {
        // SAFETY: as above.
        unsafe { prune(slot) }
    }

    #[inline(always)]
    fn inside(self, shear: &Shear, block: &Block) -> Inside {
        // SAFETY: as above.
        unsafe { inside(shear, block) }
    }
}

/// See [`Kernel::open`].
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx2,fma,bmi1,bmi2,popcnt")]
#[inline]
fn open<const ORDERED: bool>(slot: &mut Slot, node: &Node) -> usize {
    let mut entry = _mm256_set1_ps(slot.t_min);
    let mut exit = _mm256_set1_ps(slot.limit);
    for axis in 0..3 {
        let near = slot.boxes.near[axis] as usize & WIDTH;
        let (near, far) =
            (load8(&node.planes[axis], near), load8(&node.planes[axis], near ^ WIDTH));
        let r = _mm256_set1_ps(slot.boxes.reciprocal[axis]);
        let enters = _mm256_fmsub_ps(near, r, _mm256_set1_ps(slot.boxes.near_offset[axis]));
        let leaves = _mm256_fmsub_ps(far, r, _mm256_set1_ps(slot.boxes.far_offset[axis]));
        // Where it is not a number, the second one counts.
        entry = _mm256_max_ps(enters, entry);
        exit = _mm256_min_ps(leaves, exit);
    }
    let met = _mm256_cmp_ps_mask::<_CMP_LE_OQ>(entry, exit);
    let count = met.count_ones() as usize;
    let top = slot.top as usize;
    let children = _mm256_castps_si256(load8(&node.children, 0));
    if !ORDERED {
        store8(&mut slot.references, top, _mm256_maskz_compress_epi32(met, children));
        return top + count;
    }
    // Distances that are not negative sort as integers; the lane takes the place of the last bits.
    let lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    let bits = _mm256_andnot_si256(_mm256_set1_epi32(7), _mm256_castps_si256(entry));
    let keys = _mm256_maskz_compress_epi32(met, _mm256_or_si256(bits, lanes));
    if count <= 4 {
        let keys = sort4(_mm256_castsi256_si128(keys));
        let children = _mm256_permutexvar_epi32(_mm256_castsi128_si256(keys), children);
        store4(&mut slot.references, top, _mm256_castsi256_si128(children));
        let distances = _mm_andnot_si128(_mm_set1_epi32(7), keys);
        store4(&mut slot.entries, top, distances);
    } else {
        let keys = sort8(keys);
        store8(&mut slot.references, top, _mm256_permutexvar_epi32(keys, children));
        let distances = _mm256_andnot_si256(_mm256_set1_epi32(7), keys);
        store8(&mut slot.entries, top, distances);
    }
    top + count
}

/// See [`Kernel::inside`].
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx2,fma,bmi1,bmi2,popcnt")]
#[inline]
fn inside(shear: &Shear, block: &Block) -> Inside {
    let [x, y, z] = shear.axes.map(|axis| axis.min(2) as usize);
    let [ox, oy, oz] = shear.origin.map(|o| _mm_set1_ps(o));
    let [sx, sy] = shear.shear.map(|s| _mm_set1_ps(s));
    // Without fused operations: the same bits as in every other kernel.
    macro_rules! project {
        ($corner:literal) => {{
            let corner = &block.corners[$corner];
            let depth = _mm_sub_ps(load4(&corner[z]), oz);
            let flat_x = _mm_sub_ps(load4(&corner[x]), ox);
            let flat_y = _mm_sub_ps(load4(&corner[y]), oy);
            (_mm_sub_ps(flat_x, _mm_mul_ps(sx, depth)), _mm_sub_ps(flat_y, _mm_mul_ps(sy, depth)))
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
    let negative = _mm_cmp_ps_mask::<_CMP_LT_OQ>(u, zero)
        | _mm_cmp_ps_mask::<_CMP_LT_OQ>(v, zero)
        | _mm_cmp_ps_mask::<_CMP_LT_OQ>(w, zero);
    let positive = _mm_cmp_ps_mask::<_CMP_GT_OQ>(u, zero)
        | _mm_cmp_ps_mask::<_CMP_GT_OQ>(v, zero)
        | _mm_cmp_ps_mask::<_CMP_GT_OQ>(w, zero);
    let inside = u32::from(!(negative & positive) & 15);
    if inside == 0 {
        return Inside { inside: 0, unsure: 0 };
    }
    let size = |e| _mm_andnot_ps(_mm_set1_ps(-0.0), e);
    let sum = _mm_add_ps(_mm_add_ps(size(u), size(v)), size(w));
    let sure = _mm_cmp_ps_mask::<_CMP_GE_OQ>(sum, _mm_set1_ps(TRUSTED[0]))
        & _mm_cmp_ps_mask::<_CMP_LE_OQ>(sum, _mm_set1_ps(TRUSTED[1]));
    Inside { inside, unsure: inside & !u32::from(sure) }
}

/// Largest first.
#[target_feature(enable = "avx512f,avx512vl")]
#[inline]
fn sort4(mut keys: __m128i) -> __m128i {
    macro_rules! exchange {
        ($order:literal, $first:literal) => {
            let others = _mm_shuffle_epi32::<$order>(keys);
            keys = _mm_mask_max_epi32(_mm_min_epi32(keys, others), $first, keys, others);
        };
    }
    exchange!(0b10_11_00_01, 0b0101);
    exchange!(0b00_01_10_11, 0b0011);
    exchange!(0b10_11_00_01, 0b0101);
    keys
}

/// Largest first.
#[target_feature(enable = "avx512f,avx512vl")]
#[inline]
fn sort8(mut keys: __m256i) -> __m256i {
    macro_rules! exchange {
        ($others:expr, $first:literal) => {
            let others = $others;
            keys = _mm256_mask_max_epi32(_mm256_min_epi32(keys, others), $first, keys, others);
        };
    }
    exchange!(_mm256_shuffle_epi32::<0b10_11_00_01>(keys), 0b0101_0101);
    exchange!(_mm256_shuffle_epi32::<0b00_01_10_11>(keys), 0b0011_0011);
    exchange!(_mm256_shuffle_epi32::<0b10_11_00_01>(keys), 0b0101_0101);
    let reversed = _mm256_setr_epi32(7, 6, 5, 4, 3, 2, 1, 0);
    exchange!(_mm256_permutexvar_epi32(reversed, keys), 0b0000_1111);
    exchange!(_mm256_shuffle_epi32::<0b01_00_11_10>(keys), 0b0011_0011);
    exchange!(_mm256_shuffle_epi32::<0b10_11_00_01>(keys), 0b0101_0101);
    keys
}

/// See [`Kernel::prune`].
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx2,fma,bmi1,bmi2,popcnt")]
#[inline]
fn prune(slot: &mut Slot) -> usize {
    let limit = _mm256_set1_ps(slot.limit);
    let top = slot.top as usize;
    let mut kept = 0;
    for i in (0..top).step_by(8) {
        let there = _bzhi_u32(0xff, (top - i).min(8) as u32) as __mmask8;
        let entries = load8(&slot.entries, i);
        let references = load8(&slot.references, i);
        let stays = _mm256_mask_cmp_ps_mask::<_CMP_LE_OQ>(there, entries, limit);
        // Writes at most up to where it has read.
        let entries = _mm256_castps_si256(_mm256_maskz_compress_ps(stays, entries));
        let references = _mm256_castps_si256(_mm256_maskz_compress_ps(stays, references));
        store8(&mut slot.entries, kept, entries);
        store8(&mut slot.references, kept, references);
        kept += stays.count_ones() as usize;
    }
    kept
}

#[target_feature(enable = "avx512f,avx512vl")]
#[inline]
fn load4(values: &[f32; 4]) -> __m128 {
    // SAFETY: reads the four values.
    unsafe { _mm_loadu_ps(values.as_ptr()) }
}

#[target_feature(enable = "avx512f,avx512vl")]
#[inline]
fn load8<T: Pod, const N: usize>(values: &[T; N], first: usize) -> __m256 {
    const { assert!(size_of::<T>() == 4) };
    assert!(first + 8 <= N);
    // SAFETY: reads eight values, which are there.
    unsafe { _mm256_loadu_ps(values.as_ptr().wrapping_add(first).cast()) }
}

#[target_feature(enable = "avx512f,avx512vl")]
#[inline]
fn store8<T: Pod, const N: usize>(values: &mut [T; N], first: usize, vector: __m256i) {
    const { assert!(size_of::<T>() == 4) };
    assert!(first + 8 <= N);
    // SAFETY: writes eight values, which are there.
    unsafe { _mm256_storeu_si256(values.as_mut_ptr().wrapping_add(first).cast(), vector) }
}

#[target_feature(enable = "avx512f,avx512vl")]
#[inline]
fn store4<T: Pod, const N: usize>(values: &mut [T; N], first: usize, vector: __m128i) {
    const { assert!(size_of::<T>() == 4) };
    assert!(first + 4 <= N);
    // SAFETY: writes four values, which are there.
    unsafe { _mm_storeu_si128(values.as_mut_ptr().wrapping_add(first).cast(), vector) }
}
