//! Valid files with bytes flipped, cut and inserted: whatever comes of it loads, or is an error; never a
//! panic. What loads has sound meshes, and the same surface as the slow reference parser finds.

#![expect(clippy::unwrap_used, clippy::panic, reason = "a test may unwrap, and so may its helpers")]

use crate::support::reference_obj::{Face, assert_same, parse};
use glint::load::{ImageTable, LoadedModel, load_mtl, load_obj};
use glint::math::Rgb;
use glint::sampling::CounterRng;
use glint::scene::{ColorInput, Material, Surface};
use rand::Rng;
use std::path::Path;

/// Mutated files of each kind.
const CASES: u64 = 3000;

const OBJ: [&str; 3] = [
    "mtllib a.mtl\no box\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0 # up\nv 0 0 1\nusemtl red\nf 1 2 3 4\n\
     f 1 2 5\nusemtl blue\nf -1 -2 -3\n",
    "v 0.5 -1e-1 0 1 0 0\r\nv 1 0 0\r\nv 0 1 .25\r\nvt 0 0\r\nvt 1 0\r\nvt 0 1\r\nvn 0 0 1\r\n\
     f 1/1/1 2/2/1 3/3/1\r\nf 1//1 2//1 \\\r\n3//1\r\nf 1/1 2/2 3/3\r\nl 1 2\r\n",
    "g a\nv 4123456.5 1 2\nv 4123457.5 1 2\nv 4123457.5 2 2\nv 4123456.75 1.25 2\nv 4123456.5 2 2\n\
     s off\nf 1 2 3 4 5\ng b\nusemtl x y\nf 5 4 3\nf 1 3 5\n",
];

const MTL: [&str; 2] = [
    "newmtl red\nKa 0 0 0\nKd 0.8 0.1 0.1\nKs 0.5 0.5 0.5\nNs 96.5\nNi 1.45\nd 1.0\nillum 2\n\
     map_Kd -s 2 2 1 -o 0.5 0 0 my wood.png\nbump -bm 0.2 -clamp on b.png\nnewmtl glass\nillum 7\nTf 1 1 1\n",
    "newmtl a\r\nPr 0.3\r\nPm 1\r\nPc 0.1\r\nPcr 0.1\r\nPs 0.1\r\naniso 0.5\r\nanisor 0.25\r\nKe 1 2 3\r\n\
     map_Pr r.png\r\nmap_Pm m.png\r\nnorm n.png\r\nmap_d d.png\r\nmap_Ke e.png\r\nTr 0.5\r\n",
];

/// Pieces that are likelier to hurt than random bytes.
const PIECES: [&[u8]; 24] = [
    b"\n",
    b"\r",
    b"\\\n",
    b" ",
    b"\t",
    b"#",
    b" # ",
    b"/",
    b"//",
    b"-",
    b"0",
    b"-9",
    b"1e400",
    b"nan",
    b"inf",
    b"\xe9",
    b"\xef\xbb\xbf",
    b"\0",
    b"\nf 1 2 3\n",
    b"\nv 1 2\n",
    b"\nusemtl\n",
    b"-bm ",
    b"9223372036854775807",
    b"\nnewmtl\n",
];

/// `text` with one to six accidents.
fn mutated(text: &str, rng: &mut CounterRng) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    let mut below = |n: usize| rng.next_u32() as usize % n.max(1);
    for _ in 0..=below(6) {
        let at = below(bytes.len());
        match below(6) {
            0 if !bytes.is_empty() => bytes[at] ^= 1 << below(8),
            1 if !bytes.is_empty() => bytes[at] = below(256) as u8,
            2 => drop(bytes.drain(at..(at + below(12)).min(bytes.len()))),
            3 => bytes.truncate(bytes.len() - below(bytes.len() / 4)),
            4 => {
                let copy = bytes[at..(at + below(40)).min(bytes.len())].to_vec();
                let to = below(bytes.len());
                drop(bytes.splice(to..to, copy));
            }
            _ => drop(bytes.splice(at..at, PIECES[below(PIECES.len())].iter().copied())),
        }
    }
    bytes
}

/// Asserts everything that later stages rely on.
fn assert_sound(loaded: &LoadedModel) {
    for mesh in &loaded.model.meshes {
        let n = mesh.positions.len();
        assert!(!mesh.triangles.is_empty());
        assert!(mesh.triangles.iter().flatten().all(|&i| (i as usize) < n));
        assert!(
            mesh.positions.iter().flatten().all(|x| x.abs() < 1.2e18) && mesh.origin.is_finite()
        );
        assert!(mesh.uvs.is_empty() || mesh.uvs.len() == n);
        assert!(mesh.uvs.iter().flatten().all(|x| x.is_finite()));
        assert!(mesh.normals.is_empty() || mesh.normals.len() == n);
        let length = |n: &[f32; 3]| n.iter().map(|x| x * x).sum::<f32>();
        assert!(mesh.normals.iter().all(|n| (length(n) - 1.0).abs() < 1e-5));
        assert_eq!(mesh.triangles.len(), mesh.materials.len());
        assert_eq!(mesh.triangles.len(), mesh.lines.len());
        assert!(mesh.materials.iter().all(|id| id.index() < loaded.materials.len()));
    }
}

/// Whether a material can be rendered without losing or making energy.
fn assert_sane(material: &Material) {
    let in_unit = |c: ColorInput| {
        let Rgb { r, g, b } = c.value;
        assert!([r, g, b].iter().all(|x| (0.0..=1.0).contains(x)), "{material:?}");
    };
    match material.surface {
        Surface::Lambert { albedo } => in_unit(albedo),
        Surface::Mirror { reflectance } => in_unit(reflectance),
        Surface::Principled { base_color, specular, roughness, metallic, .. } => {
            in_unit(base_color);
            in_unit(specular);
            assert!(
                (0.0..=1.0).contains(&roughness.value) && (0.0..=1.0).contains(&metallic.value)
            );
        }
        Surface::Dielectric { eta, transmittance, roughness, .. } => {
            assert!((0.1..=10.0).contains(&eta) && (0.0..=1.0).contains(&roughness.value));
            in_unit(ColorInput::constant(transmittance));
        }
        ref other => panic!("{other:?}"),
    }
    assert!((0.0..=1.0).contains(&material.opacity.value));
    assert!(material.emission.is_none_or(|e| e.radiance.value.is_finite()));
}

fn write(folder: &Path, name: &str, content: &[u8]) -> std::path::PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, content).unwrap();
    path
}

#[test]
fn mutated_models_load_or_are_errors() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "a.mtl", MTL[0].as_bytes());
    let (mut loaded_some, mut refused_some) = (0, 0);
    for case in 0..CASES {
        let mut rng = CounterRng::new(case);
        let text = mutated(OBJ[case as usize % OBJ.len()], &mut rng);
        let name = format!("case {case}: {}", text.escape_ascii());
        let path = write(folder.path(), "m.obj", &text);
        match load_obj(&path) {
            Ok(loaded) => {
                loaded_some += 1;
                assert_sound(&loaded);
                assert_same(&loaded, &parse(&text), &name);
            }
            Err(error) => {
                refused_some += 1;
                let message = error.to_string();
                let nothing = parse(&text).iter().all(Face::is_flat);
                let flat_when_rounded = message.contains("zero area");
                assert!(text.contains(&0) || flat_when_rounded || nothing, "{name}: {message}");
            }
        }
    }
    assert!(loaded_some > CASES / 3 && refused_some > 20, "{loaded_some} {refused_some}");
}

#[test]
fn mutated_libraries_load_or_are_errors() {
    let folder = tempfile::tempdir().unwrap();
    let mut materials_seen = 0;
    for case in 0..CASES {
        let mut rng = CounterRng::new(case);
        let text = mutated(MTL[case as usize % MTL.len()], &mut rng);
        let path = write(folder.path(), "m.mtl", &text);
        let (mut images, mut warnings) = (ImageTable::new(), Vec::new());
        match load_mtl(&path, &mut images, &mut warnings) {
            Ok(materials) => {
                materials_seen += materials.len();
                materials.iter().for_each(assert_sane);
            }
            Err(error) => assert!(text.contains(&0), "case {case}: {error}"),
        }
    }
    assert!(materials_seen > CASES as usize);
}
