//! Energy of rough interfaces: how much single scattering keeps, so that a second lobe can return the rest.
//!
//! Microfacets that shadow each other lose what bounces more than once. Following C. Kulla and A. Conty,
//! "Revisiting Physically Based Shading at Imageworks" (SIGGRAPH course, 2017), the loss K(w) = 1 - E(w)
//! comes back as the separable, hence reciprocal, lobe K(wo) K(wi) / (pi mean(K)), whose albedo is K(wo).
//!
//! The albedos E are tabulated at first use, only those that a scene needs (CPU time on a 2020s core: isotropic
//! 4 ms, coat excess 15 ms, dielectric 25 ms, anisotropic 30 ms), by integrating with the very routine that
//! samples when rendering; no data come from elsewhere. What interpolation leaves of the error is measured by
//! the white furnaces of `tests/it/bsdf.rs`: 0.1 % isotropic, 0.4 % anisotropic or leaving glass.
//!
//! This file holds what the tables share: the quadrature and the coordinates.

mod coat;
mod dielectric;
mod reflection;

pub(super) use coat::{COAT_F0, coat_excess};
pub(super) use dielectric::{coat_mean, dielectric_loss, dielectric_loss_mean, reflection_albedo};
pub(super) use reflection::{Single, single_mean};

use super::microfacet::{Ggx, SMOOTH_ALPHA};
use crate::math::{Vec3, fun};
use std::f32::consts::FRAC_1_PI;
use std::sync::LazyLock;

/// A node of a quadrature rule on the square of random numbers.
struct Node {
    sin_cos: (f32, f32),
    v: f32,
    weight: f32,
}

/// Fibonacci lattice: one coordinate regular and squared, to crowd the tail of the distribution, the other
/// its golden rotation. Error of an albedo below 0.001.
static LATTICE: LazyLock<Vec<Node>> = LazyLock::new(|| {
    let (n, generator) = (233, 144);
    let node = |i: usize| {
        let x = (i as f32 + 0.5) / n as f32;
        Node {
            sin_cos: fun::sin_cos_turns(((i * generator) % n) as f32 / n as f32),
            v: 1.0 - x * x,
            weight: 2.0 * x / n as f32,
        }
    };
    (0..n).map(node).collect()
});

/// Mean of `f(h)` over the normals visible from `wo`.
fn visible_mean<const N: usize>(ggx: &Ggx, wo: Vec3, f: impl Fn(Vec3) -> [f32; N]) -> [f32; N] {
    let mut sum = [0.0; N];
    for node in LATTICE.iter() {
        let values = f(ggx.visible_normal(wo, node.sin_cos, node.v));
        for (sum, value) in sum.iter_mut().zip(values) {
            *sum += node.weight * value;
        }
    }
    sum
}

/// Cosine-weighted mean over the hemisphere of an `f` of the cosine alone. The intervals crowd at grazing
/// angles, as losses do; nodes and weights make linear functions exact.
#[inline]
pub(super) fn hemisphere_mean<const N: usize>(
    nodes: u16,
    mut f: impl FnMut(f32) -> [f32; N],
) -> [f32; N] {
    let mut sum = [0.0; N];
    let mut low = 0.0;
    for i in 1..=nodes {
        let x = f32::from(i) / f32::from(nodes);
        let high = x * x;
        // Weight 2 cos dcos of the interval, and its centre of mass.
        let weight = (high - low) * (high + low);
        let centre = 2.0 / 3.0 * (low + high * high / (low + high));
        for (sum, value) in sum.iter_mut().zip(f(centre)) {
            *sum += weight * value;
        }
        low = high;
    }
    sum
}

/// A direction of the upper hemisphere for a separable lobe: density [`spread_pdf`], linear in the cosine;
/// `grazing` in [0, 1] turns it from cosine-weighted (0) to uniform (1).
#[inline]
pub(super) fn sample_spread([u, v]: [f32; 2], grazing: f32) -> Vec3 {
    // Inverse of the distribution function grazing cos + (1 - grazing) cos^2.
    let root = (grazing * grazing + 4.0 * (1.0 - grazing) * u).sqrt();
    let cos = if u > 0.0 { (2.0 * u / (grazing + root)).min(1.0) } else { 0.0 };
    let sin = ((1.0 - cos) * (1.0 + cos)).sqrt();
    let (sin_phi, cos_phi) = fun::sin_cos_turns(v);
    Vec3::new(sin * cos_phi, sin * sin_phi, cos)
}

/// Density of [`sample_spread`] over solid angle.
#[inline]
pub(super) fn spread_pdf(cos_theta: f32, grazing: f32) -> f32 {
    (0.5 * grazing + (1.0 - grazing) * cos_theta) * FRAC_1_PI
}

/// The `grazing` of [`sample_spread`] that suits the losses of a lobe: they gather at grazing angles when it
/// is narrow.
#[inline]
pub(super) fn loss_grazing(ggx: &Ggx) -> f32 {
    let smoothness = 1.0 - ggx.alpha_x.max(ggx.alpha_y);
    smoothness * smoothness
}

/// Table coordinate of the roughness: perceptual, from the smoothest rough surface to alpha = 1.
#[inline]
fn roughness_coordinate(alpha: f32) -> f32 {
    let smoothest = SMOOTH_ALPHA.sqrt();
    (alpha.sqrt() - smoothest) / (1.0 - smoothest)
}

/// Inverse of [`roughness_coordinate`].
fn alpha_at(coordinate: f32) -> f32 {
    let smoothest = SMOOTH_ALPHA.sqrt();
    let roughness = smoothest + coordinate * (1.0 - smoothest);
    roughness * roughness
}

/// Table coordinate of a cosine: two thirds resolve the grazing layer cos ~ alpha, where shadowing acts, and
/// one third the cosine itself.
#[inline]
fn cosine_coordinate(cos_theta: f32, alpha: f32) -> f32 {
    let layer = cos_theta * (1.0 + 4.0 * alpha) / (cos_theta + 4.0 * alpha);
    (2.0 * layer.sqrt() + cos_theta) / 3.0
}

/// Inverse of [`cosine_coordinate`] by bisection (set-up only); never 0, where directions have no side.
fn cosine_at(coordinate: f32, alpha: f32) -> f32 {
    let (mut low, mut high) = (1e-6, 1.0);
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        if cosine_coordinate(middle, alpha) < coordinate {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

/// The unit vector with this cosine; its azimuth is given by the square of its cosine.
pub(super) fn direction(cos_theta: f32, cos2_phi: f32) -> Vec3 {
    let sin_theta = ((1.0 - cos_theta) * (1.0 + cos_theta)).max(0.0).sqrt();
    let (x, y) = (cos2_phi.sqrt(), (1.0 - cos2_phi).max(0.0).sqrt());
    Vec3::new(sin_theta * x, sin_theta * y, cos_theta)
}
