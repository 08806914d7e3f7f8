//! Directions towards lights against their densities, and what they estimate.
//!
//! The statistical comparisons are [`COMPARISONS`] chi-square tests whose false alarms together have a
//! probability of at most 1e-6. Their power: a density off by 2 %, up and down, is rejected, which
//! `a_density_off_by_two_percent_is_rejected` shows. Seeds count from 0.

use super::sphere_chi_square::{Region, level, p_value};
use super::{clear_sky, direction_to_sun, integrate, one_bright, spiky};
use glint::light::{
    ConstantEnvironment, DirectionalLight, ImageEnvironment, Light, Sky, orientation,
};
use glint::math::fun::double;
use glint::math::{DVec3, Frame, Rgb, Vec3};
use glint::sampling::CounterRng;
use std::f64::consts::PI;
use std::sync::LazyLock;

/// Chi-square tests in this file that must not reject.
const COMPARISONS: usize = 16;

const WHOLE_SPHERE: Region = Region { axis: Vec3::new(0.36, 0.48, -0.8), one_minus_cos: 2.0 };

/// A light that rays can see, and the region in which its sampler is compared with its density.
struct Case {
    name: String,
    light: Light,
    region: Region,
}

static CASES: LazyLock<Vec<Case>> = LazyLock::new(cases);

fn cases() -> Vec<Case> {
    // Around one bright texel, the region is a cone that holds the texels next to it.
    let near = |name, [column, row]: [usize; 2], axis: Vec3, degrees| Case {
        region: Region { axis: axis.normalize(), one_minus_cos: one_minus_cos(degrees) },
        ..image(name, one_bright([16, 8], [column, row]), 16, DVec3::Y, 0.0)
    };
    let mut cases = vec![
        image("spiky", spiky([32, 16]), 32, DVec3::Y, 0.0),
        image("spiky, turned", spiky([32, 16]), 32, DVec3::Z, 77.0),
        image("odd", spiky([5, 3]), 5, DVec3::Y, -20.0),
        image("one texel", vec![Rgb::WHITE], 1, DVec3::Y, 0.0),
        near("one bright at the seam", [0, 3], Vec3::new(-0.191, 0.195, 0.962), 33.0),
        near("one bright at the pole", [5, 0], Vec3::new(-0.241, 0.957, -0.161), 22.0),
        near("one bright at the south pole", [2, 7], Vec3::new(-0.241, -0.957, 0.161), 22.0),
        Case {
            name: "constant".into(),
            light: Light::Constant(ConstantEnvironment::new(Rgb::new(1.0, 2.0, 3.0)).unwrap()),
            region: WHOLE_SPHERE,
        },
        directional(0.53),
        directional(20.0),
        directional(180.0),
    ];
    for elevation in [-4.0, 5.0, 30.0, 60.0] {
        let Sky { environment, sun } = clear_sky(elevation, 3.0);
        let name = format!("sky at {elevation}");
        cases.push(Case { name, light: Light::Image(environment), region: WHOLE_SPHERE });
        if elevation == 5.0 {
            let axis = direction_to_sun(elevation);
            let region = Region { axis, one_minus_cos: one_minus_cos(0.265) };
            cases.push(Case { name: "sun".into(), light: Light::Directional(sun), region });
        }
    }
    cases
}

fn image(name: &str, texels: Vec<Rgb>, width: usize, up: DVec3, rotation: f64) -> Case {
    let environment = ImageEnvironment::new(texels, width, orientation(up, rotation)).unwrap();
    Case { name: name.into(), light: Light::Image(environment), region: WHOLE_SPHERE }
}

fn directional(angular_diameter: f64) -> Case {
    let travels = DVec3::new(-1.0, -2.0, 0.5);
    let irradiance = Rgb::new(3.0, 2.5, 2.0);
    let light = DirectionalLight::new(travels, irradiance, angular_diameter).unwrap();
    let axis = -travels.normalize().as_vec3();
    let region = Region { axis, one_minus_cos: one_minus_cos(0.5 * angular_diameter) };
    Case { name: format!("disc of {angular_diameter}"), light: Light::Directional(light), region }
}

fn one_minus_cos(degrees: f64) -> f32 {
    2.0 * double::sin(0.5 * degrees.to_radians()).powi(2) as f32
}

fn sample_direction(light: &Light, u: [f32; 2]) -> Option<Vec3> {
    light.sample(Vec3::ZERO, u).map(|sample| sample.direction)
}

#[test]
fn samples_follow_their_density() {
    assert!(CASES.len() <= COMPARISONS);
    for (seed, Case { name, light, region }) in CASES.iter().enumerate() {
        let p = p_value(
            *region,
            seed as u64,
            |u| sample_direction(light, u),
            |direction| light.pdf_solid_angle(direction).into(),
        );
        assert!(p > level(COMPARISONS), "{name}: p = {p:e}");
    }
}

/// The power of the test above: a density 2 % too high on one side of a plane and 2 % too low on the other
/// is rejected (p < 1e-19): for a spiky image, a lone texel, the sun's disc and a sky.
#[test]
fn a_density_off_by_two_percent_is_rejected() {
    for (seed, Case { name, light, region }) in CASES.iter().enumerate().step_by(4) {
        let side = Frame::from_normal(region.axis).tangent;
        let p = p_value(
            *region,
            seed as u64,
            |u| sample_direction(light, u),
            |direction| {
                let error = 0.02_f64.copysign(f64::from((direction - region.axis).dot(side)));
                f64::from(light.pdf_solid_angle(direction)) * (1.0 + error)
            },
        );
        assert!(p < level(COMPARISONS), "{name}: p = {p:e}");
    }
}

#[test]
fn densities_integrate_to_one() {
    for Case { name, light, region } in CASES.iter() {
        // Discs are measured within their rim, the rest over the sphere.
        let integral = if let Light::Directional(_) = light {
            let solid_angle = 2.0 * PI * f64::from(region.one_minus_cos);
            f64::from(light.pdf_solid_angle(region.axis)) * solid_angle
        } else {
            integrate(360, |direction| [light.pdf_solid_angle(direction).into()])[0]
        };
        assert!((integral - 1.0).abs() < 2e-3, "{name}: {integral}");
    }
}

/// What a sample says of its direction is bit for bit what a ray along that direction would find.
#[test]
fn samples_agree_with_lookups() {
    for (seed, Case { name, light, .. }) in CASES.iter().enumerate() {
        let mut rng = CounterRng::new(seed as u64);
        let mut missing = 0;
        for _ in 0..20_000 {
            let Some(sample) = light.sample(Vec3::ONE, [rng.unit(), rng.unit()]) else {
                missing += 1;
                continue;
            };
            let (radiance, pdf) = light.radiance_and_pdf(sample.direction);
            assert_eq!((sample.radiance, sample.pdf_solid_angle), (radiance, pdf), "{name}");
            assert_eq!(radiance, light.radiance(sample.direction), "{name}");
            assert_eq!(pdf, light.pdf_solid_angle(sample.direction), "{name}");
            assert_eq!((sample.distance, sample.is_delta), (f32::INFINITY, false), "{name}");
            assert!((sample.direction.length() - 1.0).abs() < 3e-7, "{name}");
            assert!(pdf > 0.0 && pdf.is_finite(), "{name}");
            assert!(radiance.is_finite() && !radiance.is_black(), "{name}");
        }
        assert!(missing <= 2, "{name}: {missing} of 20000 samples lost");
    }
}

#[test]
fn irradiance_of_an_environment_equals_its_quadrature() {
    for Case { name, light, region } in CASES.iter() {
        if let Light::Directional(_) = light {
            continue;
        }
        let normals = [region.axis.normalize(), Vec3::new(0.6, 0.64, 0.48), Vec3::NEG_Y];
        let received = |direction: Vec3, luminance: f32| {
            normals.map(|normal| f64::from(luminance * direction.dot(normal).max(0.0)))
        };
        let truth = integrate(240, |d| received(d, light.radiance(d).luminance()));
        // One sample in each cell of a grid.
        let n = 300;
        let mut rng = CounterRng::new(0);
        let mut estimate = [0.0; 3];
        for i in 0..n * n {
            let mut cell = |i: usize| (i as f32 + rng.unit()) / n as f32;
            let u = [cell(i % n), cell(i / n)];
            let Some(sample) = light.sample(Vec3::ZERO, u) else { continue };
            let weighted = sample.radiance.luminance() / sample.pdf_solid_angle;
            let received = received(sample.direction, weighted);
            (0..3).for_each(|k| estimate[k] += received[k] / (n * n) as f64);
        }
        for k in 0..3 {
            assert!(
                (estimate[k] - truth[k]).abs() <= 0.005 * truth[k],
                "{name}, normal {}: {} instead of {}",
                normals[k],
                estimate[k],
                truth[k]
            );
        }
    }
}

#[test]
fn a_facing_surface_receives_the_irradiance_of_a_directional_light() {
    let irradiance = Rgb::new(3.0, 2.5, 2.0);
    for angular_diameter in [0.01, 0.53, 20.0, 90.0, 180.0] {
        let Case { light, region, .. } = directional(angular_diameter);
        let n = 256;
        let mut estimate = [0.0_f64; 3];
        for i in 0..n * n {
            let u = [((i % n) as f32 + 0.5) / n as f32, ((i / n) as f32 + 0.5) / n as f32];
            let sample = light.sample(Vec3::ZERO, u).unwrap();
            let cos_theta = sample.direction.dot(region.axis);
            let weighted = sample.radiance * (cos_theta / sample.pdf_solid_angle);
            (0..3).for_each(|c| estimate[c] += f64::from(weighted[c]) / f64::from(n * n));
        }
        for c in 0..3 {
            let ratio = estimate[c] / f64::from(irradiance[c]);
            assert!((ratio - 1.0).abs() < 1e-4, "{angular_diameter}: {ratio}");
        }
    }
    let hard = DirectionalLight::new(DVec3::NEG_Y, irradiance, 0.0).unwrap();
    let sample = hard.sample([0.3, 0.7]).unwrap();
    assert_eq!((sample.direction, sample.radiance, sample.is_delta), (Vec3::Y, irradiance, true));
    assert_eq!((hard.radiance(Vec3::Y), hard.pdf_solid_angle(Vec3::Y)), (Rgb::BLACK, 0.0));
}

#[test]
fn power_through_a_disc_is_the_integral_of_the_radiance() {
    let area = PI * 9.0;
    for Case { name, light, .. } in CASES.iter() {
        let truth = if let Light::Directional(light) = light {
            area * f64::from(light.irradiance().luminance())
        } else {
            area * integrate(240, |direction| [light.radiance(direction).luminance().into()])[0]
        };
        let ratio = f64::from(light.power_estimate(3.0)) / truth;
        // An image's takes each patch by the mean of its corners, which is rough for a lone texel at a pole.
        let tolerance = if name.contains("pole") { 0.2 } else { 0.05 };
        assert!((ratio - 1.0).abs() < tolerance, "{name}: {ratio}");
    }
}
