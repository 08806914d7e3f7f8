//! A list of bounded length whose memory is there from the start.
//!
//! `Vec::push` may have to grow: the compiler builds the value beside the vector and then copies it, in loads
//! wider than the stores before them, which stalls the processor (10 ns a vertex, measured). Here a value
//! is written where it stays.

use std::ops::{Deref, DerefMut};

/// At most as many values as there was room for at the start.
#[derive(Clone, Debug)]
pub(super) struct Batch<T> {
    values: Box<[T]>,
    len: usize,
}

impl<T: Copy + Default> Batch<T> {
    /// Room for `capacity` values.
    pub(super) fn new(capacity: usize) -> Self {
        Self { values: vec![T::default(); capacity].into(), len: 0 }
    }

    pub(super) fn clear(&mut self) {
        self.len = 0;
    }

    /// Appends a value; there must be room.
    #[inline(always)]
    pub(super) fn push(&mut self, value: T) {
        self.values[self.len] = value;
        self.len += 1;
    }

    /// Appends a value if it is wanted; there must be room either way. Without a branch, for what is random: a
    /// wrong guess costs the processor some 20 cycles.
    #[inline(always)]
    pub(super) fn push_if(&mut self, wanted: bool, value: T) {
        self.values[self.len] = value;
        self.len += usize::from(wanted);
    }

    /// Removes the last value.
    #[inline(always)]
    pub(super) fn pop(&mut self) -> Option<T> {
        self.len = self.len.checked_sub(1)?;
        Some(self.values[self.len])
    }

    /// Keeps the values that `keep` says, in their order.
    #[inline(always)]
    pub(super) fn retain(&mut self, mut keep: impl FnMut(&T) -> bool) {
        let mut kept = 0;
        for i in 0..self.len {
            if keep(&self.values[i]) {
                if kept < i {
                    self.values[kept] = self.values[i];
                }
                kept += 1;
            }
        }
        self.len = kept;
    }
}

impl<T> Deref for Batch<T> {
    type Target = [T];

    #[inline]
    fn deref(&self) -> &[T] {
        &self.values[..self.len]
    }
}

impl<T> DerefMut for Batch<T> {
    #[inline]
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.values[..self.len]
    }
}
