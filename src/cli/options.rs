//! Settings as the options that say them: what a picture's header keeps, so that it can be made again.

use super::args::Up;
use super::select::Settings;
use crate::film::Region;
use crate::image::ToneMap;
use crate::math::DVec3;
use crate::render::Aov;
use crate::scene::{Camera, Projection};

/// The options of `glint render` that resolve to `settings` and `camera`, whatever the scene file says of them, in a world
/// whose sky is `up`. What a camera has beyond position and field of view only a scene file can say.
pub(super) fn of(settings: &Settings, camera: &Camera, up: DVec3) -> String {
    let Settings { region, filter, exposure, aovs, .. } = settings;
    let [width, height] = settings.size;
    let mut options = vec![
        format!("--size {width}x{height}"),
        format!("--spp {}", settings.samples_per_pixel),
        format!("--seed {}", settings.seed),
        format!("--sampler {}", settings.sampler.name()),
        format!("--filter {filter}"),
        format!("--effects {}", settings.effects),
        format!("--tonemap {}", word(&ToneMap::ALL, settings.tonemap)),
    ];
    if *region != Region::full(settings.size) {
        let Region { start: [x0, y0], end: [x1, y1] } = region;
        options.push(format!("--crop {x0},{y0},{x1},{y1}"));
    }
    if settings.max_depth < u32::MAX {
        options.push(format!("--max-depth {}", settings.max_depth));
    }
    options.extend(exposure.map(|stops| format!("--exposure {stops}")));
    if !aovs.is_empty() {
        let names: Vec<&str> = aovs.iter().map(|aov| word(&Aov::ALL, *aov)).collect();
        options.push(format!("--aov {}", names.join(",")));
    }
    options.push(format!("--up {}", if up == Up::Z.direction() { "z" } else { "y" }));
    let point = |p: DVec3| format!("{},{},{}", p.x, p.y, p.z);
    options.push(format!("--camera-from {}", point(camera.from)));
    options.push(format!("--camera-to {}", point(camera.to)));
    options.push(format!("--camera-up {}", point(camera.up)));
    match camera.projection {
        Projection::Perspective { vertical_fov } | Projection::ThinLens { vertical_fov, .. } => {
            options.push(format!("--fov {vertical_fov}"));
        }
        Projection::Orthographic { .. } | Projection::Panoramic => {}
    }
    options.join(" ")
}

/// What a value is called in the table of all.
fn word<T: Copy + PartialEq>(all: &[(&'static str, T)], value: T) -> &'static str {
    all.iter().find(|(_, known)| *known == value).map_or("", |(name, _)| name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::args::{Command, Glint, Render};
    use crate::scene::SceneSettings;
    use clap::Parser;

    fn parsed(options: &str) -> Render {
        let line = ["glint", "render", "a.obj"].into_iter().chain(options.split_whitespace());
        match Glint::try_parse_from(line).expect("it parses").command {
            Command::Render(args) => *args,
            _ => unreachable!(),
        }
    }

    #[test]
    fn options_resolve_to_the_settings_that_they_say() {
        let camera = Camera {
            name: "near".into(),
            location: None,
            from: DVec3::new(0.1, -1e-7, 4_400_000.123),
            to: DVec3::new(1.0 / 3.0, 0.0, 4.5e6),
            up: DVec3::Y,
            projection: Projection::Perspective { vertical_fov: 33.3 },
        };
        for said in [
            "",
            "--size 97x31 --spp 7 --seed 18446744073709551615 --sampler pmj02 --filter lanczos:2.5",
            "--crop 1,2,30,40 --max-depth 3 --exposure -1.25 --tonemap aces --aov normal,variance",
            "--effects all,no-refraction",
            "--effects whitted,no-caustics --filter tent",
            "--effects diffuse",
        ] {
            let settings = Settings::resolve(&parsed(said), &SceneSettings::default()).unwrap();
            let written = of(&settings, &camera, DVec3::Z);
            // A scene file that says something else, too.
            let file = SceneSettings {
                samples_per_pixel: Some(9),
                seed: Some(5),
                sampler: Some("random".into()),
                filter: Some("box".into()),
                effects: Some("direct".into()),
                tonemap: Some("none".into()),
                ..SceneSettings::default()
            };
            let args = parsed(&written);
            let again = Settings::resolve(&args, &file).unwrap();
            assert_eq!(format!("{again:?}"), format!("{settings:?}"), "{written}");
            assert_eq!(args.up, Some(Up::Z), "{written}");
            assert_eq!(args.camera_from, Some(camera.from), "{written}");
            assert_eq!(args.camera_to, Some(camera.to), "{written}");
            assert_eq!((args.camera_up, args.fov), (Some(camera.up), Some(33.3)), "{written}");
        }
    }
}
