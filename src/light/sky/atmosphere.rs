//! A clear spherical atmosphere: what it lets through, and the light it scatters along a path.
//!
//! Optical depths of air and haze: Preetham, Shirley and Smits, "A Practical Analytic Model for
//! Daylight", 1999, appendix A.1 (Rayleigh's, and Ångström's for a turbidity). Columns of air along a
//! slanted path: Chapman's grazing incidence function, by its asymptotic form for a scale height much
//! smaller than the radius. Lengths are in kilometres; radiances are per unit of the sun's irradiance
//! above the atmosphere. Refraction is left out. Knows nothing of images or axes.

use super::spectrum::{BANDS, Bands, wavelength};
use crate::math::fun::{self, double};
use std::f64::consts::PI;

/// Mean radius of the earth.
pub(super) const GROUND: f64 = 6371.0;
/// Radius above which there is nothing.
pub(super) const TOP: f64 = GROUND + 100.0;
/// Heights over which the densities of air and of haze fall by a factor of e.
const SCALE_HEIGHTS: [f64; 2] = [8.0, 1.2];
/// Middle and half-width of the ozone layer, whose density has the shape of a tent.
const OZONE_RADIUS: f64 = GROUND + 25.0;
const OZONE_HALF_WIDTH: f64 = 15.0;
/// Fraction of what haze takes out of a beam that it scatters; typical of continental aerosol.
const HAZE_ALBEDO: f32 = 0.93;

/// A ray as the atmosphere sees it: all that matters by symmetry.
#[derive(Clone, Copy)]
pub(super) struct Path {
    /// Distance of its start from the earth's centre.
    pub(super) radius: f64,
    /// Cosine of its angle with the zenith there.
    pub(super) cos_zenith: f64,
    /// Cosine of the sun's angle with the zenith there.
    pub(super) cos_sun: f64,
    /// Cosine of its angle with the direction to the sun.
    pub(super) cos_between: f64,
}

/// A point along a path.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub(super) radius: f64,
    /// Cosine of the sun's angle with the zenith.
    pub(super) cos_sun: f64,
    /// What air and haze scatter, per km.
    pub(super) scattering: [Bands; 2],
}

/// Air, haze and ozone: densities relative to the ground's (for ozone, to the layer's middle), or their
/// integral along a path, km.
type Amounts = [f64; 3];

/// What the atmosphere is made of.
pub(super) struct Atmosphere {
    /// Extinction by air, haze and ozone where their density is 1, per km.
    extinction: [Bands; 3],
}

impl Atmosphere {
    /// An atmosphere of `turbidity` in [1, 10].
    pub(super) fn new(turbidity: f64) -> Self {
        // Vertical optical depths, for wavelengths in micrometres.
        let air = |w: f64| 0.008_735 * double::pow(w, -4.08);
        let haze = |w: f64| (0.046_08 * turbidity - 0.045_86) * double::pow(w, -1.3);
        // The Chappuis band as a Gaussian: 300 Dobson units of 5.1e-25 m^2 at the peak.
        let ozone = |w: f64| 0.041 * double::exp(-0.5 * ((w - 0.603) / 0.055).powi(2));
        let per_km = |depth: &dyn Fn(f64) -> f64, km: f64| -> Bands {
            std::array::from_fn(|k| (depth(1e-3 * wavelength(k)) / km) as f32)
        };
        Self {
            extinction: [
                per_km(&air, SCALE_HEIGHTS[0]),
                per_km(&haze, SCALE_HEIGHTS[1]),
                per_km(&ozone, OZONE_HALF_WIDTH),
            ],
        }
    }

    /// Fraction of the sun's light that arrives at `radius`; 0 in the earth's shadow.
    pub(super) fn sun_transmittance(&self, radius: f64, cos_sun: f64) -> Bands {
        match columns_to_space(radius, cos_sun) {
            Some(columns) => self.optical_depth(columns).map(|depth| fun::exp(-depth)),
            None => [0.0; BANDS],
        }
    }

    /// Integral along `path`, to the ground or to space, of `source`, radiance gained per km, times the
    /// transmittance from there to the start; and the transmittance of the whole path.
    pub(super) fn integrate(
        &self,
        path: &Path,
        steps: usize,
        source: impl Fn(&Place) -> Bands,
    ) -> (Bands, Bands) {
        let length = path.length();
        let mut radiance = [0.0; BANDS];
        let mut transmittance = [1.0; BANDS];
        for i in 0..steps {
            // The end of a step goes as the cube of its number: most of the air is near the start.
            let end = |i: usize| length * (i as f64 / steps as f64).powi(3);
            let step = end(i + 1) - end(i);
            let (radius, cos_sun) = path.at(end(i) + 0.5 * step);
            let densities = densities(radius);
            let gain = source(&Place { radius, cos_sun, scattering: self.scattering(densities) });
            let depth = self.optical_depth(densities.map(|density| density * step));
            // Exact for constant density and source: the integral of e^-x over the step's depth.
            for k in 0..BANDS {
                let passed = fun::exp(-depth[k]);
                let mean = if depth[k] > 1e-4 { (1.0 - passed) / depth[k] } else { 1.0 };
                radiance[k] += transmittance[k] * mean * gain[k] * step as f32;
                transmittance[k] *= passed;
            }
        }
        (radiance, transmittance)
    }

    fn optical_depth(&self, amounts: Amounts) -> Bands {
        let [air, haze, ozone] = amounts.map(|amount| amount as f32);
        let [a, h, o] = &self.extinction;
        std::array::from_fn(|k| a[k] * air + h[k] * haze + o[k] * ozone)
    }

    fn scattering(&self, [air, haze, _]: Amounts) -> [Bands; 2] {
        let (air, haze) = (air as f32, HAZE_ALBEDO * haze as f32);
        [self.extinction[0].map(|e| e * air), self.extinction[1].map(|e| e * haze)]
    }
}

impl Path {
    /// Whether it ends on the ground.
    pub(super) fn hits_ground(&self) -> bool {
        self.cos_zenith < 0.0 && closest_radius(self.radius, self.cos_zenith) < GROUND
    }

    /// Distance to the ground or to the top of the atmosphere.
    pub(super) fn length(&self) -> f64 {
        let closest = closest_radius(self.radius, self.cos_zenith);
        let half_chord = |sphere: f64| (sphere * sphere - closest * closest).max(0.0).sqrt();
        let to_closest = -self.radius * self.cos_zenith;
        if self.hits_ground() {
            to_closest - half_chord(GROUND)
        } else {
            to_closest + half_chord(TOP)
        }
    }

    /// Distance from the earth's centre and cosine of the sun's zenith angle, `t` km along.
    pub(super) fn at(&self, t: f64) -> (f64, f64) {
        let squared = self.radius * self.radius + t * t + 2.0 * self.radius * t * self.cos_zenith;
        let radius = squared.sqrt();
        (radius, (self.radius * self.cos_sun + t * self.cos_between) / radius)
    }
}

/// How close the whole line comes to the earth's centre.
fn closest_radius(radius: f64, cos_zenith: f64) -> f64 {
    radius * (1.0 - cos_zenith * cos_zenith).max(0.0).sqrt()
}

fn densities(radius: f64) -> Amounts {
    let [air, haze] = SCALE_HEIGHTS.map(|height| double::exp((GROUND - radius) / height));
    [air, haze, (1.0 - (radius - OZONE_RADIUS).abs() / OZONE_HALF_WIDTH).max(0.0)]
}

/// What lies between `radius` and space in a direction; `None` if the ground does.
fn columns_to_space(radius: f64, cos_zenith: f64) -> Option<Amounts> {
    let closest = closest_radius(radius, cos_zenith);
    if cos_zenith >= 0.0 {
        return Some(upward_columns(radius, cos_zenith));
    }
    // Down to the closest point and up again: the whole line less the part behind the start.
    let (half, behind) = (upward_columns(closest, 0.0), upward_columns(radius, -cos_zenith));
    (closest >= GROUND).then(|| std::array::from_fn(|i| 2.0 * half[i] - behind[i]))
}

/// As [`columns_to_space`], for a direction that does not descend.
fn upward_columns(radius: f64, cos_zenith: f64) -> Amounts {
    let [air, haze] = SCALE_HEIGHTS.map(|height| {
        double::exp((GROUND - radius) / height) * height * chapman(radius / height, cos_zenith)
    });
    // Ozone above here, slanted as it crosses the middle of the layer, or as it would at most.
    let below = ((radius - OZONE_RADIUS) / OZONE_HALF_WIDTH).clamp(-1.0, 1.0);
    let above = 0.5 - below + 0.5 * below * below.abs();
    let sine = closest_radius(radius, cos_zenith) / OZONE_RADIUS;
    let secant = 1.0 / (1.0 - sine * sine).max(OZONE_HALF_WIDTH / OZONE_RADIUS).sqrt();
    [air, haze, OZONE_HALF_WIDTH * above * secant]
}

/// Chapman's function for `x` = radius over scale height, much larger than 1, and a zenith angle of at
/// most 90 degrees: the column along the direction over the column straight up.
///
/// Its asymptotic form is sqrt(pi x / 2) erfcx(z), with z = cos_zenith sqrt(x / 2). The scaled complementary
/// error function comes from its continued fraction (Abramowitz and Stegun 7.1.14), cut after four terms
/// by the fixed point of the next: 0.3 % at the horizon, where the form itself is as good.
fn chapman(x: f64, cos_zenith: f64) -> f64 {
    let z = cos_zenith * (0.5 * x).sqrt();
    let mut w = 0.5 * (z + (z * z + 9.0).sqrt());
    for k in [4.0, 3.0, 2.0, 1.0] {
        w = z + 0.5 * k / w;
    }
    (0.5 * PI * x).sqrt() / (w * PI.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The closed forms agree with a brute-force sum of densities, from the ground and from on high,
    /// upward, along the horizon and below it.
    #[test]
    fn columns_equal_their_integrals() {
        for (radius, cos_zenith) in [
            (GROUND, 1.0),
            (GROUND, 0.3),
            (GROUND, 0.02),
            (GROUND + 3.0, 0.0),
            (GROUND + 5.0, -0.02),
            (GROUND + 60.0, -0.12),
        ] {
            let columns = columns_to_space(radius, cos_zenith).unwrap();
            let path = Path { radius, cos_zenith, cos_sun: 0.0, cos_between: 0.0 };
            let n = 400_000;
            let step = path.length() / f64::from(n);
            let mut sums = [0.0; 3];
            for i in 0..n {
                let densities = densities(path.at((f64::from(i) + 0.5) * step).0);
                (0..3).for_each(|c| sums[c] += densities[c] * step);
            }
            // Ozone's layer counts as a thin shell once it is crossed.
            for (c, tolerance) in [(0, 0.01), (1, 0.01), (2, 0.18)] {
                let error = (columns[c] - sums[c]).abs();
                assert!(error <= tolerance * sums[c] + 1e-9, "{c}: {columns:?} for {sums:?}");
            }
        }
        assert_eq!(columns_to_space(GROUND + 1.0, -0.1), None);
    }

    /// A path through a medium that is all source: radiance = albedo (1 - transmittance).
    #[test]
    fn emission_and_extinction_balance() {
        let atmosphere = Atmosphere::new(4.0);
        let path = Path { radius: GROUND, cos_zenith: 0.2, cos_sun: 0.0, cos_between: 0.0 };
        let (radiance, transmittance) = atmosphere
            .integrate(&path, 24, |place| atmosphere.optical_depth(densities(place.radius)));
        for k in 0..BANDS {
            assert!((radiance[k] + transmittance[k] - 1.0).abs() < 1e-3);
        }
    }
}
