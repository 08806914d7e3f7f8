//! FLIP: what an observer notices who switches between two pictures, from 0 to 1.
//!
//! Source: P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström and M. Fairchild, FLIP: A Difference Evaluator
//! for Alternating Images, Proceedings of the ACM on Computer Graphics and Interactive Techniques 3(2), 2020, whose
//! sections and numbers are meant here; for radiance, P. Andersson, J. Nilsson, P. Shirley and T. Akenine-Möller,
//! Visualizing Errors in Rendered High Dynamic Range Images, Eurographics Short Papers, 2021.

mod color;
mod features;
mod sensitivity;

use super::PIXELS_PER_DEGREE;
use super::field::Field;
use crate::image::ToneMap;
use crate::math::fun::double::{ln, pow};
use crate::math::{Rgb, fun};
use color::Space;
use rayon::prelude::*;

/// More exposures than this tell no more: half a minute of stops.
const MOST_EXPOSURES: usize = 32;

/// Of pictures for a screen, linear in [0, 1].
pub(super) fn ldr(picture: &[Rgb], reference: &[Rgb], size: [u32; 2]) -> Field {
    let space = Space::new();
    let shown = |pixels: &[Rgb]| -> Vec<Rgb> {
        pixels.par_iter().map(|pixel| pixel.map(|c| c.clamp(0.0, 1.0))).collect()
    };
    let opponent = |pixels: &[Rgb]| space.opponent(&shown(pixels), size);
    let (picture, reference) = (opponent(picture), opponent(reference));

    // Colours as they are seen from afar, and how far they are from each other (section 4.1).
    let seen = |planes: &[Field; 3]| sensitivity::filtered(planes, PIXELS_PER_DEGREE);
    let colors = space.differences(&seen(&picture), &seen(&reference), size);

    // Edges and points that one picture has and the other has not (section 4.2) make them larger (section 4.3).
    let luminance = |planes: &[Field; 3]| planes[0].clone();
    let features =
        features::differences(&luminance(&picture), &luminance(&reference), PIXELS_PER_DEGREE);
    colors.zip(&features, |color, feature| pow(color, 1.0 - feature))
}

/// Of radiance: the largest of the differences at exposures from where the brightest pixel of the reference is nearly white to
/// where its median is. Black pictures are compared unexposed.
pub(super) fn hdr(
    picture: &[Rgb],
    reference: &[Rgb],
    size: [u32; 2],
    progress: &dyn Fn(usize, usize),
) -> Field {
    let at = |stops: f64| {
        let scale = fun::pow(2.0, stops as f32);
        let shown = |pixels: &[Rgb]| -> Vec<Rgb> {
            pixels.par_iter().map(|pixel| ToneMap::Aces.apply(*pixel * scale)).collect()
        };
        ldr(&shown(picture), &shown(reference), size)
    };
    let [start, stop] = exposures(reference);
    let count = ((stop - start).ceil().max(2.0) as usize).min(MOST_EXPOSURES);
    let step = (stop - start) / (count - 1) as f64;
    let maps = (0..count).map(|k| {
        progress(k, count);
        at(start + k as f64 * step)
    });
    let largest = maps.reduce(|largest, map| largest.zip(&map, f64::max));
    largest.unwrap_or_else(|| at(start))
}

/// The first exposure and the last, stops (equations 4 and 5 of the second paper).
fn exposures(reference: &[Rgb]) -> [f64; 2] {
    let mut luminances: Vec<f32> = reference.iter().map(|pixel| pixel.luminance()).collect();
    luminances.sort_unstable_by(f32::total_cmp);
    let [brightest, mut median] =
        [luminances.len() - 1, luminances.len() / 2].map(|i| luminances[i]);
    if brightest <= 0.0 {
        return [0.0; 2];
    }
    if median <= 0.0 {
        // Mostly black: the middle of what is not.
        let black = luminances.partition_point(|luminance| *luminance <= 0.0);
        median = luminances[black + (luminances.len() - black) / 2];
    }
    let nearly_white = nearly_white();
    [brightest, median]
        .map(|luminance| ln(nearly_white / f64::from(luminance)) / std::f64::consts::LN_2)
}

/// The luminance that the tone map takes to 0.85.
fn nearly_white() -> f64 {
    let shown = |luminance: f64| f64::from(ToneMap::Aces.apply(Rgb::splat(luminance as f32)).g);
    let (mut low, mut high) = (0.0, 16.0);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if shown(middle) < 0.85 { low = middle } else { high = middle }
    }
    high
}
