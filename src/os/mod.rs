//! What only the operating system and the processor know: memory and time used, instruction sets.
//!
//! One of the three places where `unsafe` is allowed. Knows nothing of rendering.
#![allow(unsafe_code)]

mod arena;
mod clock;
mod isa;
mod prefetch;

pub use arena::Arena;
pub use clock::thread_seconds;
pub use isa::{Isa, Kernel};
pub use prefetch::prefetch;

/// The most memory that this process has had resident, in bytes; 0 where the system does not say.
pub fn peak_rss_bytes() -> u64 {
    // SAFETY: rusage is plain data, for which all bytes zero is a value.
    let mut usage: libc::rusage = unsafe { std::mem::zeroed() };
    // SAFETY: the pointer is to a valid rusage, which the call fills in.
    let status = unsafe { libc::getrusage(libc::RUSAGE_SELF, &raw mut usage) };
    if status != 0 {
        return 0;
    }
    // Linux counts in units of 1024 bytes (getrusage(2)).
    u64::try_from(usage.ru_maxrss).unwrap_or(0) * 1024
}

#[cfg(test)]
mod tests {
    #[test]
    fn grows_with_use() {
        let before = super::peak_rss_bytes();
        let block = vec![1_u8; 64 << 20];
        assert!(block.iter().map(|&b| u64::from(b)).sum::<u64>() == 64 << 20);
        let after = super::peak_rss_bytes();
        assert!(after >= before.max(64 << 20), "{before} {after}");
    }
}
