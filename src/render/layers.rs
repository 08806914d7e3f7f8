//! Extra layers (AOVs): a pass of its own over the camera rays, before any path is traced.
//!
//! Ids, depth, position and normal come from sample 0, so they are unfiltered and reproducible; albedo is
//! the mean over the first samples.

use super::thread_pool;
use crate::accel::{Accelerator, AcceptAll, HitFilter};
use crate::error::Result;
use crate::film::Region;
use crate::geometry::NONE;
use crate::image::Samples;
use crate::math::{Rgb, Vec3};
use crate::trace::{FirstHit, Tracer, first_hit};
use crate::world::CutOuts;
use rayon::prelude::*;

/// The layers that can be asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Aov {
    /// Shading normal towards the camera.
    Normal,
    /// Share of light that the surface scatters.
    Albedo,
    /// Distance along the ray; infinite where nothing is hit.
    Depth,
    /// Position relative to the origin that the header names.
    Position,
    /// Texture coordinates.
    Uv,
    /// Numbers of the instance, the mesh and the triangle; all ones where there is none.
    Primitive,
    /// Number of the material; all ones where nothing is hit.
    Material,
    /// Samples taken.
    Samples,
    /// Variance of the pixel's mean.
    Variance,
}

impl Aov {
    /// Every layer with its name on the command line and in the EXR.
    pub const ALL: [(&'static str, Self); 9] = [
        ("normal", Self::Normal),
        ("albedo", Self::Albedo),
        ("depth", Self::Depth),
        ("position", Self::Position),
        ("uv", Self::Uv),
        ("primitive", Self::Primitive),
        ("material", Self::Material),
        ("samples", Self::Samples),
        ("variance", Self::Variance),
    ];
}

/// First hits of all pixels of a region, row-major.
#[derive(Clone, Debug)]
pub struct Layers {
    /// Of sample 0.
    hits: Vec<Option<FirstHit>>,
    albedo: Vec<Rgb>,
}

/// Samples over which the albedo is averaged.
const ALBEDO_SAMPLES: u64 = 16;

/// Traces the camera rays of the first samples of every pixel.
///
/// # Errors
/// When the thread pool cannot be made.
pub fn render_layers<A: Accelerator>(
    tracer: &Tracer<'_, A>,
    region: Region,
    samples_per_pixel: u64,
    threads: usize,
) -> Result<Layers> {
    if tracer.plan.pipeline.hit_filter {
        run(tracer, &CutOuts::new(tracer.world), region, samples_per_pixel, threads)
    } else {
        run(tracer, &AcceptAll, region, samples_per_pixel, threads)
    }
}

fn run<A: Accelerator, F: HitFilter>(
    tracer: &Tracer<'_, A>,
    filter: &F,
    region: Region,
    samples_per_pixel: u64,
    threads: usize,
) -> Result<Layers> {
    let pixels: Vec<[u32; 2]> = region.iter().collect();
    let samples = samples_per_pixel.clamp(1, ALBEDO_SAMPLES);
    let (hits, albedo) = thread_pool(threads)?.install(|| {
        pixels
            .par_iter()
            .map(|&pixel| {
                let first = first_hit(tracer, filter, pixel, 0);
                let of = |hit: Option<FirstHit>| hit.map_or(Rgb::BLACK, |h| h.albedo);
                let rest = (1..samples).map(|s| of(first_hit(tracer, filter, pixel, s)));
                let sum = rest.fold(of(first), |a, b| a + b);
                (first, sum / samples as f32)
            })
            .unzip()
    });
    Ok(Layers { hits, albedo })
}

impl Layers {
    /// The channels of a layer that the camera rays give: (channel name, values row-major). `Samples` and
    /// `Variance` are the film's and have none here.
    pub fn channels(&self, aov: Aov) -> Vec<(&'static str, Samples)> {
        match aov {
            Aov::Normal => self.xyz(|h| h.normal),
            Aov::Position => self.xyz(|h| h.point),
            Aov::Depth => vec![("Z", self.floats(f32::INFINITY, |h| h.depth))],
            Aov::Uv => {
                vec![("U", self.floats(0.0, |h| h.uv[0])), ("V", self.floats(0.0, |h| h.uv[1]))]
            }
            Aov::Albedo => ["R", "G", "B"]
                .into_iter()
                .enumerate()
                .map(|(c, name)| (name, Samples::Float(self.albedo.iter().map(|a| a[c]).collect())))
                .collect(),
            Aov::Primitive => vec![
                ("geometry", self.ids(|h| h.id.geometry)),
                ("instance", self.ids(|h| h.id.instance)),
                ("primitive", self.ids(|h| h.id.primitive)),
            ],
            Aov::Material => vec![("id", self.ids(|h| h.material.0))],
            Aov::Samples | Aov::Variance => Vec::new(),
        }
    }

    fn floats(&self, miss: f32, of: impl Fn(&FirstHit) -> f32) -> Samples {
        Samples::Float(self.hits.iter().map(|hit| hit.as_ref().map_or(miss, &of)).collect())
    }

    fn xyz(&self, of: impl Fn(&FirstHit) -> Vec3) -> Vec<(&'static str, Samples)> {
        vec![
            ("X", self.floats(0.0, |h| of(h).x)),
            ("Y", self.floats(0.0, |h| of(h).y)),
            ("Z", self.floats(0.0, |h| of(h).z)),
        ]
    }

    /// Identifiers; all ones where there is none.
    fn ids(&self, of: impl Fn(&FirstHit) -> u32) -> Samples {
        Samples::Uint(self.hits.iter().map(|hit| hit.as_ref().map_or(NONE, &of)).collect())
    }
}
