//! What the camera sees first: positions, normals, ids and albedo for the extra layers of an image.

use super::Tracer;
use crate::accel::{Accelerator, HitFilter};
use crate::bsdf::Scatter;
use crate::geometry::{Hit, PrimitiveId};
use crate::math::{Rgb, Vec3};
use crate::scene::MaterialId;

/// The first surface that is not cut out, along one camera ray.
#[derive(Clone, Copy, Debug)]
pub struct FirstHit {
    /// Distance along the ray from the camera.
    pub depth: f32,
    /// Relative to the world origin.
    pub point: Vec3,
    /// Shading normal, towards the camera.
    pub normal: Vec3,
    /// Texture coordinates.
    pub uv: [f32; 2],
    /// Share of light that the surface scatters.
    pub albedo: Rgb,
    /// Which primitive.
    pub id: PrimitiveId,
    /// Which material.
    pub material: MaterialId,
}

/// The first hit of one sample of one pixel; `None` where the camera sees the background.
pub fn first_hit<A: Accelerator, F: HitFilter>(
    tracer: &Tracer<'_, A>,
    filter: &F,
    pixel: [u32; 2],
    sample: u64,
) -> Option<FirstHit> {
    let start = tracer.camera_ray(pixel, sample);
    let mut hit = [Hit::MISS];
    tracer.accelerator.closest(&[start.camera.ray], filter, &mut hit);
    let [hit] = hit;
    if !hit.is_hit() {
        return None;
    }
    let at = tracer.world.interact(
        &start.camera.ray,
        &hit,
        start.camera.initial_width + start.camera.spread * hit.t,
        true,
    );
    let wo = at.frame.local_from_world(-start.camera.ray.direction);
    Some(FirstHit {
        depth: hit.t,
        point: at.point,
        normal: at.frame.normal,
        uv: at.uv,
        albedo: tracer.world.bsdf(&at).albedo(wo),
        id: hit.id,
        material: at.material,
    })
}
