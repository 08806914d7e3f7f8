//! The integrator: wavefront against naive path by path, determinism, and closed forms.

#![cfg(feature = "embree")]

use crate::support::scenes::{cornell, cornell_shot};

#[test]
fn look() {
    let world = cornell().build();
    let shot = cornell_shot([256, 256], 64);
    let r = shot.render(&world);
    let px = r.film.develop();
    let rgb = glint::image::develop(&px.radiance, 0.0, glint::image::ToneMap::None);
    glint::image::write_png(std::path::Path::new("/tmp/cornell.png"), &rgb, 256, 256).unwrap();
    eprintln!("{:?} {}", r.ledger, r.seconds);
}

#[test]
fn naive_eq() {
    let world = cornell().build();
    let shot = cornell_shot([64, 64], 8);
    let a = shot.wavefront_samples(&world);
    let b = shot.naive_samples(&world);
    let mut worst = 0f32;
    for (a, b) in a.iter().zip(b) {
        let d = (a.radiance - b).map(f32::abs).max_channel();
        worst = worst.max(d / (1e-6 + b.max_channel()));
    }
    eprintln!("worst {worst}");
}
