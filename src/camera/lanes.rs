//! Rays of `N` film positions at once: loops that the compiler turns into vector instructions.
//!
//! Each lane holds what [`Camera::ray`] gives, by the same functions. Meant to be called from inside kernels
//! (`os::Kernel`), so everything here is inlined.

use super::{Camera, CameraRay, Projection};
use crate::geometry::Ray;
use crate::math::Vec3;

/// [`CameraRay`]s as one array a field.
#[derive(Clone, Debug)]
pub struct CameraRays<const N: usize> {
    origin: [[f32; N]; 3],
    direction: [[f32; N]; 3],
    spread: [f32; N],
    initial_width: [f32; N],
}

impl<const N: usize> CameraRays<N> {
    /// The ray of one lane.
    #[inline(always)]
    pub fn lane(&self, i: usize) -> CameraRay {
        let vector = |v: &[[f32; N]; 3]| Vec3::new(v[0][i], v[1][i], v[2][i]);
        CameraRay {
            ray: Ray::new(vector(&self.origin), vector(&self.direction)),
            spread: self.spread[i],
            initial_width: self.initial_width[i],
        }
    }

    /// No rays yet.
    pub const NONE: Self = Self {
        origin: [[0.0; N]; 3],
        direction: [[0.0; N]; 3],
        spread: [0.0; N],
        initial_width: [0.0; N],
    };

    #[inline(always)]
    fn set(&mut self, i: usize, CameraRay { ray, spread, initial_width }: CameraRay) {
        for k in 0..3 {
            self.origin[k][i] = ray.origin[k];
            self.direction[k][i] = ray.direction[k];
        }
        self.spread[i] = spread;
        self.initial_width[i] = initial_width;
    }
}

impl Camera {
    /// [`Camera::ray`] of every lane, to `rays`. `lens` is ignored unless [`Camera::needs_lens`].
    #[inline(always)]
    pub fn rays<const N: usize>(
        &self,
        [film_x, film_y]: &[[f32; N]; 2],
        [lens_x, lens_y]: &[[f32; N]; 2],
        rays: &mut CameraRays<N>,
    ) {
        let basis = &self.basis;
        // The projection is chosen outside the loops, so that each is straight. (A macro, because closures
        // cannot be made to be inlined.)
        macro_rules! each_lane {
            ($i:ident => $ray:expr) => {
                for $i in 0..N {
                    rays.set($i, $ray);
                }
            };
        }
        match self.projection {
            Projection::Perspective(p) if p.has_lens() => each_lane!(i => {
                p.ray_through_lens(basis, [film_x[i], film_y[i]], [lens_x[i], lens_y[i]])
            }),
            Projection::Perspective(p) => {
                each_lane!(i => p.ray_of_pinhole(basis, [film_x[i], film_y[i]]));
            }
            Projection::Orthographic(p) => each_lane!(i => p.ray(basis, [film_x[i], film_y[i]])),
            Projection::Panoramic(p) => each_lane!(i => p.ray(basis, [film_x[i], film_y[i]])),
        }
    }
}
