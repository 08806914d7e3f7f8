//! Immutable, reference-counted arrays that Embree reads in place.
//!
//! Embree loads vertices 16 bytes at a time, so 16 readable bytes must follow the last element
//! (Embree API, "rtcSetSharedGeometryBuffer"): that is the invariant of this type, not a habit of
//! its callers. Cloning shares; an Embree scene holds a clone, so no buffer dies before it.

use std::mem::size_of;
use std::ops::Deref;
use std::sync::Arc;

/// Bytes that may be read past the last element.
const PADDING_BYTES: usize = 16;

/// A shared immutable array with 16 readable bytes behind its end.
#[derive(Clone, Debug)]
pub struct Buffer<T> {
    /// The elements, then padding elements that no accessor shows.
    storage: Arc<Vec<T>>,
    len: usize,
}

impl<T: bytemuck::Pod> Buffer<T> {
    /// Takes `elements` over and pads them.
    pub fn new(mut elements: Vec<T>) -> Self {
        let len = elements.len();
        let padding = PADDING_BYTES.div_ceil(size_of::<T>());
        elements.reserve_exact(padding);
        elements.extend(std::iter::repeat_n(T::zeroed(), padding));
        Self { storage: Arc::new(elements), len }
    }

    /// Bytes of memory held, padding included.
    pub fn bytes(&self) -> usize {
        self.storage.capacity() * size_of::<T>()
    }

    /// How many owners share the array; for tests of who keeps what alive.
    pub fn owners(&self) -> usize {
        Arc::strong_count(&self.storage)
    }
}

impl<T: bytemuck::Pod> Default for Buffer<T> {
    fn default() -> Self {
        Self::new(Vec::new())
    }
}

impl<T> Deref for Buffer<T> {
    type Target = [T];
    #[inline]
    fn deref(&self) -> &[T] {
        &self.storage[..self.len]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sixteen_bytes_follow_the_last_element() {
        for n in [0_usize, 1, 2, 5] {
            let buffer = Buffer::new(vec![[1.0_f32; 3]; n]);
            assert_eq!(buffer.len(), n);
            assert!((buffer.storage.len() - n) * 12 >= PADDING_BYTES);
            assert!(buffer.iter().all(|v| *v == [1.0; 3]));
        }
    }

    #[test]
    fn clones_share() {
        let buffer = Buffer::new(vec![[0_u32; 3]; 4]);
        let other = buffer.clone();
        assert_eq!(buffer.as_ptr(), other.as_ptr());
        assert_eq!(buffer.owners(), 2);
    }
}
