//! The strategies whose points are worked out one by one, from nothing but their number and a seed.

use super::multi_jittered::Cells;
use super::strata::Strata;
use super::{Fraction, Strategy, correlated_multi_jittered, fraction, halton, hammersley};
use super::{multi_jittered, n_rooks, sobol};
use crate::sampling::hash::combine;

/// How to work out a point of a set.
#[derive(Clone, Copy, Debug)]
pub(in crate::sampling) enum Formula {
    Grid(Strata),
    Random,
    Jittered(Strata),
    NRooks(u32),
    MultiJittered(Cells),
    CorrelatedMultiJittered(Cells),
    Halton,
    Hammersley(u32),
    Sobol,
}

impl Formula {
    /// For sets of `count` points; `None` for strategies that make their points together, or not this many.
    pub(in crate::sampling) fn new(strategy: Strategy, count: u32) -> Option<Self> {
        Some(match strategy {
            Strategy::Grid => Self::Grid(Strata::new(count)),
            Strategy::Random => Self::Random,
            Strategy::Jittered => Self::Jittered(Strata::new(count)),
            Strategy::NRooks => Self::NRooks(count),
            Strategy::MultiJittered => Self::MultiJittered(Cells::of(count)?),
            Strategy::CorrelatedMultiJittered => Self::CorrelatedMultiJittered(Cells::of(count)?),
            Strategy::Halton => Self::Halton,
            Strategy::Hammersley => Self::Hammersley(count),
            Strategy::Sobol | Strategy::ScreenSobol => Self::Sobol,
            _ => return None,
        })
    }

    /// Point `i`.
    #[inline]
    pub(in crate::sampling) fn point(&self, i: u32, seed: u64) -> [Fraction; 2] {
        let offset = || split(combine(combine(seed, 2), u64::from(i)));
        match self {
            Self::Grid(strata) => strata.middle(i),
            Self::Random => offset(),
            Self::Jittered(strata) => strata.point(i, offset()),
            Self::NRooks(n) => n_rooks::point(i, *n, seed, offset()),
            Self::MultiJittered(cells) => multi_jittered::point(i, *cells, seed, offset()),
            Self::CorrelatedMultiJittered(cells) => {
                correlated_multi_jittered::point(i, *cells, seed, offset())
            }
            Self::Halton => halton::point(i),
            Self::Hammersley(n) => hammersley::point(i, *n),
            Self::Sobol => sobol::owen_sobol_2d(i, seed),
        }
    }

    /// What point `i` is in one dimension: its first coordinate, or one of n strata where the strategy is about strata.
    #[inline]
    pub(in crate::sampling) fn number(&self, i: u32, n: u32, seed: u64) -> Fraction {
        match self {
            Self::Grid(_) => fraction::in_stratum(i, n, fraction::HALF),
            Self::Jittered(_) => fraction::in_stratum(i, n, combine(seed, u64::from(i)) as u32),
            _ => self.point(i, seed)[0],
        }
    }
}

/// Two fractions of the bits of one number.
#[inline(always)]
pub(in crate::sampling) const fn split(bits: u64) -> [Fraction; 2] {
    [(bits >> 32) as u32, bits as u32]
}
