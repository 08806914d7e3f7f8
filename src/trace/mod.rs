//! Paths: the wavefront that advances many of them together, and a naive integrator to hold it against.
//!
//! A block is a rectangle of pixels and a range of samples; what comes out is one [`PixelSample`] a path.
//! The order in which they come out means nothing: the film adds them exactly.

mod batch;
mod path;
mod generate_stage;
mod group;
mod light_stage;
mod numbers;
mod scatter_stage;
mod surface_stage;
mod wavefront;
pub mod naive;
mod aov;

pub use aov::{FirstHit, first_hit};
pub use wavefront::Wavefront;

use crate::accel::Accelerator;
use crate::bsdf::LobeKind;
use crate::camera::{Camera, CameraRay};
use crate::filter::FilterSampler;
use crate::geometry::PrimitiveId;
use crate::ledger::{Class, Events, Watch};
use crate::light::LightKind;
use crate::math::{Rgb, Vec3, fun};
use crate::plan::Plan;
use crate::sampling::{Dimension, SampleKey, Sampler};
use crate::world::{SurfaceInteraction, World};

/// Everything a path needs to know; shared by all workers.
pub struct Tracer<'a, A> {
    /// The compiled scene.
    pub world: &'a World,
    /// Who is hit; built from `world.geometry`.
    pub accelerator: &'a A,
    /// The camera, relative to the world's origin.
    pub camera: &'a Camera,
    /// The pixel filter.
    pub filter: &'a FilterSampler,
    /// The random numbers.
    pub sampler: Sampler,
    /// What is simulated, and how lights are sampled.
    pub plan: &'a Plan,
}

/// A rectangle of pixels and a range of samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Block {
    /// Left and top pixel.
    pub start: [u32; 2],
    /// One past the right and bottom pixel.
    pub end: [u32; 2],
    /// First sample.
    pub first_sample: u64,
    /// One past the last sample.
    pub end_sample: u64,
    /// The pixels whose light is told apart by class.
    pub watch: Watch,
}

impl Block {
    /// Number of paths in it.
    pub fn paths(&self) -> u64 {
        let [width, height] = [0, 1].map(|k| u64::from(self.end[k] - self.start[k]));
        width * height * (self.end_sample - self.first_sample)
    }

    /// Pixel and sample of every path: all samples of a pixel, then the next pixel.
    pub fn iter(&self) -> BlockPaths {
        let Self { start, end, first_sample, end_sample, .. } = *self;
        let is_empty = start[0] >= end[0] || first_sample >= end_sample;
        let pixel = if is_empty { end } else { start };
        BlockPaths { block: *self, pixel, sample: first_sample }
    }
}

/// See [`Block::iter`].
#[derive(Clone, Debug)]
pub struct BlockPaths {
    block: Block,
    /// The next path; its row is past the block's when there is none.
    pixel: [u32; 2],
    sample: u64,
}

impl Iterator for BlockPaths {
    type Item = ([u32; 2], u64);

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        let Block { start, end, first_sample, end_sample, .. } = self.block;
        if self.pixel[1] >= end[1] {
            return None;
        }
        let path = (self.pixel, self.sample);
        self.sample += 1;
        if self.sample == end_sample {
            self.sample = first_sample;
            self.pixel[0] += 1;
            if self.pixel[0] == end[0] {
                self.pixel = [start[0], self.pixel[1] + 1];
            }
        }
        Some(path)
    }
}

/// What one path found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelSample {
    /// Which pixel.
    pub pixel: [u32; 2],
    /// Which sample of it.
    pub sample: u64,
    /// Radiance times the filter's weight.
    pub radiance: Rgb,
    /// 1 if the camera ray met a surface, else 0, times the filter's weight.
    pub coverage: f32,
    /// How many vertices the path had when it ended.
    pub bounces: u32,
    /// The last surface it met.
    pub last_hit: PrimitiveId,
}

/// Radiance of one path by the class of its transport, times the filter's weight: adds up to its whole radiance.
pub type ClassRadiance = [Rgb; Class::COUNT];

/// Where the parts of a watched path go: the cell of its pixel, and them.
pub type Watched<'a> = Option<(u32, &'a ClassRadiance)>;

/// The class of light that is scattered once.
const fn direct_class(kind: LightKind) -> Class {
    match kind {
        LightKind::Point | LightKind::Spot => Class::DirectPoint,
        LightKind::Direction | LightKind::Disc => Class::DirectSun,
        LightKind::Surface => Class::DirectSurface,
        LightKind::Constant | LightKind::Image => Class::DirectEnvironment,
    }
}

/// What a lobe does to a path.
const fn event_of(kind: LobeKind) -> Events {
    match kind {
        LobeKind::Diffuse => Events::DIFFUSE,
        LobeKind::Glossy => Events::GLOSSY,
        LobeKind::Mirror => Events::MIRROR,
        LobeKind::Refraction => Events::REFRACTION,
    }
}

impl<A: Accelerator> Tracer<'_, A> {
    /// The start of a path: its camera ray with the cone around it, its numbers, its filter weight.
    pub(crate) fn camera_ray(&self, pixel: [u32; 2], sample: u64) -> CameraStart {
        let key = self.sampler.path(pixel[0], pixel[1], sample);
        let (offset, weight) = self.filter.sample(self.sampler.two(key, Dimension::Film));
        let film = [0, 1].map(|k| offset[k] + (pixel[k] as f32 + 0.5));
        // The middle of the lens is a pinhole.
        let lens = match self.plan.pipeline.lens {
            true => self.sampler.two(key, Dimension::Lens),
            false => [0.5; 2],
        };
        let mut camera = self.camera.ray(film, lens);
        camera.ray.id = self.ray_id(key, 0, RayKind::Path);
        CameraStart { key, weight, camera }
    }
}

impl<'a, A> Tracer<'a, A> {
    /// The same paths on another accelerator, built from the same geometry.
    pub fn on<B>(&self, accelerator: &'a B) -> Tracer<'a, B> {
        let Self { world, camera, filter, plan, .. } = *self;
        let sampler = self.sampler.clone();
        Tracer { world, accelerator, camera, filter, sampler, plan }
    }

    /// Absorption coefficient of what begins behind this surface: its medium where the path enters, and nothing where it
    /// leaves.
    #[inline]
    fn absorption_beyond(&self, at: &SurfaceInteraction) -> Rgb {
        let absorbs = at.entering && self.plan.pipeline.absorption;
        let medium = absorbs.then(|| self.world.absorption(at.material)).flatten();
        medium.unwrap_or(Rgb::BLACK)
    }

    /// What hit filters know a ray by; 0 where no filter will ask.
    #[inline]
    fn ray_id(&self, key: SampleKey, bounce: u32, kind: RayKind) -> u32 {
        if self.plan.pipeline.hit_filter { key.ray_id(bounce, kind as u32) } else { 0 }
    }
}

/// A path vertex on a surface.
#[derive(Clone, Copy, Default)]
struct Vertex {
    /// Slot of its path.
    slot: u32,
    /// Whether its texture coordinates are known.
    is_detailed: bool,
    at: SurfaceInteraction,
    /// Direction back along the ray, in the shading frame.
    wo: Vec3,
}

/// What [`Tracer::camera_ray`] starts a path with.
pub(crate) struct CameraStart {
    pub(crate) key: SampleKey,
    pub(crate) weight: f32,
    pub(crate) camera: CameraRay,
}

/// Kinds of rays, so that a path's rays have different ids for hit filters.
#[derive(Clone, Copy, Debug)]
pub(crate) enum RayKind {
    /// Continues a path.
    Path = 0,
    /// Asks whether a light is visible.
    Shadow = 1,
}

/// Growth of the ray cone (radians) at a rough scattering: textures seen by scattered light are looked up
/// in coarser levels, far below the width of the scattering lobe itself.
const SCATTERED_SPREAD: f32 = 0.05;

/// What a medium leaves of light on a way of this length (Beer-Lambert).
#[inline]
fn transmittance(absorption: Rgb, distance: f32) -> Rgb {
    match absorption.is_black() {
        true => Rgb::WHITE,
        false => (absorption * -distance).map(fun::exp),
    }
}

/// The power heuristic with exponent 2 (Veach 1997, section 9.2.4): the weight of a sample that its
/// own strategy draws with density `own` and the other one with density `other`.
#[inline]
pub(crate) fn power_heuristic(own: f32, other: f32) -> f32 {
    // In ratios: squares of large densities would overflow.
    let ratio = other / own;
    1.0 / (1.0 + ratio * ratio)
}

/// Probability that a path of this throughput goes on past vertex `bounce` (0: the camera ray's hit).
///
/// Unbiased for any value above 0. Short paths always go on; long ones end sooner or later even in a
/// closed scene that absorbs nothing.
#[inline]
pub(crate) fn survival_probability(throughput: Rgb, eta_scale: f32, bounce: u32) -> f32 {
    const FREE_BOUNCES: u32 = 2;
    const SURE_BOUNCES: u32 = 16;
    if bounce < FREE_BOUNCES {
        return 1.0;
    }
    let cap = if bounce < SURE_BOUNCES { 1.0 } else { 0.95 };
    (throughput.max_channel() * eta_scale).clamp(0.05, cap)
}
