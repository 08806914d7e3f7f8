//! Cameras: rays against closed forms, and the automatic framing against the edges of the picture.

use glint::camera::{Camera, View, frame};
use glint::math::fun::double;
use glint::math::{DVec3, Vec3};
use glint::sampling::CounterRng;
use std::f64::consts::PI;

const SIZE: [u32; 2] = [640, 360];
const MIDDLE: [f32; 2] = [320.0, 180.0];
const LENS: [f32; 2] = [0.5, 0.5];

/// At the origin, looking along -z with y up: +x is right.
const VIEW: View = View { from: DVec3::ZERO, to: DVec3::new(0.0, 0.0, -5.0), up: DVec3::Y };

fn close(a: Vec3, b: Vec3) -> bool {
    (a - b).length() < 1e-6 * b.length().max(1.0)
}

/// A view in general position.
fn tilted() -> View {
    View {
        from: DVec3::new(4.0, -3.0, 2.0),
        to: DVec3::new(-1.0, 1.0, 7.0),
        up: DVec3::new(0.2, 2.0, 0.1),
    }
}

#[test]
fn known_pixels_look_in_known_directions() {
    let camera = Camera::perspective(&VIEW, SIZE, 60.0).unwrap();
    let direction = |film| camera.ray(film, LENS).ray.direction;
    assert_eq!(direction(MIDDLE), Vec3::NEG_Z);
    // Top and bottom edges are half the field of view away; the right edge follows from square pixels.
    let tangent = double::tan(PI / 6.0) as f32;
    let aspect = 640.0 / 360.0;
    assert!(close(direction([320.0, 0.0]), Vec3::new(0.0, tangent, -1.0).normalize()));
    assert!(close(direction([320.0, 360.0]), Vec3::new(0.0, -tangent, -1.0).normalize()));
    assert!(close(direction([640.0, 180.0]), Vec3::new(aspect * tangent, 0.0, -1.0).normalize()));
    assert!(close(direction([0.0, 0.0]), Vec3::new(-aspect * tangent, tangent, -1.0).normalize()));
    // A filter may ask beyond the edge.
    let beyond = 1.1 * tangent;
    assert!(close(direction([320.0, -18.0]), Vec3::new(0.0, beyond, -1.0).normalize()));
    assert!(!camera.needs_lens());
    assert_eq!(camera.ray(MIDDLE, [0.1, 0.9]), camera.ray(MIDDLE, LENS));
}

/// Whatever the view: `to` is in the middle, `up` is up, the basis is right-handed, directions have length 1.
#[test]
fn a_view_in_general_position() {
    let view = tilted();
    let camera = Camera::perspective(&view, SIZE, 35.0).unwrap();
    let forward = (view.to - view.from).normalize().as_vec3();
    assert!(close(camera.ray(MIDDLE, LENS).ray.direction, forward));
    // On the plane at distance 1.
    let across = |film| {
        let direction = camera.ray(film, LENS).ray.direction;
        direction / direction.dot(forward) - forward
    };
    let (right, top) = (across([640.0, 180.0]), across([320.0, 0.0]));
    let up = view.up.as_vec3();
    assert!(top.dot(up) > 0.0 && right.dot(up).abs() < 1e-6);
    assert!(right.cross(top).dot(forward) < 0.0);
    let mut rng = CounterRng::new(0);
    for _ in 0..1000 {
        let ray = camera.ray([640.0 * rng.unit(), 360.0 * rng.unit()], LENS).ray;
        assert!((ray.direction.length() - 1.0).abs() < 3e-7);
        assert_eq!(ray.origin, view.from.as_vec3());
    }
}

/// The spread squared is the solid angle of the pixel: over the picture they sum to the solid angle of a
/// rectangle, 4 asin(sin a sin b) with a, b the angles of its edges as seen along the axes; and
/// over a panorama to the sphere.
#[test]
fn spreads_cover_the_picture() {
    let sum = |camera: &Camera| {
        let mut sum = 0.0;
        for y in 0..SIZE[1] {
            for x in 0..SIZE[0] {
                let spread = camera.ray([x as f32 + 0.5, y as f32 + 0.5], LENS).spread;
                sum += f64::from(spread) * f64::from(spread);
            }
        }
        sum
    };
    let half_height = double::tan(PI / 4.0);
    let half_width = half_height * 640.0 / 360.0;
    let sine = |t: f64| t / (1.0 + t * t).sqrt();
    let rectangle = 4.0 * double::asin(sine(half_height) * sine(half_width));
    let perspective = sum(&Camera::perspective(&VIEW, SIZE, 90.0).unwrap());
    assert!((perspective / rectangle - 1.0).abs() < 1e-4, "{perspective} {rectangle}");
    let panorama = sum(&Camera::panoramic(&VIEW, SIZE).unwrap());
    assert!((panorama / (4.0 * PI) - 1.0).abs() < 1e-4, "{panorama}");
}

#[test]
fn parallel_rays_are_parallel() {
    let view = tilted();
    let camera = Camera::orthographic(&view, SIZE, 18.0).unwrap();
    let forward = (view.to - view.from).normalize().as_vec3();
    let corner = camera.ray([0.0, 0.0], LENS);
    let opposite = camera.ray([640.0, 360.0], LENS);
    assert!(close(corner.ray.direction, forward));
    assert_eq!(corner.ray.direction, opposite.ray.direction);
    // The diagonal of a picture of 32 by 18 units, across the view.
    let diagonal = opposite.ray.origin - corner.ray.origin;
    assert!((diagonal.length() - (32.0_f32 * 32.0 + 18.0 * 18.0).sqrt()).abs() < 1e-4);
    assert!(diagonal.dot(forward).abs() < 1e-5);
    assert!(close(0.5 * (opposite.ray.origin + corner.ray.origin), view.from.as_vec3()));
    assert_eq!((corner.spread, corner.initial_width), (0.0, 18.0 / 360.0));
    let plain = Camera::orthographic(&VIEW, SIZE, 18.0).unwrap();
    assert!(close(plain.ray([640.0, 0.0], LENS).ray.origin, Vec3::new(16.0, 9.0, 0.0)));
}

#[test]
fn a_panorama_has_its_poles_at_the_edges() {
    let camera = Camera::panoramic(&VIEW, SIZE).unwrap();
    let direction = |film| camera.ray(film, LENS).ray.direction;
    assert!(close(direction(MIDDLE), Vec3::NEG_Z));
    assert!(close(direction([480.0, 180.0]), Vec3::X));
    assert!(close(direction([160.0, 180.0]), Vec3::NEG_X));
    assert!(close(direction([0.0, 180.0]), Vec3::Z));
    assert!(close(direction([640.0, 180.0]), Vec3::Z));
    for x in [0.0, 123.0, 640.0] {
        assert!(close(direction([x, 0.0]), Vec3::Y));
        assert!(close(direction([x, 360.0]), Vec3::NEG_Y));
    }
    assert!(close(direction([320.0, 90.0]), Vec3::new(0.0, 1.0, -1.0).normalize()));
    // It is laid out as an image environment: a picture of one is the image again.
    let texels: Vec<_> = (0..32).map(|i| glint::math::Rgb::splat(i as f32)).collect();
    let unturned = glint::light::orientation(DVec3::Y, 0.0);
    let environment = glint::light::ImageEnvironment::new(texels, 8, unturned).unwrap();
    let camera = Camera::panoramic(&VIEW, [8, 4]).unwrap();
    for i in 0..32 {
        let film = [(i % 8) as f32 + 0.5, (i / 8) as f32 + 0.5];
        let radiance = environment.radiance(camera.ray(film, LENS).ray.direction);
        assert!((radiance.r - i as f32).abs() < 1e-4);
    }
}

/// All rays of one film point meet in the plane of focus; at depth z they fill a disc whose radius is the
/// lens's, scaled by |z - focus| / focus.
#[test]
fn a_lens_is_sharp_in_its_plane_of_focus() {
    let (radius, focus) = (0.3_f32, 4.0_f32);
    let view = tilted();
    let camera = Camera::thin_lens(&view, SIZE, 50.0, radius.into(), focus.into()).unwrap();
    let pinhole = Camera::perspective(&view, SIZE, 50.0).unwrap();
    assert!(camera.needs_lens());
    let forward = (view.to - view.from).normalize().as_vec3();
    let from = view.from.as_vec3();
    for film in [MIDDLE, [0.0, 0.0], [600.0, 100.0]] {
        // Where a ray is at a depth along the axis.
        let at_depth = |ray: glint::geometry::Ray, depth: f32| {
            ray.at((depth - (ray.origin - from).dot(forward)) / ray.direction.dot(forward))
        };
        let through = pinhole.ray(film, LENS).ray;
        let mut rng = CounterRng::new(0);
        for depth in [1.0, 4.0, 9.0] {
            let confusion = radius * (depth - focus).abs() / focus;
            let (mut widest, mut inside_half) = (0.0_f32, 0);
            let n = 20_000;
            for _ in 0..n {
                let ray = camera.ray(film, [rng.unit(), rng.unit()]).ray;
                assert!((ray.direction.length() - 1.0).abs() < 3e-7);
                let distance = (at_depth(ray, depth) - at_depth(through, depth)).length();
                widest = widest.max(distance);
                inside_half += u32::from(distance < confusion * 0.5_f32.sqrt());
            }
            assert!(widest <= confusion + 1e-5, "{widest} {confusion}");
            if confusion > 0.0 {
                assert!(widest > 0.99 * confusion);
                // Uniform: half of them are in half of the area. Six standard deviations of a binomial
                // (1e-8 for all six comparisons); a lens denser by 5 % in the middle fails.
                let deviation = (f64::from(inside_half) - 1e4) / (0.25_f64 * 2e4).sqrt();
                assert!(deviation.abs() < 6.0, "{deviation} standard deviations");
            }
        }
    }
    assert!(!Camera::thin_lens(&VIEW, SIZE, 50.0, 0.0, 4.0).unwrap().needs_lens());
}

/// Where the corners of a box are in the picture, as fractions of its half-width and half-height.
fn corners_in_picture(bounds: [DVec3; 2], view: &View, aspect: f64, fov: f64) -> Vec<[f64; 2]> {
    let forward = (view.to - view.from).normalize();
    let right = forward.cross(view.up).normalize();
    let up = right.cross(forward);
    let tangent = double::tan(0.5 * fov.to_radians());
    (0..8)
        .map(|i| {
            let pick = |axis: usize| bounds[i >> axis & 1][axis];
            let offset = DVec3::new(pick(0), pick(1), pick(2)) - view.from;
            let depth = offset.dot(forward);
            assert!(depth > 0.0, "behind the camera");
            [offset.dot(right) / (depth * tangent * aspect), offset.dot(up) / (depth * tangent)]
        })
        .collect()
}

#[test]
fn a_framed_box_fills_the_picture_up_to_the_margin() {
    let boxes = [
        [DVec3::splat(-1.0), DVec3::splat(1.0)],
        [DVec3::new(5.0, 0.0, -3.0), DVec3::new(45.0, 1.0, 2.0)],
        [DVec3::new(0.0, 0.0, 0.0), DVec3::new(1.0, 80.0, 1.0)],
        [DVec3::new(-7.0, 2.0, 1.0), DVec3::new(9.0, 2.0, 30.0)],
        [DVec3::splat(4e6), DVec3::new(4e6 + 3.0, 4e6 + 1.0, 4e6 + 2.0)],
        [DVec3::splat(-1e-7), DVec3::splat(2e-7)],
    ];
    for bounds in boxes {
        for up in [DVec3::Y, DVec3::Z] {
            for (aspect, fov) in [(16.0 / 9.0, 40.0), (0.5, 40.0), (1.0, 100.0), (2.0, 5.0)] {
                let view = frame(bounds, up, aspect, fov).unwrap();
                let corners = corners_in_picture(bounds, &view, aspect, fov);
                let extreme = |axis: usize| {
                    let values = corners.iter().map(|c| c[axis]);
                    (values.clone().fold(f64::MAX, f64::min), values.fold(f64::MIN, f64::max))
                };
                // Both ends of one axis touch the margin; nothing crosses it.
                let spans = [extreme(0), extreme(1)];
                let inside = |(low, high): (f64, f64)| low > -0.950_001 && high < 0.950_001;
                let touches = |(low, high): (f64, f64)| low < -0.949_999 && high > 0.949_999;
                assert!(spans.into_iter().all(inside), "{bounds:?} {up} {aspect}: {spans:?}");
                assert!(spans.into_iter().any(touches), "{bounds:?} {up} {aspect}: {spans:?}");
            }
        }
    }
}

/// From the front right and above: 30 degrees from the front, 20 degrees up.
#[test]
fn framing_looks_from_a_three_quarter_view() {
    let bounds = [DVec3::splat(-1.0), DVec3::splat(1.0)];
    for (up, front) in [(DVec3::Y, DVec3::Z), (DVec3::Z, DVec3::NEG_Y)] {
        let view = frame(bounds, up, 1.5, 40.0).unwrap();
        let back = (view.from - view.to).normalize();
        let degrees = |x: f64| x.to_degrees();
        assert!((degrees(double::asin(back.dot(up))) - 20.0).abs() < 1e-9);
        let azimuth = double::atan2(back.x, back.dot(front));
        assert!((degrees(azimuth) - 30.0).abs() < 1e-9);
        // `to` is in the middle of the box along the view, so that it can serve as a focus.
        assert!((view.to.dot(back)).abs() < 1e-9);
    }
    // A point is given an extent, so that the camera does not stand on it.
    let point = frame([DVec3::ONE, DVec3::ONE], DVec3::Y, 1.5, 40.0).unwrap();
    assert!((point.from - DVec3::ONE).length() > 0.5);
}

#[test]
fn degenerate_cameras_are_errors() {
    let nan = f64::NAN;
    let view = |from, to, up| View { from, to, up };
    let bad_views = [
        view(DVec3::ONE, DVec3::ONE, DVec3::Y),
        view(DVec3::ZERO, DVec3::Y, DVec3::Y),
        view(DVec3::ZERO, DVec3::Y, -3.0 * DVec3::Y),
        view(DVec3::ZERO, DVec3::X, DVec3::ZERO),
        view(DVec3::new(nan, 0.0, 0.0), DVec3::X, DVec3::Y),
        view(DVec3::ZERO, DVec3::new(0.0, f64::INFINITY, 0.0), DVec3::X),
        view(DVec3::splat(1e300), DVec3::X, DVec3::Y),
    ];
    for view in &bad_views {
        assert!(Camera::perspective(view, SIZE, 40.0).is_err(), "{view:?}");
        assert!(Camera::thin_lens(view, SIZE, 40.0, 0.1, 1.0).is_err(), "{view:?}");
        assert!(Camera::orthographic(view, SIZE, 40.0).is_err(), "{view:?}");
        assert!(Camera::panoramic(view, SIZE).is_err(), "{view:?}");
    }
    for number in [0.0, -1.0, nan, f64::INFINITY] {
        assert!(Camera::perspective(&VIEW, SIZE, number).is_err());
        assert!(Camera::orthographic(&VIEW, SIZE, number).is_err());
        assert!(Camera::thin_lens(&VIEW, SIZE, 40.0, 0.1, number).is_err());
        assert!(frame([DVec3::ZERO, DVec3::ONE], DVec3::Y, number, 40.0).is_err());
    }
    assert!(Camera::perspective(&VIEW, SIZE, 180.0).is_err());
    assert!(Camera::thin_lens(&VIEW, SIZE, 40.0, -0.1, 1.0).is_err());
    assert!(Camera::panoramic(&VIEW, [0, 3]).is_err());
    assert!(frame([DVec3::ONE, DVec3::ZERO], DVec3::Y, 1.0, 40.0).is_err());
    assert!(frame([DVec3::splat(nan), DVec3::ONE], DVec3::Y, 1.0, 40.0).is_err());
    assert!(frame([DVec3::INFINITY, DVec3::NEG_INFINITY], DVec3::Y, 1.0, 40.0).is_err());
    // The message says what to do.
    let message = Camera::perspective(&bad_views[1], SIZE, 40.0).unwrap_err().to_string();
    assert!(message.contains("choose another up"), "{message}");
}
