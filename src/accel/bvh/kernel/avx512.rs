//! Sixteen children at once in AVX-512: boxes, sorting networks in registers, stacks written and pruned by compression.
//!
//! Source of the networks: K. Batcher, "Sorting Networks and their Applications", AFIPS 1968, with each merge's first
//! step against the reversed other half.

use super::{Distances, Inside, Kernel, Task, avx512_leaf};
use crate::accel::bvh::block::Block;
use crate::accel::bvh::node::{Node, WIDTH};
use crate::accel::bvh::slot::Slot;
use crate::accel::bvh::woop::Shear;
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
    type Packets = Self;

    #[inline(always)]
    fn packets(self) -> Option<Self> {
        Some(self)
    }

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
        unsafe { avx512_leaf::inside(shear, block) }
    }

    #[inline(always)]
    fn distances(self, slot: &Slot, block: &Block) -> Distances {
        // SAFETY: as above.
        unsafe { avx512_leaf::distances(slot, block) }
    }
}

/// See [`Kernel::open`].
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx2,fma,bmi1,bmi2,popcnt")]
#[inline]
fn open<const ORDERED: bool>(slot: &mut Slot, node: &Node) -> usize {
    // The node's grid in the ray's parameter, for three axes at once.
    let origin = load4(&node.origin);
    let r = load4(&slot.boxes.reciprocal);
    let exponents = _mm_cvtepu8_epi32(_mm_castps_si128(_mm_shuffle_ps::<0xff>(origin, origin)));
    let step = _mm_mul_ps(_mm_castsi128_ps(_mm_slli_epi32::<23>(exponents)), r);
    let near_base = _mm_fmsub_ps(origin, r, load4(&slot.boxes.near_offset));
    let far_base = _mm_fmsub_ps(origin, r, load4(&slot.boxes.far_offset));
    // By way of the memory, from where one number goes to sixteen lanes at no cost to the vector units.
    let mut grid = Grid { step: [0.0; 4], near_base: [0.0; 4], far_base: [0.0; 4] };
    store4(&mut grid.step, 0, _mm_castps_si128(step));
    store4(&mut grid.near_base, 0, _mm_castps_si128(near_base));
    store4(&mut grid.far_base, 0, _mm_castps_si128(far_base));
    // SAFETY: no instruction at all; that there could be one that reads it keeps the grid in the memory.
    unsafe {
        std::arch::asm!("/* {0} */", in(reg) &raw const grid, options(nostack, preserves_flags))
    };
    let mut entry = _mm512_set1_ps(slot.t_min);
    let mut exit = _mm512_set1_ps(slot.limit);
    for axis in 0..3 {
        let near = slot.boxes.near[axis] as usize;
        let planes = &node.planes[axis];
        let step = _mm512_set1_ps(grid.step[axis]);
        let enters =
            _mm512_fmadd_ps(to_f32(planes, near), step, _mm512_set1_ps(grid.near_base[axis]));
        let leaves = _mm512_fmadd_ps(
            to_f32(planes, near ^ WIDTH),
            step,
            _mm512_set1_ps(grid.far_base[axis]),
        );
        // Where it is not a number, the second one counts.
        entry = _mm512_max_ps(enters, entry);
        exit = _mm512_min_ps(leaves, exit);
    }
    let met = _mm512_mask_cmp_ps_mask::<_CMP_LE_OQ>(node.present, entry, exit);
    let count = met.count_ones() as usize;
    let top = slot.top as usize;
    let lanes = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    let leaves = _mm512_add_epi32(lanes, _mm512_set1_epi32(node.first_leaf as i32));
    let first_inner = _mm512_set1_epi32(node.first_inner as i32);
    let children = _mm512_mask_add_epi32(leaves, node.inner, lanes, first_inner);
    if !ORDERED {
        store16(&mut slot.references, top, _mm512_maskz_compress_epi32(met, children));
        return top + count;
    }
    // Distances that are not negative sort as integers; the lane takes the place of the last bits.
    let bits = _mm512_andnot_si512(_mm512_set1_epi32(15), _mm512_castps_si512(entry));
    let keys = _mm512_maskz_compress_epi32(met, _mm512_or_si512(bits, lanes));
    if count <= 4 {
        let keys = sort4(_mm512_castsi512_si128(keys));
        let children = _mm512_permutexvar_epi32(_mm512_castsi128_si512(keys), children);
        store4(&mut slot.references, top, _mm512_castsi512_si128(children));
        let distances = _mm_andnot_si128(_mm_set1_epi32(15), keys);
        store4(&mut slot.entries, top, distances);
    } else {
        let keys = match count <= 8 {
            true => _mm512_castsi256_si512(sort8(_mm512_castsi512_si256(keys))),
            false => sort16(keys),
        };
        store16(&mut slot.references, top, _mm512_permutexvar_epi32(keys, children));
        let distances = _mm512_andnot_si512(_mm512_set1_epi32(15), keys);
        store16(&mut slot.entries, top, distances);
    }
    top + count
}

/// A node's grid in a ray's parameter: a plane is at base + number * step. The fourth elements mean nothing.
struct Grid {
    step: [f32; 4],
    near_base: [f32; 4],
    far_base: [f32; 4],
}

/// Largest first.
#[target_feature(enable = "avx512f,avx512vl")]
#[inline]
pub(super) fn sort4(mut keys: __m128i) -> __m128i {
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

/// Largest first.
#[target_feature(enable = "avx512f,avx512vl")]
#[inline]
pub(super) fn sort16(mut keys: __m512i) -> __m512i {
    macro_rules! exchange {
        ($others:expr, $first:literal) => {
            let others = $others;
            keys = _mm512_mask_max_epi32(_mm512_min_epi32(keys, others), $first, keys, others);
        };
    }
    exchange!(_mm512_shuffle_epi32::<0b10_11_00_01>(keys), 0x5555);
    exchange!(_mm512_shuffle_epi32::<0b00_01_10_11>(keys), 0x3333);
    exchange!(_mm512_shuffle_epi32::<0b10_11_00_01>(keys), 0x5555);
    let reversed = _mm512_setr_epi32(7, 6, 5, 4, 3, 2, 1, 0, 15, 14, 13, 12, 11, 10, 9, 8);
    exchange!(_mm512_permutexvar_epi32(reversed, keys), 0x0f0f);
    exchange!(_mm512_shuffle_epi32::<0b01_00_11_10>(keys), 0x3333);
    exchange!(_mm512_shuffle_epi32::<0b10_11_00_01>(keys), 0x5555);
    let reversed = _mm512_setr_epi32(15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0);
    exchange!(_mm512_permutexvar_epi32(reversed, keys), 0x00ff);
    exchange!(_mm512_shuffle_i32x4::<0b10_11_00_01>(keys, keys), 0x0f0f);
    exchange!(_mm512_shuffle_epi32::<0b01_00_11_10>(keys), 0x3333);
    exchange!(_mm512_shuffle_epi32::<0b10_11_00_01>(keys), 0x5555);
    keys
}

/// See [`Kernel::prune`].
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx2,fma,bmi1,bmi2,popcnt")]
#[inline]
fn prune(slot: &mut Slot) -> usize {
    let limit = _mm512_set1_ps(slot.limit);
    let top = slot.top as usize;
    let mut kept = 0;
    for i in (0..top).step_by(16) {
        let there = _bzhi_u32(0xffff, (top - i).min(16) as u32) as __mmask16;
        let entries = load16(&slot.entries, i);
        let references = load16(&slot.references, i);
        let distances = _mm512_castsi512_ps(entries);
        let stays = _mm512_mask_cmp_ps_mask::<_CMP_LE_OQ>(there, distances, limit);
        // Writes at most up to where it has read.
        store16(&mut slot.entries, kept, _mm512_maskz_compress_epi32(stays, entries));
        store16(&mut slot.references, kept, _mm512_maskz_compress_epi32(stays, references));
        kept += stays.count_ones() as usize;
    }
    kept
}

#[target_feature(enable = "avx512f,avx512vl")]
#[inline]
pub(super) fn load4(values: &[f32; 4]) -> __m128 {
    // SAFETY: reads the four values.
    unsafe { _mm_loadu_ps(values.as_ptr()) }
}

#[target_feature(enable = "avx512f,avx512vl")]
#[inline]
pub(super) fn to_f32<const N: usize>(bytes: &[u8; N], first: usize) -> __m512 {
    debug_assert!(first + 16 <= N);
    // SAFETY: reads sixteen bytes: `first` is from `BoxRay::near`, 0 or 16, or the other of the two.
    let bytes = unsafe { _mm_loadu_si128(bytes.as_ptr().wrapping_add(first).cast()) };
    _mm512_cvtepi32_ps(_mm512_cvtepu8_epi32(bytes))
}

#[target_feature(enable = "avx512f,avx512vl")]
#[inline]
fn load16<T: Pod, const N: usize>(values: &[T; N], first: usize) -> __m512i {
    const { assert!(size_of::<T>() == 4) };
    assert!(first + 16 <= N);
    // SAFETY: reads sixteen values, which are there.
    unsafe { _mm512_loadu_si512(values.as_ptr().wrapping_add(first).cast()) }
}

#[target_feature(enable = "avx512f,avx512vl")]
#[inline]
fn store16<T: Pod, const N: usize>(values: &mut [T; N], first: usize, vector: __m512i) {
    const { assert!(size_of::<T>() == 4) };
    debug_assert!(first + 16 <= N);
    // SAFETY: writes sixteen values: stacks have room for them, see `Slot::pop`.
    unsafe { _mm512_storeu_si512(values.as_mut_ptr().wrapping_add(first).cast(), vector) }
}

#[target_feature(enable = "avx512f,avx512vl")]
#[inline]
fn store4<T: Pod, const N: usize>(values: &mut [T; N], first: usize, vector: __m128i) {
    const { assert!(size_of::<T>() == 4) };
    debug_assert!(first + 4 <= N);
    // SAFETY: as above.
    unsafe { _mm_storeu_si128(values.as_mut_ptr().wrapping_add(first).cast(), vector) }
}
