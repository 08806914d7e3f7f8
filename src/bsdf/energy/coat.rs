//! What a clear coat takes from the light that a rough base scatters to directions of higher reflectance.

use super::super::fresnel;
use super::super::grid::Grid;
use super::super::microfacet::Ggx;
use super::{
    Single, alpha_at, cosine_at, cosine_coordinate, direction, roughness_coordinate, visible_mean,
};
use crate::math::Vec3;
use std::sync::LazyLock;

/// Reflectance of a clear coat (eta = 1.5) at normal incidence.
pub(in super::super) const COAT_F0: f32 = 0.04;

/// With e the albedo of the coat, the mean of max(e(wi) - e(wo), 0) over the light singly scattered by `base`
/// from `wo`; 0 for a smooth base, which scatters to the same cosine. An anisotropic base counts as the
/// isotropic one of the same highlight area.
#[inline]
pub(in super::super) fn coat_excess(base: Option<&Ggx>, coat: Option<&Ggx>, wo: Vec3) -> f32 {
    let Some(base) = base else {
        return 0.0;
    };
    let alpha = (base.alpha_x * base.alpha_y).sqrt();
    let coat = coat.map_or(0.0, |coat| roughness_coordinate(coat.alpha_x));
    let [excess] = EXCESS.get([cosine_coordinate(wo.z, alpha), roughness_coordinate(alpha), coat]);
    excess
}

/// Over (cosine, roughness of the base, roughness of the coat).
static EXCESS: LazyLock<Grid<3, 1>> = LazyLock::new(|| {
    Grid::new([15, 13, 7], |[c, r, coat]| {
        let lobe = |alpha| Ggx { alpha_x: alpha, alpha_y: alpha };
        let (base, coat) = (lobe(alpha_at(r)), lobe(alpha_at(coat)));
        let wo = direction(cosine_at(c, base.alpha_x), 1.0);
        let reflectance = |w| Single::new(Some(&coat), w).schlick(COAT_F0, 1.0);
        let from_o = reflectance(wo);
        let [white, excess] = visible_mean(&base, wo, |h| {
            let wi = fresnel::reflect(wo, h);
            if wi.z <= 0.0 {
                return [0.0; 2];
            }
            let weight = base.shadowing(wo, wi);
            [weight, weight * (reflectance(wi) - from_o).max(0.0)]
        });
        [excess / white]
    })
});
