//! Sunlight scattered towards an observer, to all orders.
//!
//! Source: Hillaire, "A Scalable and Production Ready Sky and Atmosphere Rendering Technique", 2020:
//! single scattering is integrated along the path; what has been scattered before is taken to come
//! equally from all directions, and is found as a geometric series.

use super::atmosphere::{Atmosphere, GROUND, Path, Place, TOP};
use super::spectrum::{BANDS, Bands};
use crate::math::Vec3;
use crate::math::fun::double;
use crate::sampling::warp;
use rayon::prelude::{IntoParallelIterator, ParallelIterator};
use std::f32::consts::PI;

/// How much haze prefers to scatter forward (mean cosine); typical of continental aerosol.
const HAZE_ASYMMETRY: f32 = 0.75;

/// Light of the sky over a grey ground, for one height of the sun.
pub(super) struct Scattering<'a> {
    atmosphere: &'a Atmosphere,
    ground_albedo: f32,
    /// In-scattered radiance of the second and higher orders: rows by height, columns by the sun's angle.
    table: Vec<Bands>,
    /// The sun's elevation in the first column, radians.
    lowest: f64,
}

const HEIGHTS: usize = 8;
const ANGLES: usize = 12;
/// Along a ray to the horizon the vertical turns by no more than this, radians.
const TURN: f64 = 0.18;

impl<'a> Scattering<'a> {
    /// For observers near the ground who see the sun at `elevation` (radians).
    pub(super) fn new(atmosphere: &'a Atmosphere, ground_albedo: f32, elevation: f64) -> Self {
        let lowest = elevation - TURN;
        let mut scattering = Self { atmosphere, ground_albedo, table: Vec::new(), lowest };
        scattering.table = (0..HEIGHTS * ANGLES)
            .into_par_iter()
            .map(|i| {
                let height = (i / ANGLES) as f64 / (HEIGHTS - 1) as f64;
                let angle = lowest + 2.0 * TURN * (i % ANGLES) as f64 / (ANGLES - 1) as f64;
                scattering.multiple(GROUND + (TOP - GROUND) * height * height, double::sin(angle))
            })
            .collect();
        scattering
    }

    /// Radiance that arrives at the start of `path`, without the sun's own and the ground's.
    pub(super) fn radiance(&self, path: &Path) -> Bands {
        const STEPS: usize = 32;
        let cosine = path.cos_between as f32;
        // Rayleigh's phase function, and Henyey and Greenstein's.
        let air_phase = 3.0 / (16.0 * PI) * (1.0 + cosine * cosine);
        let g = HAZE_ASYMMETRY;
        let base = 1.0 + g * g - 2.0 * g * cosine;
        let haze_phase = (1.0 - g * g) / (4.0 * PI * base * base.sqrt());
        let source = |place: &Place| {
            let sun = self.atmosphere.sun_transmittance(place.radius, place.cos_sun);
            let multiple = self.interpolate(place.radius, place.cos_sun);
            let [air, haze] = &place.scattering;
            std::array::from_fn(|k| {
                sun[k] * (air[k] * air_phase + haze[k] * haze_phase)
                    + multiple[k] * (air[k] + haze[k])
            })
        };
        self.atmosphere.integrate(path, STEPS, source).0
    }

    /// Mean radiance, over all directions, of the light that was scattered at least once before it
    /// arrives at a point (Hillaire, equations 5 to 10).
    fn multiple(&self, radius: f64, cos_sun: f64) -> Bands {
        const DIRECTIONS: usize = 8;
        const STEPS: usize = 12;
        let sin_sun = (1.0 - cos_sun * cos_sun).max(0.0).sqrt();
        let sun = Vec3::new(sin_sun as f32, 0.0, cos_sun as f32);
        let total = |place: &Place| -> Bands {
            std::array::from_fn(|k| place.scattering[0][k] + place.scattering[1][k])
        };
        let single = |place: &Place| {
            let sun = self.atmosphere.sun_transmittance(place.radius, place.cos_sun);
            let scattering = total(place);
            std::array::from_fn(|k| sun[k] * scattering[k] / (4.0 * PI))
        };
        // Of light that has been scattered or reflected once, and of a unit of light in all the air.
        let (mut second_order, mut returned) = ([0.0; BANDS], [0.0; BANDS]);
        for i in 0..DIRECTIONS * DIRECTIONS {
            let stratum = |i: usize| (i as f32 + 0.5) / DIRECTIONS as f32;
            let direction = warp::sphere([stratum(i / DIRECTIONS), stratum(i % DIRECTIONS)]);
            let (cos_zenith, cos_between) = (direction.z.into(), direction.dot(sun).into());
            let path = Path { radius, cos_zenith, cos_sun, cos_between };
            let (once, transmittance) = self.atmosphere.integrate(&path, STEPS, single);
            let (unit, _) = self.atmosphere.integrate(&path, STEPS, total);
            let ground = self.ground(&path);
            for k in 0..BANDS {
                let weight = 1.0 / (DIRECTIONS * DIRECTIONS) as f32;
                second_order[k] += weight * (once[k] + transmittance[k] * ground[k]);
                returned[k] += weight * unit[k];
            }
        }
        std::array::from_fn(|k| second_order[k] / (1.0 - returned[k]))
    }

    /// Sunlight reflected where `path` meets the ground; black if it does not.
    fn ground(&self, path: &Path) -> Bands {
        let (_, cos_sun) = path.at(path.length());
        if !path.hits_ground() || cos_sun <= 0.0 {
            return [0.0; BANDS];
        }
        let reflected = self.ground_albedo / PI * cos_sun as f32;
        self.atmosphere.sun_transmittance(GROUND, cos_sun).map(|sun| sun * reflected)
    }

    /// The table between its nodes.
    fn interpolate(&self, radius: f64, cos_sun: f64) -> Bands {
        let height = ((radius - GROUND) / (TOP - GROUND)).max(0.0).sqrt();
        let angle = (double::asin(cos_sun.clamp(-1.0, 1.0)) - self.lowest) / (2.0 * TURN);
        let (row, y) = cell(height, HEIGHTS);
        let (column, x) = cell(angle, ANGLES);
        let start = row * ANGLES + column;
        let [a, b, c, d] = [start, start + 1, start + ANGLES, start + ANGLES + 1];
        std::array::from_fn(|k| {
            let value = |i: usize| self.table[i][k];
            (value(a) * (1.0 - x) + value(b) * x) * (1.0 - y)
                + (value(c) * (1.0 - x) + value(d) * x) * y
        })
    }
}

/// Which of the intervals between `nodes` nodes on [0, 1] a position is in, and how far.
fn cell(position: f64, nodes: usize) -> (usize, f32) {
    let scaled = position.clamp(0.0, 1.0) * (nodes - 1) as f64;
    let index = (scaled as usize).min(nodes - 2);
    (index, (scaled - index as f64) as f32)
}
