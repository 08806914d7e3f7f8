//! What each stage of the wavefront costs: seconds, calls and rays, always on.
//!
//! A stage works on a batch, so timing it takes two clock reads per many paths. Each worker keeps its own
//! ledger; they are added at the end. Knows nothing of what the stages do.

use std::time::Instant;

/// The stages of the wavefront, in their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stage {
    /// Camera rays into free slots.
    Generate,
    /// Closest hits.
    Intersect,
    /// Hits to surface interactions.
    Interact,
    /// Emission found by the rays themselves.
    Emit,
    /// Materials and their textures to scattering models.
    Materials,
    /// Choosing lights and evaluating BSDFs towards them.
    SampleLights,
    /// Shadow rays.
    Shadow,
    /// Choosing the next directions.
    Scatter,
    /// Russian roulette and compaction.
    Roulette,
    /// Finished paths into the film.
    Accumulate,
}

impl Stage {
    /// Every stage, in order.
    pub const ALL: [Self; 10] = [
        Self::Generate,
        Self::Intersect,
        Self::Interact,
        Self::Emit,
        Self::Materials,
        Self::SampleLights,
        Self::Shadow,
        Self::Scatter,
        Self::Roulette,
        Self::Accumulate,
    ];

    /// Name in tables and JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Generate => "generate",
            Self::Intersect => "intersect",
            Self::Interact => "interact",
            Self::Emit => "emit",
            Self::Materials => "materials",
            Self::SampleLights => "sample lights",
            Self::Shadow => "shadow",
            Self::Scatter => "scatter",
            Self::Roulette => "roulette",
            Self::Accumulate => "accumulate",
        }
    }
}

/// Totals of one stage.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StageTotals {
    /// Worker seconds.
    pub seconds: f64,
    /// Batches.
    pub calls: u64,
    /// Paths or rays in all batches.
    pub items: u64,
}

/// Totals of all stages, and of rays by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ledger {
    stages: [StageTotals; Stage::ALL.len()],
    /// Paths begun: rays from the camera.
    pub camera_rays: u64,
    /// Rays that continue a path.
    pub bounce_rays: u64,
    /// Rays towards lights.
    pub shadow_rays: u64,
}

impl Ledger {
    /// Totals of one stage.
    pub fn stage(&self, stage: Stage) -> StageTotals {
        self.stages[stage as usize]
    }

    /// All rays.
    pub fn rays(&self) -> u64 {
        self.camera_rays + self.bounce_rays + self.shadow_rays
    }

    /// Worker seconds in all stages.
    pub fn seconds(&self) -> f64 {
        self.stages.iter().map(|s| s.seconds).sum()
    }

    /// Adds another worker's totals.
    pub fn add(&mut self, other: &Self) {
        for (mine, theirs) in self.stages.iter_mut().zip(other.stages) {
            mine.seconds += theirs.seconds;
            mine.calls += theirs.calls;
            mine.items += theirs.items;
        }
        self.camera_rays += other.camera_rays;
        self.bounce_rays += other.bounce_rays;
        self.shadow_rays += other.shadow_rays;
    }
}

/// Charges the time since the last lap to stages.
#[derive(Debug)]
pub struct Clock {
    last: Instant,
}

impl Clock {
    /// Starts now.
    pub fn start() -> Self {
        Self { last: Instant::now() }
    }

    /// Charges everything since the last lap to `stage`, which worked on `items`.
    pub fn lap(&mut self, ledger: &mut Ledger, stage: Stage, items: usize) {
        let now = Instant::now();
        let totals = &mut ledger.stages[stage as usize];
        totals.seconds += (now - self.last).as_secs_f64();
        totals.calls += 1;
        totals.items += items as u64;
        self.last = now;
    }
}
