//! Smooth interfaces against Snell's law and Fresnel's equations.

use super::{direction, glass};
use glint::bsdf::*;
use glint::math::{ONE_MINUS_EPSILON, Rgb, Vec3, fun};

/// Refraction by Snell's law, reflection by the mirror's, at exact shares of energy.
#[test]
fn smooth_glass_obeys_snell() {
    for eta in [1.33_f32, 1.5, 2.42] {
        for degrees in (1..90).step_by(4) {
            let (sin_o, cos_o) = fun::sin_cos((degrees as f32).to_radians());
            let wo = direction(cos_o, 0.3);
            for (bsdf, ratio) in [(glass(eta, true, 0.0), eta), (glass(eta, false, 0.0), 1.0 / eta)]
            {
                let sin_t = sin_o / ratio;
                let Some(sample) = bsdf.sample(wo, ONE_MINUS_EPSILON, [0.5; 2]) else {
                    panic!("a smooth interface absorbs nothing");
                };
                if sin_t >= 1.0 {
                    // Total internal reflection begins at asin(1 / eta).
                    assert!(sin_o >= 1.0 / eta - 1e-6);
                    assert_eq!(
                        (sample.kind, sample.wi),
                        (LobeKind::Mirror, Vec3::new(-wo.x, -wo.y, wo.z))
                    );
                    assert_eq!((sample.weight, sample.eta_scale), (Rgb::WHITE, 1.0));
                } else {
                    assert_eq!(sample.kind, LobeKind::Refraction);
                    let expected =
                        direction(-(1.0 - sin_t * sin_t).sqrt(), 0.3 + std::f32::consts::PI);
                    assert!((sample.wi - expected).length() < 1e-5, "{} {expected}", sample.wi);
                    // Radiance shrinks by eta^2 on entering the denser side.
                    assert!((sample.weight.g * ratio * ratio - 1.0).abs() < 1e-6);
                    assert_eq!(sample.eta_scale, ratio * ratio);
                }
            }
        }
    }
    // A sheet is left in the direction of arrival, without the radiance factor.
    let sheet = Bsdf::dielectric(1.5, true, Rgb::splat(0.5), true, 0.0);
    let sample = sheet.sample(direction(0.5, 1.0), 0.999, [0.5; 2]).unwrap();
    assert_eq!((sample.wi, sample.eta_scale), (-direction(0.5, 1.0), 1.0));
}

/// Fresnel's equations where they have closed forms.
#[test]
fn fresnel_closed_forms() {
    let reflectance = |eta, entering, cos_theta| {
        let glass = Dielectric::new(eta, entering, Rgb::BLACK, false);
        glass.albedo(direction(cos_theta, 0.0)).g
    };
    for eta in [1.1_f32, 1.33, 1.5, 2.42, 4.0] {
        // Normal incidence, from either side; and grazing incidence.
        let normal = ((eta - 1.0) / (eta + 1.0)).powi(2);
        assert!((reflectance(eta, true, 1.0) - normal).abs() < 1e-6);
        assert!((reflectance(eta, false, 1.0) - normal).abs() < 1e-6);
        assert!(reflectance(eta, true, 1e-6) > 0.9999);
        // Brewster's angle, tan = eta: the parallel part vanishes, half of the other remains.
        let brewster = 1.0 / (1.0 + eta * eta).sqrt();
        let perpendicular = ((1.0 - eta * eta) / (1.0 + eta * eta)).powi(2);
        assert!((reflectance(eta, true, brewster) - 0.5 * perpendicular).abs() < 1e-6);
        // Critical angle, sin = 1 / eta.
        let critical = (1.0 - 1.0 / (eta * eta)).sqrt();
        assert_eq!(reflectance(eta, false, critical - 1e-4), 1.0);
        assert!(reflectance(eta, false, critical + 1e-4) < 1.0);
        // A metal without extinction is a dielectric.
        for cos_theta in [0.05, 0.3, 0.7, 1.0] {
            let metal = Conductor::new(Rgb::splat(eta), Rgb::BLACK, 0.0, 0.0);
            let difference =
                metal.albedo(direction(cos_theta, 0.0)).g - reflectance(eta, true, cos_theta);
            assert!(difference.abs() < 2e-6, "{eta} {cos_theta}: {difference}");
        }
    }
    // A sheet reflects 2 F / (1 + F).
    let sheet = Dielectric::new(1.5, true, Rgb::BLACK, true).albedo(Vec3::Z).g;
    assert!((sheet - 0.08 / 1.04).abs() < 1e-6);
}
