//! The state of one path between two stages of the wavefront.

use super::CameraStart;
use crate::geometry::{PrimitiveId, Ray};
use crate::math::Rgb;
use crate::sampling::PathSampler;

/// State of one path; it stays in its slot while it lives.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Path {
    /// The ray to be traced next.
    pub(super) ray: Ray,
    /// Product of the scattering weights so far.
    pub(super) throughput: Rgb,
    /// Radiance gathered so far.
    pub(super) radiance: Rgb,
    /// Its random numbers.
    pub(super) sampler: PathSampler,
    /// Vertices so far: the next hit is vertex number `bounce`.
    pub(super) bounce: u32,
    /// Density per solid angle with which the ray's direction was scattered.
    pub(super) pdf_solid_angle: f32,
    /// Whether light sampling could not have found the ray's direction: its emission counts in full.
    pub(super) is_delta: bool,
    /// Undoes the radiance factor of refractions for Russian roulette.
    pub(super) eta_scale: f32,
    /// Width of the ray cone at the ray's origin.
    pub(super) cone_width: f32,
    /// Growth of the cone's width per unit length.
    pub(super) cone_spread: f32,
    /// Absorption coefficient of what the ray runs through.
    pub(super) absorption: Rgb,
    /// Where it began.
    pub(super) pixel: [u32; 2],
    /// Which of the pixel's samples it is.
    pub(super) sample: u64,
    /// Filter weight.
    pub(super) weight: f32,
    /// 1 once the camera ray has met a surface.
    pub(super) coverage: f32,
    /// The surface that the ray left or met last.
    pub(super) last_hit: PrimitiveId,
}

impl Path {
    /// The path that starts with a camera ray.
    #[inline]
    pub(super) fn begin(start: &CameraStart, pixel: [u32; 2], sample: u64) -> Self {
        Self {
            ray: start.camera.ray,
            throughput: Rgb::WHITE,
            radiance: Rgb::BLACK,
            sampler: start.sampler,
            bounce: 0,
            pdf_solid_angle: 0.0,
            // No light is sampled for the camera: what it sees counts in full.
            is_delta: true,
            eta_scale: 1.0,
            cone_width: start.camera.initial_width,
            cone_spread: start.camera.spread,
            absorption: Rgb::BLACK,
            pixel,
            sample,
            weight: start.weight,
            coverage: 0.0,
            last_hit: PrimitiveId::MISS,
        }
    }
}
