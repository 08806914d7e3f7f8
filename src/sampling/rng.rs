//! A counter-based generator for set-up work and tests, usable with every `rand` adaptor.
//!
//! Value n of a stream is a hash of (seed, n): the stream is the same on every machine and can be
//! entered anywhere. Paths do not use it; they draw by name from [`super::Sampler`].

use super::hash::{combine, mix64};
use std::convert::Infallible;

/// Random access stream of 64-bit numbers.
#[derive(Clone, Debug)]
pub struct CounterRng {
    key: u64,
    counter: u64,
}

impl CounterRng {
    /// The stream of `seed`, from its first number.
    pub fn new(seed: u64) -> Self {
        Self { key: mix64(seed ^ 0x636f_756e_7465_7231), counter: 0 }
    }

    /// A number in [0, 1).
    pub fn unit(&mut self) -> f32 {
        super::hash::unit_f32((self.bits() >> 32) as u32)
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.counter += 1;
        combine(self.key, self.counter)
    }
}

impl rand::TryRng for CounterRng {
    type Error = Infallible;

    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        Ok((self.bits() >> 32) as u32)
    }

    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        Ok(self.bits())
    }

    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        for chunk in bytes.chunks_mut(8) {
            chunk.copy_from_slice(&self.bits().to_le_bytes()[..chunk.len()]);
        }
        Ok(())
    }
}
