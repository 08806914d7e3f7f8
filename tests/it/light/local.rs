//! Point, spot and triangle lights against closed forms; and parameters that no light can have.

use super::integrate;
use glint::light::{
    ConstantEnvironment, DirectionalLight, ImageEnvironment, PointLight, Sky, SkyParameters,
    SpotLight, orientation, triangle,
};
use glint::math::fun::double;
use glint::math::{DVec3, Rgb, Vec3};
use std::f64::consts::PI;

#[test]
fn a_point_falls_off_with_the_square_of_the_distance() {
    let light = PointLight::new(DVec3::new(1.0, 2.0, 3.0), Rgb::new(8.0, 4.0, 2.0)).unwrap();
    let sample = light.sample(Vec3::new(1.0, 0.0, 3.0)).unwrap();
    assert_eq!((sample.direction, sample.distance, sample.is_delta), (Vec3::Y, 2.0, true));
    assert_eq!(sample.radiance, Rgb::new(2.0, 1.0, 0.5));
    assert_eq!(light.sample(Vec3::new(1.0, 2.0, 3.0)), None);
    let power = 4.0 * PI as f32 * Rgb::new(8.0, 4.0, 2.0).luminance();
    assert!((light.power_estimate() / power - 1.0).abs() < 1e-6);
}

#[test]
fn a_spot_is_full_inside_dark_outside_and_emits_its_power() {
    let axis = DVec3::new(0.3, -0.8, 0.5).normalize();
    let across = axis.cross(DVec3::X).normalize();
    let intensity = Rgb::new(4.0, 5.0, 6.0);
    for [inner, outer] in [[20.0, 30.0], [0.0, 60.0], [45.0, 45.0], [90.0, 180.0]] {
        let light = SpotLight::new(DVec3::ZERO, axis * 7.0, intensity, [inner, outer]).unwrap();
        // A surface at distance 1 along a direction receives the intensity there.
        let intensity_along = |direction: Vec3| {
            light.sample(direction).map_or(0.0, |sample| {
                f64::from(sample.radiance.luminance() * direction.length_squared())
            })
        };
        let fraction = |cosine: f64| {
            let direction = axis * cosine + across * (1.0 - cosine * cosine).max(0.0).sqrt();
            intensity_along(direction.as_vec3()) / f64::from(intensity.luminance())
        };
        let cosine = |degrees: f64| double::cos(degrees.to_radians());
        for degrees in (0..=180).map(f64::from) {
            if degrees < inner {
                assert!((fraction(cosine(degrees)) - 1.0).abs() < 1e-5);
            } else if degrees > outer {
                assert_eq!(fraction(cosine(degrees)), 0.0);
            }
        }
        // A smooth step in the cosine: at quarters, 3/16 - 2/64 and so on.
        if inner < outer {
            for (t, step) in [(0.25, 0.156_25), (0.5, 0.5), (0.75, 0.843_75)] {
                let here = fraction(cosine(outer) + t * (cosine(inner) - cosine(outer)));
                assert!((here - step).abs() < 1e-4, "{inner} {outer} {t}: {here}");
            }
        }
        let power = integrate(400, |direction| [intensity_along(direction)])[0];
        let ratio = f64::from(light.power_estimate()) / power;
        assert!((ratio - 1.0).abs() < 3e-3, "{inner} {outer}: {ratio}");
    }
}

/// The mean of 1 / pdf is the solid angle of the triangle, which van Oosterom and Strackee give in closed
/// form ("The Solid Angle of a Plane Triangle", 1983).
#[test]
fn a_triangle_sampled_by_area_covers_its_solid_angle() {
    let vertices = [Vec3::new(-1.0, 0.5, 2.0), Vec3::new(1.5, 0.0, 1.5), Vec3::new(0.0, 2.0, 3.0)];
    let [a, b, c] = vertices.map(|v| v.as_dvec3());
    let denominator = a.length() * b.length() * c.length()
        + a.dot(b) * c.length()
        + b.dot(c) * a.length()
        + c.dot(a) * b.length();
    let truth = 2.0 * double::atan2(a.dot(b.cross(c)).abs(), denominator);
    let normal = (vertices[1] - vertices[0]).cross(vertices[2] - vertices[0]).normalize();
    let pdf_area = 1.0 / triangle::area(&vertices);
    let n = 512;
    let mut estimate = 0.0;
    for i in 0..n * n {
        let u = [((i % n) as f32 + 0.5) / n as f32, ((i / n) as f32 + 0.5) / n as f32];
        let (point, [b1, b2]) = triangle::sample_area(&vertices, u);
        let rebuilt = vertices[0] * (1.0 - b1 - b2) + vertices[1] * b1 + vertices[2] * b2;
        assert!((point - rebuilt).length() < 1e-5 && b1 >= 0.0 && b2 >= 0.0 && b1 + b2 <= 1.0);
        // Seen from the origin, from behind as well as from the front.
        let (distance, cos_theta) = (point.length(), normal.dot(point) / point.length());
        let pdf = triangle::pdf_solid_angle(pdf_area, distance, cos_theta);
        assert_eq!(pdf, triangle::pdf_solid_angle(pdf_area, distance, -cos_theta));
        estimate += 1.0 / f64::from(pdf) / f64::from(n * n);
    }
    assert!((estimate / truth - 1.0).abs() < 1e-4, "{estimate} instead of {truth}");
}

#[test]
fn wrong_parameters_are_errors() {
    let nan = f64::NAN;
    let bad_color = Rgb::new(1.0, -1.0, 0.0);
    let y = DVec3::Y;
    let sky = SkyParameters {
        elevation: 30.0,
        azimuth: 0.0,
        turbidity: 3.0,
        ground_albedo: Rgb::splat(0.3),
        scale: 1.0,
        up: y,
    };
    let wrong = [
        PointLight::new(DVec3::new(nan, 0.0, 0.0), Rgb::WHITE).is_err(),
        PointLight::new(DVec3::ZERO, bad_color).is_err(),
        PointLight::new(DVec3::splat(1e300), Rgb::WHITE).is_err(),
        SpotLight::new(DVec3::ZERO, DVec3::ZERO, Rgb::WHITE, [1.0, 2.0]).is_err(),
        SpotLight::new(DVec3::ZERO, y, Rgb::WHITE, [3.0, 2.0]).is_err(),
        SpotLight::new(DVec3::ZERO, y, Rgb::WHITE, [0.0, nan]).is_err(),
        SpotLight::new(DVec3::ZERO, y, Rgb::WHITE, [0.0, 0.0]).is_err(),
        DirectionalLight::new(DVec3::ZERO, Rgb::WHITE, 0.0).is_err(),
        DirectionalLight::new(y, Rgb::WHITE, -1.0).is_err(),
        DirectionalLight::new(y, Rgb::WHITE, 181.0).is_err(),
        DirectionalLight::new(y, bad_color, 0.0).is_err(),
        ConstantEnvironment::new(Rgb::splat(f32::INFINITY)).is_err(),
        ImageEnvironment::new(vec![], 0, orientation(y, 0.0)).is_err(),
        ImageEnvironment::new(vec![Rgb::WHITE; 5], 2, orientation(y, 0.0)).is_err(),
        Sky::new(&SkyParameters { elevation: 91.0, ..sky }).is_err(),
        Sky::new(&SkyParameters { azimuth: nan, ..sky }).is_err(),
        Sky::new(&SkyParameters { turbidity: 0.5, ..sky }).is_err(),
        Sky::new(&SkyParameters { ground_albedo: Rgb::splat(1.5), ..sky }).is_err(),
        Sky::new(&SkyParameters { scale: -1.0, ..sky }).is_err(),
    ];
    assert_eq!(wrong, [true; 19]);
}
