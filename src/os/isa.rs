//! The widest vector instructions of this machine, chosen while the program runs.
//!
//! A [`Kernel`] is ordinary Rust: loops over arrays whose bodies are inlined. It is compiled once for each
//! instruction set, and the compiler vectorises each copy as far as the set goes. Rust neither fuses nor
//! reorders floating-point operations, so all copies give the same bits. Knows nothing of what kernels do.

use std::sync::atomic::{AtomicU8, Ordering};

/// Instruction sets, each including those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Isa {
    /// What the program was compiled for; on x86-64, SSE2.
    Portable,
    /// 256-bit vectors.
    Avx2,
    /// 512-bit vectors, with their integer and byte operations.
    Avx512,
}

impl Isa {
    /// Every set with its name.
    pub const ALL: [(&'static str, Self); 3] =
        [("portable", Self::Portable), ("avx2", Self::Avx2), ("avx512", Self::Avx512)];

    /// Its name.
    pub fn name(self) -> &'static str {
        Self::ALL[self as usize].0
    }

    /// The widest set of this machine.
    #[inline]
    pub fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            // The answers are cached by the standard library.
            use std::arch::is_x86_feature_detected as has;
            if has!("avx2") && has!("bmi1") && has!("bmi2") {
                let wide =
                    has!("avx512f") && has!("avx512bw") && has!("avx512dq") && has!("avx512vl");
                return if wide { Self::Avx512 } else { Self::Avx2 };
            }
        }
        Self::Portable
    }

    /// The set that kernels are to use: the widest of this machine, unless [`Isa::limit`] said less.
    #[inline]
    pub fn current() -> Self {
        let limit = match LIMIT.load(Ordering::Relaxed) {
            0 => Self::Portable,
            1 => Self::Avx2,
            _ => Self::Avx512,
        };
        limit.min(Self::detect())
    }

    /// Lets the whole program use no wider set than this one. Results do not depend on it, only speed.
    pub fn limit(self) {
        LIMIT.store(self as u8, Ordering::Relaxed);
    }

    /// Runs the copy of `kernel` for this set, or for the widest that the machine has, if that is less.
    #[inline]
    pub fn run<K: Kernel>(self, kernel: K) {
        match self.min(Self::detect()) {
            Self::Portable => kernel.run(),
            // SAFETY: `detect` has found the features that the function is compiled for.
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => unsafe { run_avx2(kernel) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => unsafe { run_avx512(kernel) },
            #[cfg(not(target_arch = "x86_64"))]
            _ => kernel.run(),
        }
    }
}

/// The widest set allowed.
static LIMIT: AtomicU8 = AtomicU8::new(Isa::Avx512 as u8);

/// Work that is worth compiling for every instruction set.
pub trait Kernel {
    /// Does it. Must be `#[inline(always)]`, and so must all that it calls in its inner loops: code that
    /// is not inlined is compiled for the portable set only.
    fn run(self);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi1,bmi2")]
fn run_avx2<K: Kernel>(kernel: K) {
    kernel.run();
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi1,bmi2,avx512f,avx512bw,avx512dq,avx512vl")]
fn run_avx512<K: Kernel>(kernel: K) {
    kernel.run();
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Squares<'a>(&'a mut [f32; 64]);

    impl Kernel for Squares<'_> {
        #[inline(always)]
        fn run(self) {
            for (i, x) in self.0.iter_mut().enumerate() {
                *x = (i as f32 / 3.0).sqrt() * 0.1 + 1.0 / (i as f32 + 0.7);
            }
        }
    }

    #[test]
    fn every_set_gives_the_same_bits() {
        let results = Isa::ALL.map(|(_, isa)| {
            let mut out = [0.0; 64];
            isa.run(Squares(&mut out));
            out.map(f32::to_bits)
        });
        assert_eq!(results[0], results[1]);
        assert_eq!(results[0], results[2]);
    }
}
