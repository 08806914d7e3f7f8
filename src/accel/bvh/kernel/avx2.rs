//! Sixteen children as twice eight in AVX2, which has no compression: a table of permutations serves.

use super::packets::Never;
use super::{Distances, Inside, Kernel, Task, avx2_leaf, plain};
use crate::accel::bvh::block::Block;
use crate::accel::bvh::node::{Node, WIDTH};
use crate::accel::bvh::slot::{SPARE, Slot};
use crate::accel::bvh::woop::Shear;
#[allow(clippy::wildcard_imports, reason = "the names say where they are from")]
use std::arch::x86_64::*;

/// Proof that the machine has the instructions.
#[derive(Clone, Copy)]
pub(in crate::accel::bvh) struct Avx2(());

impl Avx2 {
    /// The kernel, if the machine has it.
    #[inline]
    pub(in crate::accel::bvh) fn detect() -> Option<Self> {
        use std::arch::is_x86_feature_detected as has;
        let all = has!("avx2") && has!("fma") && has!("bmi1") && has!("bmi2") && has!("popcnt");
        all.then_some(Self(()))
    }

    /// Runs a task compiled for these instructions.
    pub(in crate::accel::bvh) fn run<T: Task>(self, task: T) {
        // SAFETY: `self` proves that the machine has the features.
        unsafe { run(self, task) }
    }
}

#[target_feature(enable = "avx2,fma,bmi1,bmi2,popcnt")]
fn run<T: Task>(kernel: Avx2, task: T) {
    task.run(kernel);
}

impl Kernel for Avx2 {
    type Packets = Never;

    #[inline(always)]
    fn open<const ORDERED: bool>(self, slot: &mut Slot, node: &Node) -> usize {
        // SAFETY: `self` proves that the machine has the features.
        unsafe { open::<ORDERED>(slot, node) }
    }

    #[inline(always)]
    fn prune(self, slot: &mut Slot) -> usize {
        plain::prune(slot)
    }

    #[inline(always)]
    fn inside(self, shear: &Shear, block: &Block) -> Inside {
        // SAFETY: as above.
        unsafe { avx2_leaf::inside(shear, block) }
    }

    #[inline(always)]
    fn distances(self, slot: &Slot, block: &Block) -> Distances {
        // SAFETY: as above.
        unsafe { avx2_leaf::distances(slot, block) }
    }
}

/// `LANES[mask]`: the numbers of the mask's bits, lowest first.
static LANES: [[u8; 8]; 256] = {
    let mut lanes = [[0; 8]; 256];
    let mut mask = 0;
    while mask < 256 {
        let (mut bit, mut count) = (0, 0);
        while bit < 8 {
            if mask >> bit & 1 != 0 {
                lanes[mask][count] = bit;
                count += 1;
            }
            bit += 1;
        }
        mask += 1;
    }
    lanes
};

/// See [`Kernel::open`].
#[target_feature(enable = "avx2,fma,bmi1,bmi2,popcnt")]
#[inline]
fn open<const ORDERED: bool>(slot: &mut Slot, node: &Node) -> usize {
    let mut entry = [_mm256_set1_ps(slot.t_min); 2];
    let mut exit = [_mm256_set1_ps(slot.limit); 2];
    for axis in 0..3 {
        let near = slot.boxes.near[axis] as usize & WIDTH;
        let planes = &node.planes[axis];
        let (origin, r) = (node.origin[axis], slot.boxes.reciprocal[axis]);
        let step = _mm256_set1_ps(node.step(axis) * r);
        let near_base = _mm256_set1_ps(origin * r - slot.boxes.near_offset[axis]);
        let far_base = _mm256_set1_ps(origin * r - slot.boxes.far_offset[axis]);
        for half in 0..2 {
            let enters = _mm256_fmadd_ps(to_f32(planes, near + 8 * half), step, near_base);
            let leaves = _mm256_fmadd_ps(to_f32(planes, (near ^ WIDTH) + 8 * half), step, far_base);
            // Where it is not a number, the second one counts.
            entry[half] = _mm256_max_ps(enters, entry[half]);
            exit[half] = _mm256_min_ps(leaves, exit[half]);
        }
    }
    let lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    let mut top = slot.top as usize;
    let first = top;
    // Distances that are not negative sort as integers; the lane takes the place of the last bits.
    let mut keys = [0_u32; WIDTH + 8];
    for half in 0..2 {
        let met = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(entry[half], exit[half]));
        let met = met as usize & usize::from(node.present) >> (8 * half) & 0xff;
        let lanes = _mm256_add_epi32(lanes, _mm256_set1_epi32(8 * half as i32));
        let order = permutation(met);
        if ORDERED {
            let bits = _mm256_andnot_si256(_mm256_set1_epi32(15), _mm256_castps_si256(entry[half]));
            let packed = _mm256_permutevar8x32_epi32(_mm256_or_si256(bits, lanes), order);
            store8(&mut keys, top - first, packed);
        } else {
            let lanes = _mm256_permutevar8x32_epi32(lanes, order);
            store8(&mut slot.references, top, children(node, lanes));
        }
        top += met.count_ones() as usize;
    }
    if !ORDERED {
        return top;
    }
    let count = top - first;
    if count <= 4 {
        // What is beyond the count must be the last.
        let absent = _mm_cmpgt_epi32(_mm_setr_epi32(1, 2, 3, 4), _mm_set1_epi32(count as i32));
        let four = _mm_andnot_si128(absent, load4(&keys));
        store4(&mut keys, sort4(four));
    } else {
        keys[..count].sort_unstable_by(|a, b| b.cmp(a));
    }
    let references = &mut slot.references[first..first + SPARE];
    let entries = &mut slot.entries[first..first + SPARE];
    for k in 0..count.max(4) {
        let key = keys[k];
        references[k] = node.child(key as usize & (WIDTH - 1)).0;
        entries[k] = f32::from_bits(key & !15);
    }
    top
}

/// References to the children in these lanes.
#[target_feature(enable = "avx2")]
#[inline]
fn children(node: &Node, lanes: __m256i) -> __m256i {
    let at = |first: u32| _mm256_add_epi32(_mm256_set1_epi32(first as i32), lanes);
    // Inner ones come first.
    let inner = _mm256_set1_epi32(node.inner.count_ones() as i32);
    let is_inner = _mm256_cmpgt_epi32(inner, lanes);
    _mm256_blendv_epi8(at(node.first_leaf), at(node.first_inner), is_inner)
}

/// Largest first.
#[target_feature(enable = "sse4.1")]
#[inline]
fn sort4(mut keys: __m128i) -> __m128i {
    macro_rules! exchange {
        ($order:literal, $last:literal) => {
            let others = _mm_shuffle_epi32::<$order>(keys);
            let (low, high) = (_mm_min_epi32(keys, others), _mm_max_epi32(keys, others));
            keys = _mm_blend_epi16::<$last>(high, low);
        };
    }
    exchange!(0b10_11_00_01, 0b1100_1100);
    exchange!(0b00_01_10_11, 0b1111_0000);
    exchange!(0b10_11_00_01, 0b1100_1100);
    keys
}

/// The lanes of a mask of eight, to the front.
#[target_feature(enable = "avx2")]
#[inline]
fn permutation(mask: usize) -> __m256i {
    let lanes = &LANES[mask & 0xff];
    // SAFETY: reads the eight bytes.
    let lanes = unsafe { _mm_loadl_epi64(lanes.as_ptr().cast()) };
    _mm256_cvtepu8_epi32(lanes)
}

#[target_feature(enable = "avx2")]
#[inline]
fn to_f32<const N: usize>(bytes: &[u8; N], first: usize) -> __m256 {
    assert!(first + 8 <= N);
    // SAFETY: reads eight bytes, which are there.
    let bytes = unsafe { _mm_loadl_epi64(bytes.as_ptr().wrapping_add(first).cast()) };
    _mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(bytes))
}

#[target_feature(enable = "avx2")]
#[inline]
fn store8<const N: usize>(values: &mut [u32; N], first: usize, vector: __m256i) {
    assert!(first + 8 <= N);
    // SAFETY: writes eight values, which are there.
    unsafe { _mm256_storeu_si256(values.as_mut_ptr().wrapping_add(first).cast(), vector) }
}

#[target_feature(enable = "avx2")]
#[inline]
fn load4<const N: usize>(values: &[u32; N]) -> __m128i {
    const { assert!(N >= 4) };
    // SAFETY: reads four values, which are there.
    unsafe { _mm_loadu_si128(values.as_ptr().cast()) }
}

#[target_feature(enable = "avx2")]
#[inline]
fn store4<const N: usize>(values: &mut [u32; N], vector: __m128i) {
    const { assert!(N >= 4) };
    // SAFETY: writes four values, which are there.
    unsafe { _mm_storeu_si128(values.as_mut_ptr().cast(), vector) }
}
