//! Procedural models: what is promised of every kind, and the command that writes them.

use glint::generate::{FEWEST_TRIANGLES, Kind, Model, Written, write_obj};
use std::io;

fn text(model: &Model) -> (Vec<u8>, Written) {
    let mut text = Vec::new();
    let written = write_obj(model, "model.mtl", &mut text, &mut |_| Ok(())).expect("memory");
    (text, written)
}

#[test]
fn every_kind_has_exactly_the_triangles_asked_for() {
    for (name, kind) in Kind::ALL {
        for triangles in [FEWEST_TRIANGLES, 2001, 4999, 10_000, 65_537, 200_003] {
            let (text, written) = text(&Model { kind, triangles, seed: 0 });
            let starting = |keyword: &[u8]| {
                text.split(|b| *b == b'\n').filter(|line| line.starts_with(keyword)).count() as u64
            };
            assert_eq!(starting(b"f "), triangles, "{name}");
            let expected =
                Written { triangles, vertices: starting(b"v "), bytes: text.len() as u64 };
            assert_eq!(written, expected, "{name}");
        }
        let mut model = Model { kind, triangles: FEWEST_TRIANGLES - 1, seed: 1 };
        let refused = write_obj(&model, "m.mtl", &mut Vec::new(), &mut |_| Ok(()));
        assert!(refused.is_err(), "{name}");
        model.triangles = 100_000;
        let stopped = write_obj(&model, "m.mtl", &mut Vec::new(), &mut |done| {
            if done < 5000 { Ok(()) } else { Err(io::ErrorKind::Interrupted.into()) }
        });
        assert!(stopped.is_err(), "{name}");
    }
}

#[test]
fn bytes_follow_from_the_seed() {
    for (name, kind) in Kind::ALL {
        let of = |seed| text(&Model { kind, triangles: 10_000, seed }).0;
        assert_eq!(of(0), of(0), "{name}");
        // The first line names the seed.
        let model = |seed| of(seed).splitn(2, |b| *b == b'\n').nth(1).map(<[u8]>::to_vec);
        assert_ne!(model(0), model(1), "{name}");
        assert_ne!(model(1), model(2), "{name}");
    }
}

#[cfg(feature = "embree")]
mod program {
    use super::*;
    use crate::support::program::Bench;
    use glint::load::load_scene;
    use glint::math::Vec3;

    fn generate(bench: &Bench, arguments: &[&str]) -> (i32, String) {
        let output = bench.glint(&[&["generate"], arguments].concat());
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.stdout.is_empty() && !said.contains("panicked"), "{said}");
        (output.status.code().unwrap_or(-1), said)
    }

    #[test]
    fn every_kind_loads_without_a_warning_and_has_no_flat_triangle() {
        for (name, _) in Kind::ALL {
            for triangles in ["10k", "123457"] {
                let bench = Bench::new();
                let (code, said) =
                    generate(&bench, &[name, "-o", "my model.obj", "--triangles", triangles]);
                assert_eq!(code, 0, "{said}");
                let count = triangles.replace('k', "000").parse::<usize>().unwrap();
                assert!(said.contains(&format!("{count} triangles, ")), "{said}");

                let scene = load_scene(&bench.path("my model.obj")).expect("a model");
                assert!(scene.warnings.is_empty(), "{name}: {:?}", scene.warnings);
                assert!(scene.materials.iter().all(|m| m.location.is_some()), "{name}");
                assert_eq!(scene.images.len(), usize::from(name == "foliage"));
                let meshes = || scene.models.iter().flat_map(|model| &model.meshes);
                assert_eq!(meshes().map(|m| m.triangles.len()).sum::<usize>(), count, "{name}");
                for mesh in meshes() {
                    let position = |i: u32| Vec3::from_array(mesh.positions[i as usize]);
                    assert!(mesh.positions.iter().flatten().all(|c| c.abs() < 1e5), "{name}");
                    for (i, corners) in mesh.triangles.iter().enumerate() {
                        let [a, b, c] = corners.map(position);
                        let area = (b - a).cross(c - a).length();
                        assert!(area > 0.0, "{name}, line {}", mesh.lines[i]);
                        let Some(normal) = mesh.normals.get(corners[0] as usize) else { continue };
                        let outwards = (b - a).cross(c - a).dot(Vec3::from_array(*normal));
                        assert!(outwards > 0.0, "{name}, line {}", mesh.lines[i]);
                    }
                }
            }
        }
    }

    #[test]
    fn the_command_writes_whole_models_and_says_so_unless_told_not_to() {
        let bench = Bench::new();
        let command = ["foliage", "-o", "grove.obj", "--triangles", "3k", "--seed", "9"];
        let (code, said) = generate(&bench, &[&command[..], &["--quiet"]].concat());
        assert_eq!((code, said.as_str()), (0, ""));
        assert_eq!(bench.names(), ["grove-leaf.png", "grove.mtl", "grove.obj"]);
        let first = std::fs::read(bench.path("grove.obj")).unwrap();
        let (code, said) = generate(&bench, &command);
        assert_eq!(code, 0, "{said}");
        for words in ["grove.obj, grove.mtl, grove-leaf.png: 3000 triangles", "vertices", "bytes"] {
            assert!(said.contains(words), "no `{words}` in {said}");
        }
        assert_eq!(std::fs::read(bench.path("grove.obj")).unwrap(), first);
        let (code, said) = bench.render(&["grove.obj", "--strict", "--env", "sky:40,90"]);
        assert_eq!(code, 0, "{said}");
    }

    #[test]
    fn wrong_usage_exits_with_2_and_leaves_nothing() {
        let bench = Bench::new();
        for (arguments, words) in [
            (&["mountain", "-o", "a.obj", "--triangles", "9k"][..], "Known: `terrain`, `city`"),
            (&["city", "-o", "a.obj", "--triangles", "0"], "above 0"),
            (&["city", "-o", "a.obj", "--triangles", "0M"], "above 0"),
            (&["city", "-o", "a.obj", "--triangles", "-5"], ""),
            (&["city", "-o", "a.obj", "--triangles", "99999999999G"], "above 0"),
            (&["city", "-o", "a.obj", "--triangles", "2MM"], "above 0"),
            (&["city", "-o", "a.obj", "--triangles", "1999"], "at least 2000"),
            (&["city", "-o", "a.ply", "--triangles", "9k"], "must be .obj"),
            (&["city", "-o", "a\nb.obj", "--triangles", "9k"], "cannot name"),
            (&["city", "--triangles", "9k"], "--output"),
            (&["city", "-o", "a.obj"], "--triangles"),
            (&["-o", "a.obj", "--triangles", "9k"], "KIND"),
        ] {
            let (code, said) = generate(&bench, arguments);
            assert_eq!(code, 2, "{arguments:?}: {said}");
            assert!(said.contains(words), "no `{words}` in {said}");
            assert!(bench.names().is_empty(), "{arguments:?}");
        }
    }

    #[test]
    fn an_interrupted_command_leaves_nothing() {
        let bench = Bench::new();
        let output = std::process::Command::new("timeout")
            .args([
                "--foreground",
                "--preserve-status",
                "--signal=INT",
                "0.5",
                env!("CARGO_BIN_EXE_glint"),
            ])
            .args(["generate", "terrain", "-o", "a.obj", "--triangles", "1G"])
            .current_dir(bench.folder())
            .output()
            .expect("glint starts");
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(130), "{said}");
        assert!(bench.names().is_empty(), "{:?}", bench.names());
    }

    #[test]
    fn what_cannot_be_written_exits_with_1_and_leaves_nothing() {
        let bench = Bench::new();
        let (code, said) = generate(&bench, &["city", "-o", "no/a.obj", "--triangles", "9k"]);
        assert!(code == 1 && said.contains("no/a.obj: cannot write"), "{code}: {said}");
        assert!(bench.names().is_empty());

        // The library's name is taken by a folder: no model without materials.
        std::fs::create_dir(bench.path("a.mtl")).unwrap();
        let (code, said) = generate(&bench, &["city", "-o", "a.obj", "--triangles", "9k"]);
        assert!(code == 1 && said.contains("a.mtl: cannot write"), "{code}: {said}");
        assert_eq!(bench.names(), ["a.mtl"]);
    }
}
