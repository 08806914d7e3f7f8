//! Albedo of reflection from rough interfaces, isotropic and anisotropic, with any Fresnel factor.
//!
//! Source: this module's [`super`]; the anisotropic tables have the azimuth and the aspect as further
//! coordinates and are made only when an anisotropic surface is met.

use super::super::fresnel;
use super::super::grid::Grid;
use super::super::microfacet::Ggx;
use super::{
    alpha_at, cosine_at, cosine_coordinate, direction, hemisphere_mean, roughness_coordinate,
    visible_mean,
};
use crate::math::{Vec3, fun};
use std::sync::LazyLock;

/// What a rough interface of reflectance 1 scatters at the first bounce.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Single {
    /// Its albedo E.
    pub(in super::super) white: f32,
    /// The cosine at which Schlick's Fresnel factor takes its mean over the scattered light.
    pub(in super::super) cos_fresnel: f32,
}

impl Single {
    /// Of the interface `ggx` (`None`: smooth) seen from `w`, w.z > 0.
    #[inline]
    pub(in super::super) fn new(ggx: Option<&Ggx>, w: Vec3) -> Self {
        match ggx {
            None => Self { white: 1.0, cos_fresnel: w.z },
            Some(ggx) if ggx.alpha_x == ggx.alpha_y => Self::from_table(
                ISOTROPIC.directional.get(isotropic_coordinates(ggx.alpha_x, w)),
                w,
            ),
            Some(ggx) => {
                Self::from_table(ANISOTROPIC.directional.get(anisotropic_coordinates(ggx, w)), w)
            }
        }
    }

    /// Tables hold the cosine as its difference from that of the direction, which is smooth and small.
    #[inline]
    fn from_table([white, shift]: [f32; 2], w: Vec3) -> Self {
        Self { white, cos_fresnel: w.z + shift }
    }

    /// By integration, in the form of the tables.
    fn integrate(ggx: &Ggx, wo: Vec3) -> [f32; 2] {
        let [white, schlick] = visible_mean(ggx, wo, |h| {
            let wi = fresnel::reflect(wo, h);
            let weight = if wi.z > 0.0 { ggx.shadowing(wo, wi) } else { 0.0 };
            [weight, weight * fresnel::schlick_weight(wo.dot(h))]
        });
        [white, 1.0 - fun::pow(schlick / white, 0.2) - wo.z]
    }

    /// Albedo with the Fresnel factor f0 + (f90 - f0) (1 - cos)^5.
    #[inline]
    pub(in super::super) fn schlick(self, f0: f32, f90: f32) -> f32 {
        self.white * (f0 + (f90 - f0) * fresnel::schlick_weight(self.cos_fresnel))
    }
}

/// Cosine-weighted hemispherical means of the albedo with the Fresnel factors 1 and (1 - cos)^5.
#[inline]
pub(in super::super) fn single_mean(ggx: Option<&Ggx>) -> [f32; 2] {
    match ggx {
        // The integral of 2 cos (1 - cos)^5 is 1/21.
        None => [1.0, 1.0 / 21.0],
        Some(ggx) if ggx.alpha_x == ggx.alpha_y => {
            ISOTROPIC.mean.get([roughness_coordinate(ggx.alpha_x)])
        }
        Some(ggx) => {
            let [_, along, aspect, _] = anisotropic_coordinates(ggx, Vec3::Z);
            ANISOTROPIC.mean.get([along, aspect])
        }
    }
}

/// Tables of a family of lobes: directional, and the two means of [`single_mean`].
struct Tables<const DIRECTIONAL: usize, const MEAN: usize> {
    directional: Grid<DIRECTIONAL, 2>,
    mean: Grid<MEAN, 2>,
}

/// The means are tabulated more finely than the directional albedos: they divide by what remains of 1, which
/// grows with the fourth power of the roughness, and must match the mean of the interpolated values.
const MEAN_NODES: usize = 65;

/// Isotropic lobes over (cosine, roughness).
static ISOTROPIC: LazyLock<Tables<2, 1>> = LazyLock::new(|| {
    let lobe = |r| Ggx { alpha_x: alpha_at(r), alpha_y: alpha_at(r) };
    let directional = Grid::new([33, 25], |[c, r]| {
        let ggx = lobe(r);
        Single::integrate(&ggx, direction(cosine_at(c, ggx.alpha_x), 1.0))
    });
    let mean = Grid::new([MEAN_NODES], |[r]| {
        let alpha = alpha_at(r);
        mean_over_azimuths(1, |w| {
            Single::from_table(directional.get(isotropic_coordinates(alpha, w)), w)
        })
    });
    Tables { directional, mean }
});

/// Anisotropic lobes over (cosine, roughness along the highlight, aspect, azimuth), and their means over
/// (roughness, aspect).
static ANISOTROPIC: LazyLock<Tables<4, 2>> = LazyLock::new(|| {
    let lobe = |r: f32, aspect: f32| {
        let along = alpha_at(r);
        Ggx { alpha_x: along, alpha_y: along * (1.0 - 0.9 * aspect) }
    };
    let directional = Grid::new([15, 13, 5, 5], |[c, r, aspect, cos_phi]| {
        let (ggx, cos2_phi) = (lobe(r, aspect), cos_phi * cos_phi);
        let cos = cosine_at(c, projected_alpha(&ggx, cos2_phi));
        Single::integrate(&ggx, direction(cos, cos2_phi))
    });
    let mean = Grid::new([MEAN_NODES, 9], |[r, aspect]| {
        let ggx = lobe(r, aspect);
        mean_over_azimuths(4, |w| {
            Single::from_table(directional.get(anisotropic_coordinates(&ggx, w)), w)
        })
    });
    Tables { directional, mean }
});

/// The two means of a tabulated lobe, over `azimuths` azimuths of a quarter turn.
fn mean_over_azimuths(azimuths: u32, single: impl Fn(Vec3) -> Single) -> [f32; 2] {
    let mut sum = [0.0; 2];
    for i in 0..azimuths {
        let (_, cos_phi) = fun::sin_cos_turns((i as f32 + 0.5) / (4 * azimuths) as f32);
        let means = hemisphere_mean(32, |cos| {
            let single = single(direction(cos, cos_phi * cos_phi));
            [single.white, single.schlick(0.0, 1.0)]
        });
        sum = [sum[0] + means[0], sum[1] + means[1]];
    }
    sum.map(|sum| sum / azimuths as f32)
}

#[inline]
fn isotropic_coordinates(alpha: f32, w: Vec3) -> [f32; 2] {
    [cosine_coordinate(w.z, alpha), roughness_coordinate(alpha)]
}

/// The lobe is turned so that its rougher axis is x.
#[inline]
fn anisotropic_coordinates(ggx: &Ggx, w: Vec3) -> [f32; 4] {
    let (x2, y2) = (w.x * w.x, w.y * w.y);
    // Any azimuth does at the pole.
    let cos2_phi = if x2 + y2 > 0.0 { x2 / (x2 + y2) } else { 0.5 };
    let cos = cosine_coordinate(w.z, projected_alpha(ggx, cos2_phi));
    let (along, across, azimuth) = if ggx.alpha_x >= ggx.alpha_y {
        (ggx.alpha_x, ggx.alpha_y, cos2_phi)
    } else {
        (ggx.alpha_y, ggx.alpha_x, 1.0 - cos2_phi)
    };
    [cos, roughness_coordinate(along), (1.0 - across / along) / 0.9, azimuth.max(0.0).sqrt()]
}

/// Alpha as seen along an azimuth.
#[inline]
fn projected_alpha(ggx: &Ggx, cos2_phi: f32) -> f32 {
    let (x, y) = (ggx.alpha_x * ggx.alpha_x, ggx.alpha_y * ggx.alpha_y);
    (x * cos2_phi + y * (1.0 - cos2_phi)).sqrt()
}
