//! The strategies of sampling a square: what each is called, what it can do, and its sets of points.
//!
//! A set is what a strategy is by itself: to look at, to measure, and for [`super::Sampler`] to make the numbers of
//! paths from. Coordinates are 32-bit fractions ([`Fraction`]), so that none is ever 1.

mod blue_noise;
mod centroidal_voronoi;
mod correlated_multi_jittered;
mod dart_throwing;
mod formula;
mod fraction;
pub(super) mod halton;
mod hammersley;
mod multi_jittered;
mod n_rooks;
mod permutation;
mod pmj02;
mod poisson_disk;
pub(super) mod screen;
pub(super) mod sobol;
mod strata;

pub(super) use formula::{Formula, split};
pub(super) use fraction::in_stratum;
pub use fraction::{Fraction, to_f64};
pub(super) use permutation::permute;

#[cfg(test)]
mod tests;

use super::CounterRng;
use super::hash::mix64;
use super::voronoi::Domain;
use crate::error::{Error, Result, named_set, unknown_name};

named_set! {
    /// A way to spread points over the unit square.
    Strategy {
        /// The middles of cells of equal area.
        Grid = "grid",
        /// Uniform, each by itself.
        Random = "random",
        /// One uniform point in each cell of a grid.
        Jittered = "jittered",
        /// One point in each of n rows and of n columns.
        NRooks = "n-rooks",
        /// Jittered and n-rooks at once.
        MultiJittered = "multi-jittered",
        /// Multi-jittered, with one shuffle for all rows and one for all columns.
        CorrelatedMultiJittered = "correlated-multi-jittered",
        /// Poisson disk by comparing every dart with every point.
        DartThrowing = "dart-throwing",
        /// Poisson disk in linear time.
        PoissonDisk = "poisson-disk",
        /// Centroids of their own Voronoi cells, on the torus.
        CentroidalVoronoi = "centroidal-voronoi",
        /// Centroids of their own Voronoi cells, in the bounded square.
        BoundedVoronoi = "bounded-voronoi",
        /// Void-and-cluster.
        BlueNoise = "blue-noise",
        /// Radical inverses in bases 2 and 3.
        Halton = "halton",
        /// i/n and the radical inverse in base 2.
        Hammersley = "hammersley",
        /// The first two Sobol dimensions, Owen-scrambled.
        Sobol = "sobol",
        /// Sobol, with the numbers of neighbouring pixels chosen so that errors on the screen are blue noise.
        ScreenSobol = "sobol-blue-noise",
        /// Progressive multi-jittered (0,2).
        Pmj02 = "pmj02",
    }
}

/// Points, and what making them took.
#[derive(Clone, Debug)]
pub struct PointSet {
    /// In the order of the strategy.
    pub points: Vec<[Fraction; 2]>,
    /// Counts and lengths by name: darts, radius, steps.
    pub facts: Vec<(&'static str, f64)>,
    /// Of sets that are relaxed: the energy that each step began with ([`super::voronoi::relax`]).
    pub energies: Vec<f64>,
}

impl PointSet {
    fn new(points: Vec<[Fraction; 2]>, facts: Vec<(&'static str, f64)>) -> Self {
        Self { points, facts, energies: Vec::new() }
    }
}

impl Strategy {
    /// The most points of a set.
    pub const MAX_COUNT: u32 = 1 << 20;

    /// `count` points. `seed` randomises them, but for the grid, Halton and Hammersley points, which are what they are.
    ///
    /// # Errors
    /// A usage error for no points, more than [`Self::MAX_COUNT`], or a count that the strategy does not allow.
    pub fn points(self, count: u32, seed: u64) -> Result<PointSet> {
        self.check(count)?;
        Ok(match self {
            Self::DartThrowing => dart_throwing::points(count, seed),
            Self::PoissonDisk => poisson_disk::points(count, seed),
            Self::CentroidalVoronoi => centroidal_voronoi::points(count, Domain::Torus, seed),
            Self::BoundedVoronoi => centroidal_voronoi::points(count, Domain::Square, seed),
            Self::BlueNoise => blue_noise::points(count, seed),
            Self::Pmj02 => pmj02::points(count, seed),
            _ => {
                let seed = mix64(seed ^ 0x7374_7261_7465_6779);
                let formula = Formula::new(self, count);
                let points = formula.map(|f| (0..count).map(|i| f.point(i, seed)).collect());
                PointSet::new(points.unwrap_or_default(), Vec::new())
            }
        })
    }

    /// # Errors
    /// As [`Strategy::points`].
    pub fn check(self, count: u32) -> Result<()> {
        let (name, max) = (self.name(), self.max_count());
        if count == 0 || count > max {
            let message = format!("a set of {name} points has 1 to {max} of them, not {count}");
            return Err(Error::Usage(message));
        }
        if self.allows(count) {
            return Ok(());
        }
        let below = (1..count).rev().find(|n| self.allows(*n)).unwrap_or(1);
        let above = (count..).find(|n| self.allows(*n)).unwrap_or(1);
        let rule = "a grid of columns and rows, neither more than four times the other";
        Err(Error::Usage(format!(
            "{name} needs a number of points that makes {rule}: {below} or {above}, not {count}"
        )))
    }

    /// The most points of a set: as many as take the slow strategies some ten seconds.
    pub const fn max_count(self) -> u32 {
        match self {
            Self::BlueNoise => 16_384,
            Self::CentroidalVoronoi | Self::BoundedVoronoi => 8192,
            Self::DartThrowing => 32_768,
            Self::Pmj02 => 65_536,
            _ => Self::MAX_COUNT,
        }
    }

    /// Whether there are sets of `count` points.
    pub fn allows(self, count: u32) -> bool {
        let needs_cells = matches!(self, Self::MultiJittered | Self::CorrelatedMultiJittered);
        (1..=self.max_count()).contains(&count)
            && (!needs_cells || multi_jittered::Cells::of(count).is_some())
    }

    /// How it spreads points, in a few words.
    pub const fn description(self) -> &'static str {
        match self {
            Self::Grid => "regular: the middles of cells of equal area",
            Self::Random => "independent uniform points",
            Self::Jittered => "stratified: one uniform point in each cell of a grid",
            Self::NRooks => "Latin hypercube: one point in each of n rows and n columns",
            Self::MultiJittered => "one point a cell, and one in each of n rows and n columns",
            Self::CorrelatedMultiJittered => {
                "multi-jittered with one shuffle for all rows or columns"
            }
            Self::DartThrowing => "Poisson disk: random points that keep a distance",
            Self::PoissonDisk => "Poisson disk in linear time: darts only where there is room",
            Self::CentroidalVoronoi => "Lloyd's relaxation on the torus",
            Self::BoundedVoronoi => "Lloyd's relaxation in the bounded square",
            Self::BlueNoise => "void-and-cluster ranks",
            Self::Halton => "radical inverses in bases 2 and 3",
            Self::Hammersley => "i/n and the radical inverse in base 2",
            Self::Sobol => "Sobol's first two dimensions, Owen-scrambled",
            Self::ScreenSobol => "Sobol, with errors that are blue noise on the screen",
            Self::Pmj02 => "progressive multi-jittered: every power of two of points a (0,2)-net",
        }
    }

    /// Whether its sets depend on the seed.
    pub const fn is_random(self) -> bool {
        !matches!(self, Self::Grid | Self::Halton | Self::Hammersley)
    }

    /// Whether it can sample the pixels and paths of a render: all but what is no set of the torus.
    pub const fn can_render(self) -> bool {
        !matches!(self, Self::BoundedVoronoi)
    }

    /// The sampler of this name.
    ///
    /// # Errors
    /// A usage error that lists the names, or says why there are only sets.
    pub fn sampler(name: &str) -> Result<Self> {
        if name == Self::BoundedVoronoi.name() {
            let message = "bounded-voronoi has no points beyond its edges, so that its sets cannot be shifted from pixel to pixel: take centroidal-voronoi";
            return Err(Error::Usage(message.into()));
        }
        let samplers = || Self::ALL.iter().filter(|strategy| strategy.can_render());
        let found = samplers().find(|strategy| strategy.name() == name).copied();
        let known = samplers().map(|strategy| strategy.name());
        found.ok_or_else(|| Error::Usage(unknown_name("sampler", name, known)))
    }

    /// Whether it has sets of its own.
    pub const fn has_sets(self) -> bool {
        !matches!(self, Self::ScreenSobol)
    }
}

impl Default for Strategy {
    /// Owen-scrambled Sobol points: progressive, stratified in every way that a pair of numbers can be, and cheap.
    fn default() -> Self {
        Self::Sobol
    }
}

/// Independent of everything before.
fn random_point(rng: &mut CounterRng) -> [Fraction; 2] {
    split(rng.bits())
}
