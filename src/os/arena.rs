//! Large arrays on huge pages: random access to them misses the address cache far less often.
//!
//! Knows nothing of what is stored. Where the system has no huge pages to give, ordinary ones serve.

use bytemuck::Zeroable;
use std::ops::{Deref, DerefMut};
use std::ptr::NonNull;

/// A huge page of x86-64, and the alignment of the arrays.
const HUGE_PAGE: usize = 2 << 20;

/// A fixed number of elements, all bytes zero at first.
pub struct Arena<T> {
    /// The first element; dangling if there is none.
    first: NonNull<T>,
    len: usize,
    /// Bytes of the mapping before the first element, and in all.
    skipped: usize,
    mapped: usize,
}

// SAFETY: an arena owns its elements, as a boxed slice does.
unsafe impl<T: Send> Send for Arena<T> {}
// SAFETY: as above.
unsafe impl<T: Sync> Sync for Arena<T> {}

impl<T: Zeroable + Copy> Arena<T> {
    /// Room for `len` elements; `None` if there is not that much memory.
    pub fn zeroed(len: usize) -> Option<Self> {
        const { assert!(align_of::<T>() <= 4096) };
        let bytes = len.checked_mul(size_of::<T>())?;
        if bytes == 0 {
            return Some(Self::default());
        }
        // Small arrays do not deserve a huge page of their own.
        let is_huge = bytes >= HUGE_PAGE / 16;
        let bytes = if is_huge { bytes.checked_next_multiple_of(HUGE_PAGE)? } else { bytes };
        let mapped = if is_huge { bytes.checked_add(HUGE_PAGE)? } else { bytes };
        let access = libc::PROT_READ | libc::PROT_WRITE;
        let kind = libc::MAP_PRIVATE | libc::MAP_ANONYMOUS | libc::MAP_NORESERVE;
        // SAFETY: asks for a new mapping anywhere; touches no memory that exists.
        let start = unsafe { libc::mmap(std::ptr::null_mut(), mapped, access, kind, -1, 0) };
        if start == libc::MAP_FAILED {
            return None;
        }
        let start = NonNull::new(start.cast::<u8>())?;
        let mut skipped = 0;
        if is_huge {
            skipped = start.as_ptr().align_offset(HUGE_PAGE);
            let aligned = start.as_ptr().wrapping_add(skipped);
            // A wish, not a need: that it fails is no failure.
            // SAFETY: the range lies in the mapping made above.
            unsafe { libc::madvise(aligned.cast(), bytes, libc::MADV_HUGEPAGE) };
        }
        let first = start.as_ptr().wrapping_add(skipped).cast();
        Some(Self { first: NonNull::new(first)?, len, skipped, mapped })
    }
}

impl<T> Arena<T> {
    /// Keeps the first `len` elements; what was never written behind them has cost no memory.
    pub fn truncate(&mut self, len: usize) {
        self.len = self.len.min(len);
    }
}

impl<T> Default for Arena<T> {
    fn default() -> Self {
        Self { first: NonNull::dangling(), len: 0, skipped: 0, mapped: 0 }
    }
}

impl<T> Deref for Arena<T> {
    type Target = [T];

    #[inline(always)]
    fn deref(&self) -> &[T] {
        // SAFETY: `len` elements lie from there on, aligned and initialised: zero is a value of T, and only
        // values of T have been written since.
        unsafe { std::slice::from_raw_parts(self.first.as_ptr(), self.len) }
    }
}

impl<T> DerefMut for Arena<T> {
    fn deref_mut(&mut self) -> &mut [T] {
        // SAFETY: as above, and `self` is borrowed exclusively.
        unsafe { std::slice::from_raw_parts_mut(self.first.as_ptr(), self.len) }
    }
}

impl<T> Drop for Arena<T> {
    fn drop(&mut self) {
        if self.mapped > 0 {
            let start = self.first.as_ptr().cast::<u8>().wrapping_sub(self.skipped);
            // SAFETY: the whole mapping that `zeroed` made, which nothing refers to any more.
            unsafe { libc::munmap(start.cast(), self.mapped) };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Arena;

    #[test]
    fn holds_what_is_written() {
        for len in [0, 1, 1000, 3 << 18, 1 << 20] {
            let mut arena = Arena::<u64>::zeroed(len).expect("memory");
            assert_eq!((arena.len(), arena.iter().sum::<u64>()), (len, 0));
            arena.iter_mut().zip(0..).for_each(|(x, i)| *x = i);
            assert!(arena.iter().zip(0..).all(|(&x, i)| x == i));
        }
    }

    #[test]
    fn more_than_there_is_is_none() {
        assert!(Arena::<u64>::zeroed(usize::MAX / 8).is_none());
        assert!(Arena::<u64>::zeroed(usize::MAX).is_none());
    }
}
