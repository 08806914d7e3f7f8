//! The plan: which effects a render simulates, why, and which stages run for them.
//!
//! The census says what the scene calls for, the user what is wanted. What neither needs is not scheduled. The
//! rows of the table and what the stages ask are made of the same two, side by side; it renders nothing.

mod judge;
mod pipeline;
mod row;

pub use pipeline::Pipeline;
pub use row::Row;

use crate::ledger::Stage;
use crate::scene::{self, Effects};
use crate::world::{LightSampler, World};

/// What a user wants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wishes {
    /// Effects.
    pub effects: Effects,
    /// Path segments; `u32::MAX` is unbounded.
    pub max_depth: u32,
    /// The camera is not to see the surroundings.
    pub hide_background: bool,
}

/// What a render simulates.
#[derive(Clone, Debug)]
pub struct Plan {
    /// What the stages ask.
    pub pipeline: Pipeline,
    /// How lights are sampled.
    pub lights: LightSampler,
    /// Every effect and strategy, on or off, with its reason.
    pub rows: Vec<Row>,
}

impl Plan {
    /// The plan for what `camera` sees of `world`, which is the one with `wishes.effects`.
    pub fn new(world: &World, camera: &scene::Camera, wishes: &Wishes) -> Self {
        let census = world.census();
        let has_lens = camera.projection.has_lens();
        let (pipeline, lights) = Pipeline::new(world, &census, has_lens, wishes);
        let rows = row::rows(&pipeline, &lights, &census, camera, wishes);
        Self { pipeline, lights, rows }
    }

    /// The stages that run, in order.
    pub fn stages(&self) -> impl Iterator<Item = Stage> {
        Stage::ALL.iter().copied().filter(|&stage| self.pipeline.runs(stage))
    }
}
