//! The bill: what each stage of the wavefront costs, how many rays each class of transport takes. Always on.
//!
//! A stage works on a batch, so timing it takes two clock reads per many paths. Each worker keeps its own
//! ledger; they are added at the end. Knows nothing of what the stages do.

mod class;
mod stage;
mod watch;

pub use class::{Class, Events};
pub use stage::Stage;
pub use watch::Watch;

use std::time::Instant;

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

/// Totals of a feature that runs within stages.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FeatureTotals {
    /// How often it ran.
    pub calls: u64,
    /// Worker seconds, which its stages have counted too; estimated from some of the calls.
    pub seconds: f64,
}

/// Rays of one class.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ClassRays {
    /// From the camera and from surface to surface; one that meets a light is in the class of that light.
    pub path: u64,
    /// Samples of lights: where shadows are cast, a ray each.
    pub light: u64,
}

/// Totals of all stages, and of rays by class.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ledger {
    stages: [StageTotals; Stage::ALL.len()],
    classes: [ClassRays; Class::COUNT],
    /// What hit filters cost within the stages that trace rays.
    pub cut_outs: FeatureTotals,
    /// Seconds of all workers, in stages or not.
    pub worker_seconds: f64,
}

impl Ledger {
    /// Totals of one stage.
    pub fn stage(&self, stage: Stage) -> StageTotals {
        self.stages[stage as usize]
    }

    /// Rays of one class.
    pub fn class_rays(&self, class: Class) -> ClassRays {
        self.classes[class as usize]
    }

    /// Paths begun: rays from the camera.
    pub fn camera_rays(&self) -> u64 {
        self.class_rays(Class::Seen).path
    }

    /// Rays that continue a path.
    pub fn bounce_rays(&self) -> u64 {
        self.classes.iter().map(|rays| rays.path).sum::<u64>() - self.camera_rays()
    }

    /// Rays towards lights.
    pub fn shadow_rays(&self) -> u64 {
        self.stage(Stage::Shadow).items
    }

    /// All rays.
    pub fn rays(&self) -> u64 {
        self.camera_rays() + self.bounce_rays() + self.shadow_rays()
    }

    /// Worker seconds in all stages.
    pub fn seconds(&self) -> f64 {
        self.stages.iter().map(|s| s.seconds).sum()
    }

    /// Samples of lights.
    pub fn light_samples(&self) -> u64 {
        self.classes.iter().map(|rays| rays.light).sum()
    }

    /// Worker seconds that the rays of a class took: its share, by number, of what rays of a path go through and of
    /// what samples of lights go through. What happens once a path belongs to the light that is seen.
    pub fn class_seconds(&self, class: Class) -> f64 {
        let rays = self.class_rays(class);
        let share = |own: u64, all: u64| own as f64 / all.max(1) as f64;
        let of_paths = share(rays.path, self.camera_rays() + self.bounce_rays());
        let of_lights = share(rays.light, self.light_samples());
        let once = if class == Class::Seen { 1.0 } else { 0.0 };
        let seconds = |&stage: &Stage| {
            let share = match stage {
                Stage::Generate | Stage::Lens | Stage::Accumulate => once,
                Stage::SampleLights | Stage::Shadow => of_lights,
                _ => of_paths,
            };
            share * self.stage(stage).seconds
        };
        Stage::ALL.iter().map(seconds).sum()
    }

    /// Counts a ray that begins or continues a path.
    #[inline]
    pub fn count_path_ray(&mut self, class: Class) {
        self.classes[class as usize].path += 1;
    }

    /// Counts a ray in `class` that has been counted in `before`.
    #[inline]
    pub fn recount_path_ray(&mut self, before: Class, class: Class) {
        self.classes[before as usize].path -= 1;
        self.classes[class as usize].path += 1;
    }

    /// Counts a sample of a light.
    #[inline]
    pub fn count_light_sample(&mut self, class: Class) {
        self.classes[class as usize].light += 1;
    }

    /// Adds another worker's totals.
    pub fn add(&mut self, other: &Self) {
        for (mine, theirs) in self.stages.iter_mut().zip(other.stages) {
            mine.seconds += theirs.seconds;
            mine.calls += theirs.calls;
            mine.items += theirs.items;
        }
        for (mine, theirs) in self.classes.iter_mut().zip(other.classes) {
            mine.path += theirs.path;
            mine.light += theirs.light;
        }
        self.cut_outs.calls += other.cut_outs.calls;
        self.cut_outs.seconds += other.cut_outs.seconds;
        self.worker_seconds += other.worker_seconds;
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

    /// Charges everything since the last lap to `stage`, in a batch that has been counted.
    pub fn charge(&mut self, ledger: &mut Ledger, stage: Stage) {
        let now = Instant::now();
        ledger.stages[stage as usize].seconds += (now - self.last).as_secs_f64();
        self.last = now;
    }
}
