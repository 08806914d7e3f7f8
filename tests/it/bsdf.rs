//! The scattering models against statistics and closed forms.
//!
//! False alarms: every chi-square test runs at a significance that makes 1e-6 over all of them; everything
//! else is deterministic. Power: `mutated_*` tests inject a density that is 2 % off and an energy that is 1 %
//! off, and assert that the same checks reject them.

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

/// Mean over `count` samples of weight * eta_scale, the energy that is scattered. The number of the lobe is
/// regular and those of the direction are a lattice of the roots of x^3 = x + 1 (the two-dimensional golden
/// ratio), so every lobe gets an even share of directions and the error falls almost as 1 / count.
fn energy(bsdf: &Bsdf, wo: Vec3, count: u32) -> [f64; 3] {
    const GOLDEN: f64 = 1.324_717_957_244_746;
    let mut sum = [0.0; 3];
    for i in 0..count {
        let i = f64::from(i) + 0.5;
        let numbers = [i / f64::from(count), i / GOLDEN, i / (GOLDEN * GOLDEN)]
            .map(|x| (x.fract() as f32).min(ONE_MINUS_EPSILON));
        if let Some(sample) = bsdf.sample(wo, numbers[0], [numbers[1], numbers[2]]) {
            let energy = (sample.weight * sample.eta_scale).to_array();
            (0..3).for_each(|c| sum[c] += f64::from(energy[c]));
        }
    }
    sum.map(|sum| sum / f64::from(count))
}

type Model = fn(f32) -> Bsdf;

/// White materials by roughness, and how far from 1 their energy may be; measured: half to nine tenths of
/// the bound.
fn white_models() -> Vec<(&'static str, f64, Model)> {
    /// A principled material with the given parameters changed.
    macro_rules! white {
        ($($field:ident: $value:expr),*) => {
            |roughness| principled(PrincipledParameters {
                base_color: Rgb::WHITE,
                roughness,
                $($field: $value,)*
                ..PrincipledParameters::default()
            })
        };
    }
    vec![
        ("lambert", 1e-6, |_| Bsdf::Lambert(Lambert::new(Rgb::WHITE))),
        ("oren-nayar", 2e-3, |r| Bsdf::OrenNayar(OrenNayar::new(Rgb::WHITE, r))),
        ("mirror", 1e-6, |_| Bsdf::Mirror(Mirror::new(Rgb::WHITE))),
        ("metal", 2e-3, |r| white_metal(r, 0.0)),
        ("metal, anisotropy 0.5", 5e-3, |r| white_metal(r, 0.5)),
        ("metal, anisotropy -0.9", 5e-3, |r| white_metal(r, -0.9)),
        ("water, entering", 3e-3, |r| glass(1.33, true, r)),
        ("water, leaving", 5e-3, |r| glass(1.33, false, r)),
        ("glass, entering", 3e-3, |r| glass(1.5, true, r)),
        ("glass, leaving", 5e-3, |r| glass(1.5, false, r)),
        ("diamond, entering", 3e-3, |r| glass(2.42, true, r)),
        ("diamond, leaving", 5e-3, |r| glass(2.42, false, r)),
        ("sheet", 2e-3, |r| Bsdf::dielectric(1.5, true, Rgb::WHITE, true, r)),
        ("plastic 1.33", 2e-3, |r| Bsdf::Plastic(Plastic::new(Rgb::WHITE, 1.33, r))),
        ("plastic 1.5", 2e-3, |r| Bsdf::Plastic(Plastic::new(Rgb::WHITE, 1.5, r))),
        ("plastic 2", 2e-3, |r| Bsdf::Plastic(Plastic::new(Rgb::WHITE, 2.0, r))),
        ("principled", 2e-3, white!()),
        ("principled, no specular", 2e-3, white!(specular: Rgb::BLACK)),
        ("principled, specular 1", 2e-3, white!(specular: Rgb::WHITE)),
        ("principled, half metallic", 2e-3, white!(metallic: 0.5)),
        ("principled, metallic", 2e-3, white!(metallic: 1.0)),
        ("principled, anisotropy 0.8", 5e-3, white!(anisotropy: 0.8)),
        ("principled, sheen", 2e-3, white!(sheen: 1.0)),
        ("principled, coat", 8e-3, white!(clearcoat: 1.0)),
        ("principled, rough coat", 8e-3, white!(clearcoat: 1.0, clearcoat_roughness: 0.5)),
        ("principled, coated metal", 4e-3, white!(clearcoat: 1.0, metallic: 1.0)),
        ("principled, everything", 4e-3, |r| {
            let white = PrincipledParameters { base_color: Rgb::WHITE, ..paint(r) };
            principled(PrincipledParameters { specular: Rgb::splat(0.1), ..white })
        }),
    ]
}

/// Least and greatest energy that a white model scatters.
fn energy_range(model: Model) -> [f64; 2] {
    let cosines = [[0.1, 0.3, 0.6, 1.0].as_slice(), &[0.02, 0.05, 0.1, 0.3, 0.6, 0.9, 1.0]];
    let mut range = [f64::INFINITY, 0.0];
    for roughness in [0.0, 0.1, 0.3, 0.6, 1.0] {
        let bsdf = model(roughness);
        for &cos_theta in cosines[effort(0, 1)] {
            let [energy, ..] =
                energy(&bsdf, direction(cos_theta, 0.5), effort(8192, 1 << 17) as u32);
            range = [range[0].min(energy), range[1].max(energy)];
        }
    }
    range
}

/// A white material in a uniformly bright room cannot be seen. Whether the check would notice 1 % more or
/// less is tested on the same figures.
#[test]
fn white_furnace() {
    for (name, tolerance, model) in white_models() {
        let range = energy_range(model);
        let passes = |scale: f64| range.iter().all(|e| (scale * e - 1.0).abs() <= tolerance);
        assert!(passes(1.0), "{name}: energies {range:?}, tolerance {tolerance}");
        assert!(!passes(1.01) && !passes(0.99), "{name}: 1 % would pass unnoticed");
    }
}

/// No colour, at any angle, returns more than it gets; and `albedo` says roughly how much.
#[test]
fn coloured_materials_lose_energy() {
    for roughness in [0.0, 0.2, 0.5, 1.0] {
        for (name, bsdf) in all_models(roughness) {
            for cos_theta in [0.1, 0.5, 1.0] {
                let wo = direction(cos_theta, 0.5);
                let (energy, albedo) = (energy(&bsdf, wo, 4096), bsdf.albedo(wo));
                for c in 0..3 {
                    let context =
                        format!("{name} ({roughness}), cos {cos_theta}: {energy:?} {albedo:?}");
                    assert!(energy[c] <= 1.002, "{context}");
                    assert!((energy[c] - f64::from(albedo[c])).abs() < 0.1, "{context}");
                }
            }
        }
    }
}

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

#[test]
fn metals_have_their_colours() {
    let color = |name: &str| {
        let metal = Metal::by_name(name).unwrap();
        let color = Conductor::new(metal.eta, metal.k, 0.0, 0.0).albedo(Vec3::Z);
        // Normal incidence: ((eta - 1)^2 + k^2) / ((eta + 1)^2 + k^2).
        let expected = metal
            .eta
            .zip(metal.k, |n, k| ((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k));
        assert!((0..3).all(|c| (color[c] - expected[c]).abs() < 1e-5), "{name}: {color:?}");
        color
    };
    for metal in METALS {
        let color = color(metal.name);
        assert!(color.luminance() > 0.45 && color.max_channel() < 1.0, "{}: {color:?}", metal.name);
    }
    let (gold, copper, silver) = (color("gold"), color("Cu"), color("SILVER"));
    assert!(gold.r > gold.g + 0.1 && gold.g > gold.b + 0.3, "yellow: {gold:?}");
    assert!(copper.r > copper.g + 0.2 && copper.g > copper.b, "red: {copper:?}");
    assert!(silver.b > 0.95, "white: {silver:?}");
    assert!(color("aluminum").g > 0.9 && color("iron").g < 0.6);
    assert_eq!(Metal::by_name("unobtainium"), None);
}

#[test]
fn a_bsdf_is_small() {
    assert!(size_of::<Bsdf>() <= 96, "{} bytes", size_of::<Bsdf>());
}
