//! The rays of a bench, of every kind that a renderer traces, made once from the scene.
//!
//! They are a function of scene, cameras and count alone: all contestants trace the same ones, today and
//! tomorrow. Surfaces are grey and solid here: where a path goes next is a cosine-weighted choice.

use crate::error::Result;
use crate::geometry::{Hit, Ray};
use crate::math::{Frame, Vec3};
use crate::sampling::{CounterRng, warp};
use crate::scene;
use crate::world::World;
use rand::seq::SliceRandom;

/// What rays are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RayKind {
    /// From the cameras, in tiles of 4x4 pixels.
    Primary,
    /// From what those hit, diffusely onward, in the order of the pixels.
    FirstBounce,
    /// From the third surface of such paths, diffusely onward, shuffled.
    DeepBounce,
    /// From the first surfaces to a small light, and to the sky; any hit counts.
    Shadow,
    /// From the first surfaces, diffusely, a tenth of the scene far; any hit counts.
    AmbientOcclusion,
    /// Between random points of the scene's box and random directions.
    Random,
}

/// What is asked about a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Query {
    /// Which surface is met first.
    Closest,
    /// Whether any surface is met.
    AnyHit,
}

impl RayKind {
    /// Every kind with its name.
    pub const ALL: [(&'static str, Self); 6] = [
        ("primary", Self::Primary),
        ("first-bounce", Self::FirstBounce),
        ("deep-bounce", Self::DeepBounce),
        ("shadow", Self::Shadow),
        ("ambient-occlusion", Self::AmbientOcclusion),
        ("random", Self::Random),
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        Self::ALL[self as usize].0
    }

    /// What is asked about such rays.
    pub fn query(self) -> Query {
        match self {
            Self::Primary | Self::FirstBounce | Self::DeepBounce | Self::Random => Query::Closest,
            Self::Shadow | Self::AmbientOcclusion => Query::AnyHit,
        }
    }
}

/// Rays of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct RaySet {
    /// Which.
    pub kind: RayKind,
    /// In the order in which they are traced. May be fewer than asked for, or none, where the scene has no
    /// place for them.
    pub rays: Vec<Ray>,
}

/// Where rays come from.
pub struct RaySource<'a> {
    /// The scene.
    pub world: &'a World,
    /// Whose pictures the rays are for, each getting an equal share; at least one.
    pub cameras: &'a [scene::Camera],
    /// The closest hits of rays, by a backend that is trusted.
    pub closest: &'a dyn Fn(&[Ray]) -> Vec<Hit>,
}

/// A ray that has met a surface.
type Met = (Ray, Hit);

/// Paths are begun this many times a pixel before the search for deep ones ends.
const MOST_PASSES: u64 = 16;

impl RaySource<'_> {
    /// `count` rays of each kind.
    ///
    /// # Errors
    /// Where a camera is impossible.
    pub fn generate(&self, kinds: &[RayKind], count: usize) -> Result<Vec<RaySet>> {
        let primary = self.primary(count)?;
        let first = self.met(&primary);
        let set = |&kind: &RayKind| {
            let mut rng = CounterRng::new(kind as u64);
            let mut rays = match kind {
                RayKind::Primary => primary.clone(),
                RayKind::FirstBounce => {
                    let places = first.iter().cycle().take(count);
                    places.map(|met| bounce(met, &mut rng)).collect()
                }
                RayKind::DeepBounce => self.deep_bounce(&first, count, &mut rng),
                RayKind::Shadow => self.shadow(&first, count, &mut rng),
                RayKind::AmbientOcclusion => {
                    let t_max = 0.2 * self.world.bounds.bounding_radius();
                    let places = first.iter().cycle().take(count);
                    places.map(|met| Ray { t_max, ..bounce(met, &mut rng) }).collect()
                }
                RayKind::Random => self.random(count, &mut rng),
            };
            rays.iter_mut().zip(0..).for_each(|(ray, id)| ray.id = id);
            RaySet { kind, rays }
        };
        Ok(kinds.iter().map(set).collect())
    }

    /// Tile by tile, each pixel a tile of 4x4.
    fn primary(&self, count: usize) -> Result<Vec<Ray>> {
        let mut rng = CounterRng::new(RayKind::Primary as u64);
        let mut rays = Vec::with_capacity(count);
        for (camera, end) in self.cameras.iter().zip(1..) {
            // So many tiles in a picture of 16:9, rounded up.
            let end = count * end / self.cameras.len();
            let tiles = (end - rays.len()).div_ceil(16) as u32;
            let high = (f64::from(tiles) * 9.0 / 16.0).sqrt().ceil().max(1.0) as u32;
            let wide = tiles.div_ceil(high).max(1);
            let camera = self.world.camera(camera, [4 * wide, 4 * high])?;
            let pixels = (0..16 * wide * high).map(|i| {
                let (tile, pixel) = (i / 16, i % 16);
                [4 * (tile % wide) + pixel % 4, 4 * (tile / wide) + pixel / 4]
            });
            for [x, y] in pixels.take(end - rays.len()) {
                let film = [x as f32 + rng.unit(), y as f32 + rng.unit()];
                rays.push(camera.ray(film, [rng.unit(), rng.unit()]).ray);
            }
        }
        Ok(rays)
    }

    /// Those of the rays that meet a surface.
    fn met(&self, rays: &[Ray]) -> Vec<Met> {
        let hits = (self.closest)(rays);
        let pairs = rays.iter().copied().zip(hits);
        pairs.filter(|(_, hit)| hit.is_hit()).collect()
    }

    fn deep_bounce(&self, first: &[Met], count: usize, rng: &mut CounterRng) -> Vec<Ray> {
        let mut rays: Vec<Ray> = Vec::with_capacity(count);
        for _ in 0..MOST_PASSES {
            if rays.len() >= count {
                break;
            }
            let mut onward = |met: &[Met]| met.iter().map(|m| bounce(m, rng)).collect::<Vec<_>>();
            let second = self.met(&onward(first));
            let third = self.met(&onward(&second));
            rays.extend(onward(&third));
        }
        rays.truncate(count);
        rays.shuffle(rng);
        rays
    }

    /// The first half to points of a small spherical light, the second half to points of the sky.
    fn shadow(&self, first: &[Met], count: usize, rng: &mut CounterRng) -> Vec<Ray> {
        let (center, radius) = (self.world.bounds.center(), self.world.bounds.bounding_radius());
        let lamp = center + 1.5 * radius * Vec3::new(0.4, 0.8, 0.45);
        let mut rays = Vec::with_capacity(count);
        for (middle, size, end) in [(lamp, 0.05 * radius, count / 2), (center, 2.0 * radius, count)]
        {
            // As in a renderer, no ray goes where its own surface faces away: most scenes need two attempts.
            for met in first.iter().cycle().take(4 * count) {
                if rays.len() == end {
                    break;
                }
                let (origin, normal) = leave(met);
                let light = middle + size * warp::sphere([rng.unit(), rng.unit()]);
                if normal.dot(light - origin) > 0.0 {
                    rays.push(Ray::between(origin, light));
                }
            }
        }
        rays
    }

    fn random(&self, count: usize, rng: &mut CounterRng) -> Vec<Ray> {
        let (min, extent) = (self.world.bounds.min, self.world.bounds.extent());
        let mut ray = || {
            let origin = min + extent * Vec3::new(rng.unit(), rng.unit(), rng.unit());
            Ray::new(origin, warp::sphere([rng.unit(), rng.unit()]))
        };
        (0..count).map(|_| ray()).collect()
    }
}

/// Where a ray that leaves a surface on the side from which it was met starts, and the normal of that side.
fn leave((ray, hit): &Met) -> (Vec3, Vec3) {
    let normal = if hit.normal.dot(ray.direction) > 0.0 { -hit.normal } else { hit.normal };
    (hit.point + hit.offset * normal, normal)
}

/// Onward from a surface, cosine-weighted.
fn bounce(met: &Met, rng: &mut CounterRng) -> Ray {
    let (origin, normal) = leave(met);
    let local = warp::cosine_hemisphere([rng.unit(), rng.unit()]);
    Ray::new(origin, Frame::from_normal(normal).world_from_local(local))
}
