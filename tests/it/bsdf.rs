//! The scattering models against statistics and closed forms.
//!
//! False alarms: every chi-square test runs at a significance that makes 1e-6 over all of them; everything
//! else is deterministic. Power: `mutated_*` tests inject a density that is 2 % off and an energy that is 1 %
//! off, and assert that the same checks reject them.

mod closed_forms;
mod energy;
mod metals;

use crate::support::{chi_square, effort};
use glint::bsdf::*;
use glint::math::{ONE_MINUS_EPSILON, Rgb, Vec3, fun};
use glint::sampling::CounterRng;

/// Unit vector with a cosine and an azimuth in radians.
fn direction(cos_theta: f32, phi: f32) -> Vec3 {
    let sin_theta = (1.0 - cos_theta * cos_theta).sqrt();
    let (sin_phi, cos_phi) = fun::sin_cos(phi);
    Vec3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta)
}

fn unit2(rng: &mut CounterRng) -> [f32; 2] {
    [rng.unit(), rng.unit()]
}

fn glass(eta: f32, entering: bool, roughness: f32) -> Bsdf {
    Bsdf::dielectric(eta, entering, Rgb::WHITE, false, roughness)
}

fn white_metal(roughness: f32, anisotropy: f32) -> Bsdf {
    Bsdf::Conductor(Conductor::new(Rgb::BLACK, Rgb::WHITE, roughness, anisotropy))
}

fn gold(roughness: f32, anisotropy: f32) -> Bsdf {
    let metal = Metal::by_name("gold").expect("a known metal");
    Bsdf::Conductor(Conductor::new(metal.eta, metal.k, roughness, anisotropy))
}

fn principled(parameters: PrincipledParameters) -> Bsdf {
    Bsdf::Principled(Principled::new(&parameters))
}

/// A car paint with everything in it.
fn paint(roughness: f32) -> PrincipledParameters {
    PrincipledParameters {
        base_color: Rgb::new(0.7, 0.2, 0.1),
        metallic: 0.4,
        roughness,
        specular: Rgb::new(0.05, 0.1, 0.2),
        anisotropy: 0.5,
        clearcoat: 0.7,
        clearcoat_roughness: 0.2,
        sheen: 0.6,
    }
}

/// Every model that has a lobe with a density, by name, for a roughness in (0, 1].
fn spread_models(roughness: f32) -> Vec<(String, Bsdf)> {
    let tint = Rgb::new(0.8, 0.5, 0.3);
    let models = [
        ("lambert", Bsdf::Lambert(Lambert::new(tint))),
        ("oren-nayar", Bsdf::OrenNayar(OrenNayar::new(tint, roughness))),
        ("gold", gold(roughness, 0.0)),
        ("gold, anisotropic", gold(roughness, -0.7)),
        ("glass, entering", Bsdf::dielectric(1.5, true, tint, false, roughness)),
        ("glass, leaving", Bsdf::dielectric(1.5, false, tint, false, roughness)),
        ("sheet", Bsdf::dielectric(1.5, true, tint, true, roughness)),
        ("plastic", Bsdf::Plastic(Plastic::new(tint, 1.5, roughness))),
        ("plastic, smooth", Bsdf::Plastic(Plastic::new(tint, 1.5, 0.0))),
        ("paint", principled(paint(roughness))),
        ("cloth", principled(PrincipledParameters { sheen: 1.0, roughness, ..Default::default() })),
    ];
    models.map(|(name, bsdf)| (format!("{name}, roughness {roughness}"), bsdf)).into()
}

/// Everything, with delta lobes.
fn all_models(roughness: f32) -> Vec<(String, Bsdf)> {
    let tint = Rgb::new(0.8, 0.5, 0.3);
    let mut models = spread_models(roughness);
    for (name, bsdf) in [
        ("mirror", Bsdf::Mirror(Mirror::new(tint))),
        ("smooth glass", glass(1.5, true, 0.0)),
        ("smooth glass, leaving", glass(1.5, false, 0.0)),
        ("smooth sheet", Bsdf::dielectric(1.5, true, tint, true, 0.0)),
        ("smooth gold", gold(0.0, 0.0)),
        (
            "smooth paint",
            principled(PrincipledParameters { clearcoat_roughness: 0.0, ..paint(0.0) }),
        ),
    ] {
        models.push((name.to_owned(), bsdf));
    }
    models
}

fn p_value(bsdf: &Bsdf, wo: Vec3, pdf: impl Fn(Vec3) -> f32, count: usize, seed: u64) -> f64 {
    let sample = |rng: &mut CounterRng| {
        let sample = bsdf.sample(wo, rng.unit(), unit2(rng))?;
        (!sample.is_delta).then_some(sample.wi)
    };
    chi_square::p_value(sample, pdf, count, seed)
}

/// Samples per comparison of the chi-square tests, in the quick and in the thorough tier.
const COUNTS: [usize; 2] = [60_000, 500_000];

#[test]
fn samples_have_the_density_of_evaluate() {
    let roughnesses = [[0.1, 0.4, 1.0].as_slice(), &[0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.85, 1.0]];
    let directions = [direction(0.99, 1.0), direction(0.6, 0.4), direction(0.08, 2.5)];
    let models: Vec<_> = roughnesses[effort(0, 1)].iter().flat_map(|&r| spread_models(r)).collect();
    let significance = chi_square::sidak(models.len() * directions.len());
    let count = COUNTS[effort(0, 1)];
    for (seed, (name, bsdf)) in models.iter().enumerate() {
        for wo in directions {
            let pdf = |wi| bsdf.evaluate(wo, wi).pdf_solid_angle;
            let p = p_value(bsdf, wo, pdf, count, seed as u64);
            assert!(p > significance, "{name}, wo {wo}: p = {p:e}");
        }
    }
}

/// The power of the test above: 2 % in scale at the quick count, 2 % in alpha at the thorough one.
#[test]
fn mutated_densities_are_rejected() {
    let significance = chi_square::sidak(1000);
    for (seed, wo) in [direction(0.99, 1.0), direction(0.6, 0.4)].into_iter().enumerate() {
        // Where some samples are absorbed, and where none are.
        for bsdf in
            [gold(0.5, 0.0), glass(1.5, false, 0.5), Bsdf::Lambert(Lambert::new(Rgb::WHITE))]
        {
            for scale in [0.98, 1.02] {
                let pdf = |wi| scale * bsdf.evaluate(wo, wi).pdf_solid_angle;
                let p = p_value(&bsdf, wo, pdf, COUNTS[0], seed as u64);
                assert!(p < significance, "scaled by {scale}: p = {p:e}");
            }
        }
        let models: [fn(f32) -> Bsdf; 2] = [|r| gold(r, 0.0), |r| glass(1.5, true, r)];
        for model in models {
            let (right, wrong) = (model(0.3), model(0.3 * 1.02_f32.sqrt()));
            let pdf = |wi| wrong.evaluate(wo, wi).pdf_solid_angle;
            let p = p_value(&right, wo, pdf, COUNTS[1], seed as u64);
            assert!(p < significance, "wrong alpha: p = {p:e}");
        }
    }
}

/// Adversarial and random arguments.
#[test]
fn values_are_finite_consistent_and_on_the_right_side() {
    let mut rng = CounterRng::new(0);
    let cosines = [1e-30, 1e-12, 1e-7, 1e-4, 0.003, 0.05, 0.3, 0.8, 0.999_99, 1.0_f32];
    let edges = [0.0, 1e-9, 0.5, ONE_MINUS_EPSILON];
    for roughness in [0.0, 0.01, 0.031, 0.033, 0.06, 0.15, 0.4, 0.75, 1.0] {
        for (name, bsdf) in all_models(roughness) {
            for (i, cos_theta) in cosines.into_iter().cycle().take(20 * cosines.len()).enumerate() {
                let wo = direction(cos_theta, 6.3 * rng.unit());
                let number = |rng: &mut CounterRng| {
                    if i % 3 == 0 { edges[(rng.unit() * 4.0) as usize] } else { rng.unit() }
                };
                let numbers = [number(&mut rng), number(&mut rng), number(&mut rng)];
                let context = format!("{name} ({roughness}), wo {wo}, numbers {numbers:?}");
                // A sample, and its agreement with the value.
                if let Some(sample) = bsdf.sample(wo, numbers[0], [numbers[1], numbers[2]]) {
                    let value = bsdf.evaluate(wo, sample.wi);
                    let context = format!("{context}: {sample:?}, {value:?}");
                    assert!(
                        sample.weight.is_finite() && (sample.wi.length() - 1.0).abs() < 1e-5,
                        "{context}"
                    );
                    assert!(sample.weight.to_array().iter().all(|&w| w >= 0.0), "{context}");
                    assert_eq!(sample.kind == LobeKind::Refraction, sample.wi.z < 0.0, "{context}");
                    assert_eq!(sample.is_delta, sample.pdf_solid_angle == 0.0, "{context}");
                    if !sample.is_delta {
                        let close =
                            |a: f32, b: f32| (a - b).abs() <= 1e-5 * a.abs().max(b.abs()) + 1e-30;
                        assert!(close(value.pdf_solid_angle, sample.pdf_solid_angle), "{context}");
                        let f_cos = sample.weight * sample.pdf_solid_angle;
                        assert!((0..3).all(|c| close(f_cos[c], value.f_cos[c])), "{context}");
                    }
                }
                // An unrelated direction, on either side or in the tangent plane.
                let z = [2.0 * rng.unit() - 1.0, 0.0, 1e-9, -1e-9][i % 4];
                let wi = direction(z, 6.3 * rng.unit());
                let value = bsdf.evaluate(wo, wi);
                let context = format!("{context}, wi {wi}: {value:?}");
                assert!(value.f_cos.is_finite() && value.pdf_solid_angle.is_finite(), "{context}");
                assert!(value.f_cos.to_array().iter().all(|&f| f >= 0.0), "{context}");
                assert!(value.pdf_solid_angle >= 0.0, "{context}");
                assert!(value.f_cos.is_black() || value.pdf_solid_angle > 0.0, "{context}");
                let transmits = matches!(bsdf, Bsdf::RoughDielectric(_));
                assert!(transmits || wi.z > 0.0 || value == BsdfValue::ZERO, "{context}");
                assert!(!bsdf.is_delta() || value == BsdfValue::ZERO, "{context}");
                // From below, nothing.
                assert_eq!(bsdf.evaluate(-wo, wi), BsdfValue::ZERO, "{context}");
                assert_eq!(
                    bsdf.sample(-wo, numbers[0], [numbers[1], numbers[2]]),
                    None,
                    "{context}"
                );
                let albedo = bsdf.albedo(wo);
                assert!(albedo.is_finite() && albedo.max_channel() < 1.02, "{context}: {albedo:?}");
            }
        }
    }
}

/// f(wo, wi) = f(wi, wo) on one side; across an interface f / eta^2 is symmetric (Veach 1997, section 5.2).
#[test]
fn reciprocity() {
    let mut rng = CounterRng::new(1);
    for roughness in [0.1, 0.3, 0.6, 1.0] {
        for (name, bsdf) in spread_models(roughness) {
            for _ in 0..2000 {
                let [a, b] = [0; 2].map(|_| direction(0.01 + 0.99 * rng.unit(), 6.3 * rng.unit()));
                let f = |wo, wi: Vec3| bsdf.evaluate(wo, wi).f_cos / wi.z;
                assert_close(f(a, b), f(b, a), &format!("{name}: {a} {b}"));
            }
        }
        // Across: seen from below, up is down.
        for (eta, thin) in [(1.5, false), (0.6, false), (1.5, true)] {
            let side = |entering| {
                Bsdf::dielectric(eta, entering, Rgb::new(0.8, 0.5, 0.3), thin, roughness)
            };
            let (outside, inside) = (side(true), side(false));
            let eta2 = if thin { 1.0 } else { eta * eta };
            let below = |w: Vec3| Vec3::new(w.x, w.y, -w.z);
            for _ in 0..2000 {
                let [a, b] = [0; 2].map(|_| direction(0.01 + 0.99 * rng.unit(), 6.3 * rng.unit()));
                let inwards = outside.evaluate(a, below(b)).f_cos / b.z;
                let outwards = inside.evaluate(b, below(a)).f_cos / a.z;
                assert_close(inwards * eta2, outwards, &format!("eta {eta}: {a} {b}"));
            }
        }
    }
}

fn assert_close(a: Rgb, b: Rgb, context: &str) {
    for c in 0..3 {
        assert!((a[c] - b[c]).abs() <= 2e-3 * a[c].max(b[c]) + 1e-6, "{context}: {a:?} {b:?}");
    }
}

#[test]
fn a_bsdf_is_small() {
    assert!(size_of::<Bsdf>() <= 96, "{} bytes", size_of::<Bsdf>());
}
