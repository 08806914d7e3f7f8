//! What whole frames found out, in the names of `--json`: SI units, counts, pixels in image coordinates.
//!
//! All lists are flat, as in `result`.

use super::result::Scene;
use super::statistics::{Ratio, Spread};
use serde::Serialize;

/// A whole frame, rendered again and again on one backend.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Frame {
    /// Of which scene.
    pub scene: String,
    /// "embree" or "bvh".
    pub backend: &'static str,
    /// How it was built and is called.
    pub variant: String,
    /// The widest instructions that it may use.
    pub isa: &'static str,
    /// How many threads rendered it.
    pub threads: usize,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Paths begun in every pixel.
    pub samples_per_pixel: u64,
    /// Camera, bounce and shadow rays of one frame.
    pub rays: u64,
    /// Wall-clock seconds of a frame, from the first path to the last; neither loading nor building. Nothing where
    /// pictures were not always the same.
    pub seconds: Option<Spread>,
    /// At the median; nothing where there are no seconds.
    pub rays_per_second: Option<f64>,
    /// Frames that were unlike the backend's first one.
    pub unsteady_turns: usize,
    /// Frames that were timed though the machine was busy.
    pub busy_turns: usize,
}

/// How much faster a backend makes a frame than the one it is held against.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct FrameRatio {
    /// Of which scene.
    pub scene: String,
    /// On how many threads.
    pub threads: usize,
    /// Whose speed is told.
    pub backend: &'static str,
    /// The other one.
    pub rival: &'static str,
    /// The rival's seconds over the backend's.
    pub ratio: Ratio,
}

/// Where the pictures of two backends differ.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct DifferingPixels {
    /// Of which scene.
    pub scene: String,
    /// Whose picture.
    pub backend: &'static str,
    /// And whose else.
    pub rival: &'static str,
    /// Pixels that differ in any bit of their radiance or alpha.
    pub count: usize,
    /// Pixels of a picture.
    pub all: usize,
    /// Paths begun in each.
    pub samples_per_pixel: u64,
    /// Column and row of each that differs, row by row, from the top left.
    pub pixels: Vec<[u32; 2]>,
}

impl DifferingPixels {
    /// The largest share of pixels that rays along edges explain at up to 16 samples a pixel: hair of two million triangles
    /// makes 0.0007, other models next to none.
    pub const MOST: f64 = 0.002;

    /// The same at this number of samples, each of which may be the one that differs: sixteen at a time.
    pub fn most(&self) -> f64 {
        let alike = (1..self.samples_per_pixel.div_ceil(16).min(10_000))
            .fold(1.0 - Self::MOST, |alike, _| alike * (1.0 - Self::MOST));
        1.0 - alike
    }

    /// Whether there are more than that.
    pub fn is_too_many(&self) -> bool {
        self.count as f64 > self.most() * self.all as f64
    }
}

/// What frames of one scene found out.
#[derive(Clone, Debug)]
pub struct FrameFindings {
    /// The scene; no rays of any kind.
    pub scene: Scene,
    /// For each number of threads, each backend.
    pub frames: Vec<Frame>,
    /// For each number of threads, each backend but the first against that one.
    pub ratios: Vec<FrameRatio>,
    /// Each backend but the first against that one.
    pub differing_pixels: Vec<DifferingPixels>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_in_a_thousand_may_differ() {
        let of_10_000 = |count, samples_per_pixel| DifferingPixels {
            scene: String::new(),
            backend: "bvh",
            rival: "embree",
            count,
            all: 10_000,
            samples_per_pixel,
            pixels: Vec::new(),
        };
        assert!(!of_10_000(20, 1).is_too_many() && of_10_000(21, 16).is_too_many());
        // 1 - 0.998^8.
        assert!(!of_10_000(158, 128).is_too_many() && of_10_000(159, 128).is_too_many());
    }
}
