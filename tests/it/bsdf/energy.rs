//! How much energy the scattering models return: white ones all of it, coloured ones less.
//!
//! Deterministic: the samples are a lattice, so the bounds can be tight.

use super::{all_models, direction, glass, paint, principled, white_metal};
use crate::support::effort;
use glint::bsdf::*;
use glint::math::{ONE_MINUS_EPSILON, Rgb, Vec3};

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
