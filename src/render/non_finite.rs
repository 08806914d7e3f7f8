//! Samples that came out NaN or infinite: counted, located, kept out of the image.

use crate::geometry::PrimitiveId;
use crate::math::Rgb;
use crate::trace::PixelSample;
use crate::world::World;

/// One such sample.
#[derive(Clone, Debug, PartialEq)]
pub struct NonFiniteSample {
    /// Pixel in image coordinates.
    pub pixel: [u32; 2],
    /// Sample number, for replaying it.
    pub sample: u64,
    /// Path vertices until it ended.
    pub bounces: u32,
    /// What it came out as.
    pub radiance: Rgb,
    /// Name of the last material the path met.
    pub material: Option<String>,
    /// Line of the model file that the last surface comes from.
    pub line: Option<u32>,
}

/// How many there were, and the first of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NonFinite {
    /// All of them.
    pub count: u64,
    /// The first few that each worker met.
    pub examples: Vec<NonFiniteSample>,
}

const MOST_EXAMPLES: usize = 16;

impl NonFinite {
    /// Counts a sample, and locates it if it is among the first.
    pub(super) fn record(&mut self, sample: &PixelSample, world: &World) {
        self.count += 1;
        if self.examples.len() >= MOST_EXAMPLES {
            return;
        }
        let hit = (sample.last_hit != PrimitiveId::MISS).then_some(sample.last_hit);
        self.examples.push(NonFiniteSample {
            pixel: sample.pixel,
            sample: sample.sample,
            bounces: sample.bounces,
            radiance: sample.radiance,
            material: hit.map(|id| world.material(world.material_id(id)).name.clone()),
            line: hit.and_then(|id| world.source_line(id)),
        });
    }

    /// Adds another worker's.
    pub(super) fn add(&mut self, other: &Self) {
        self.count += other.count;
        self.examples.extend(other.examples.iter().cloned());
        self.examples.sort_by_key(|e| (e.sample, e.pixel[1], e.pixel[0]));
        self.examples.truncate(MOST_EXAMPLES);
    }
}
