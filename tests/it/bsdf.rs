//! The scattering models against statistics and closed forms.
//!
//! False alarms: every chi-square test runs at a significance that makes 1e-6 over all of them; everything
//! else is deterministic. Power: `mutated_*` tests inject a density that is 2 % off and an energy that is 1 %
//! off, and assert that the same checks reject them.

use crate::support::{chi_square, effort};
use glint::bsdf::*;
use glint::math::{Rgb, Vec3};
use glint::sampling::CounterRng;

/// Unit vector with a cosine and an azimuth in radians.
fn direction(cos_theta: f32, phi: f32) -> Vec3 {
    let sin_theta = (1.0 - cos_theta * cos_theta).sqrt();
    Vec3::new(sin_theta * phi.cos(), sin_theta * phi.sin(), cos_theta)
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
    let metal = Metal::by_name("gold").unwrap();
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

#[test]
fn samples_have_the_density_of_evaluate() {
    let roughnesses: &[f32] = if effort(0, 1) == 0 {
        &[0.1, 0.5, 1.0]
    } else {
        &[0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.85, 1.0]
    };
    let directions = [direction(0.99, 1.0), direction(0.6, 0.4), direction(0.08, 2.5)];
    let models: Vec<_> = roughnesses.iter().flat_map(|&r| spread_models(r)).collect();
    let significance = chi_square::sidak(models.len() * directions.len());
    let count = effort(120_000, 2_000_000);
    for (seed, (name, bsdf)) in models.iter().enumerate() {
        for wo in directions {
            let pdf = |wi| bsdf.evaluate(wo, wi).pdf_solid_angle;
            let p = p_value(bsdf, wo, pdf, count, seed as u64);
            assert!(p > significance, "{name}, wo {wo}: p = {p:e}");
        }
    }
}

/// The power of the test above at its quick sample count.
#[test]
fn mutated_densities_are_rejected() {
    let significance = chi_square::sidak(99);
    let count = 120_000;
    for (seed, wo) in [direction(0.99, 1.0), direction(0.6, 0.4)].into_iter().enumerate() {
        // Scaled by 2 %: where some samples are absorbed, and where none are.
        for bsdf in
            [gold(0.5, 0.0), glass(1.5, false, 0.5), Bsdf::Lambert(Lambert::new(Rgb::WHITE))]
        {
            for scale in [0.98, 1.02] {
                let pdf = |wi| scale * bsdf.evaluate(wo, wi).pdf_solid_angle;
                let p = p_value(&bsdf, wo, pdf, count, seed as u64);
                assert!(p < significance, "scaled by {scale}: p = {p:e}");
            }
        }
        // Density of a lobe whose alpha is 3 % off.
        for (right, wrong) in [
            (gold(0.3, 0.0), gold(0.3 * 1.015, 0.0)),
            (glass(1.5, true, 0.3), glass(1.5, true, 0.3 * 1.015)),
        ] {
            let pdf = |wi| wrong.evaluate(wo, wi).pdf_solid_angle;
            let p = p_value(&right, wo, pdf, count, seed as u64);
            assert!(p < significance, "wrong alpha: p = {p:e}");
        }
    }
}
