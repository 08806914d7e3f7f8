//! MTL libraries: every key changes the material that it should, and no line can do worse than be dropped.

#![expect(clippy::unwrap_used, clippy::panic, reason = "a test may unwrap, and so may its helpers")]

use glint::error::Warning;
use glint::load::{ColorSpace, ImageRequest, ImageTable, load_mtl};
use glint::math::Rgb;
use glint::scene::{
    Channel, ColorInput, ImageId, Material, NormalInput, ScalarInput, Surface, TextureReference,
};

/// A library as it was loaded.
struct Library {
    materials: Vec<Material>,
    images: Vec<ImageRequest>,
    warnings: Vec<Warning>,
}

/// Loads `text` as a library, beside the files `others`.
fn load_with(text: impl AsRef<[u8]>, others: &[&str]) -> Library {
    let folder = tempfile::tempdir().unwrap();
    for name in others {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, "").unwrap();
    }
    let path = folder.path().join("library.mtl");
    std::fs::write(&path, text).unwrap();
    let (mut images, mut warnings) = (ImageTable::new(), Vec::new());
    let materials = load_mtl(&path, &mut images, &mut warnings).unwrap();
    Library { materials, images: images.into_requests(), warnings }
}

/// The one material with these statements, which must raise no warning; without its location.
fn material(statements: &str) -> Material {
    let library = load_with(format!("newmtl m\n{statements}\n"), &[]);
    assert!(library.warnings.is_empty(), "{statements}: {:?}", library.warnings);
    let material = library.materials.into_iter().next().unwrap();
    assert_eq!(material.location.as_ref().unwrap().line, 1);
    Material { location: None, ..material }
}

fn surface(statements: &str) -> Surface {
    material(statements).surface
}

/// The messages that a material with these statements raises.
fn warnings(statements: &str) -> Vec<String> {
    let library = load_with(format!("newmtl m\n{statements}\n"), &[]);
    library.warnings.iter().map(|w| w.to_string()).collect()
}

fn grey(v: f32) -> ColorInput {
    ColorInput::constant(Rgb::splat(v))
}

fn plain_texture() -> TextureReference {
    TextureReference { image: ImageId(0), scale: [1.0; 2], offset: [0.0; 2], clamp: false }
}

fn close(a: f32, b: f32) -> bool {
    (a - b).abs() <= 1e-6 * b.abs()
}

/// What a principled surface is made of, for comparison by number.
fn principled(statements: &str) -> (ColorInput, ScalarInput, ScalarInput, ColorInput, [f32; 4]) {
    match surface(statements) {
        Surface::Principled {
            base_color,
            metallic,
            roughness,
            specular,
            anisotropy,
            clearcoat,
            clearcoat_roughness,
            sheen,
        } => {
            let rest = [anisotropy, clearcoat, clearcoat_roughness, sheen];
            (base_color, metallic, roughness, specular, rest)
        }
        other => panic!("{statements}: {other:?}"),
    }
}

#[test]
fn every_key_changes_the_material() {
    // A material for each key in which it has an effect, and the statement that has it.
    for (rest, statement) in [
        ("", "Kd 0.2 0.3 0.4"),
        ("", "Kd 0.2"),
        ("Ns 50", "Ks 0.5 0.5 0.5"),
        ("", "Ke 3 2 1"),
        ("illum 7", "Tf 0.5 0.9 0.5"),
        ("Ks 0.5", "Ns 50"),
        ("illum 7", "Ns 20"),
        ("illum 7", "Ni 1.33"),
        ("Pr 0.5", "Ni 1.33"),
        ("", "d 0.5"),
        ("", "Tr 0.5"),
        ("Ks 0.5\nNs 50", "illum 1"),
        ("Ks 0.5\nNs 50", "illum 3"),
        ("Kd 0\nKs 0.5", "illum 5"),
        ("", "illum 4"),
        ("", "illum 6"),
        ("", "illum 7"),
        ("", "illum 9"),
        ("", "Pr 0.3"),
        ("Pr 0.5", "Pm 1"),
        ("Pr 0.5", "Pc 0.5"),
        ("Pr 0.5", "Pcr 0.5"),
        ("Pr 0.5", "Ps 0.5"),
        ("Pr 0.5", "aniso 0.5"),
        ("aniso 0.5", "anisor 0.25"),
        ("", "map_Kd a.png"),
        ("Ks 0.5\nNs 50", "map_Ks a.png"),
        ("Ns 50", "map_Ks a.png"),
        ("", "map_Ke a.png"),
        ("Ke 2", "map_Ke a.png"),
        ("", "map_d a.png"),
        ("", "map_Bump a.png"),
        ("", "bump a.png"),
        ("", "map_bump a.png"),
        ("", "norm a.png"),
        ("", "map_Pr a.png"),
        ("Pr 0.5", "map_Pm a.png"),
        ("", "KD 0.2"),
    ] {
        let (without, with) = (material(rest), material(&format!("{rest}\n{statement}")));
        assert_ne!(without, with, "{rest:?} and {statement:?}");
    }
    for option in ["-s 2 2 2", "-o 0.5 0 0", "-clamp on", "-bm 0.5"] {
        let with = material(&format!("bump {option} a.png"));
        assert_ne!(with, material("bump a.png"), "{option}");
    }
    // And these change nothing.
    for statement in ["Ka 1 1 1", "map_Ka a.png", "sharpness 60", "Km 0.5", "illum 2", "d 1", "# x"]
    {
        assert_eq!(material(statement), material(""), "{statement}");
    }
}

#[test]
fn surfaces_follow_the_table() {
    assert_eq!(
        surface("Kd .2 .3 .4"),
        Surface::Lambert { albedo: ColorInput::constant(Rgb::new(0.2, 0.3, 0.4)) }
    );
    let glass = Surface::Dielectric {
        eta: 1.5,
        roughness: ScalarInput::constant(0.0),
        absorption: Rgb::BLACK,
        transmittance: Rgb::WHITE,
        thin: false,
    };
    for illum in [4, 6, 7, 9] {
        for ns in ["", "Ns 1", "Ns 200", "Ns 1000"] {
            assert_eq!(surface(&format!("illum {illum}\n{ns}\nKs 1\nKd 0")), glass, "{illum} {ns}");
        }
    }
    assert!(matches!(surface("illum 7\nPr 0.3"), Surface::Dielectric { roughness, .. }
        if roughness == ScalarInput::constant(0.3)));
    let mirror = Surface::Mirror { reflectance: grey(0.9) };
    assert_eq!(surface("illum 3\nKd 0 0 0\nKs 0.9 0.9 0.9"), mirror);
    assert_eq!(surface("illum 5\nKd 0.01 0.01 0.01\nKs 0.9 0.9 0.9\nNs 1000"), mirror);
    assert_eq!(surface("illum 5\nKs 0.9"), mirror);
    // A rough one is metal.
    let (base_color, metallic, roughness, ..) = principled("illum 5\nKd 0\nKs 0.9\nNs 30");
    assert_eq!((base_color, metallic.value), (grey(0.9), 1.0));
    assert!(close(roughness.value, 0.5));
    // One that reflects and is coloured keeps its energy.
    let (base_color, metallic, roughness, specular, _) = principled("illum 3\nKd 0.9\nKs 0.6");
    assert!(close(base_color.value.g, 0.6) && close(specular.value.g, 0.4), "{base_color:?}");
    assert_eq!((metallic.value, roughness.value), (0.0, 0.0));
    assert_eq!(surface("illum 3\nKd 0.5"), Surface::Lambert { albedo: grey(0.5) });
}

#[test]
fn phong_highlights_become_microfacets() {
    let (base_color, metallic, roughness, specular, rest) = principled("Kd .3\nKs .5\nNs 126");
    assert_eq!((base_color, metallic), (grey(0.3), ScalarInput::constant(0.0)));
    // alpha = sqrt(2 / 128) = 1/8.
    assert!(close(roughness.value * roughness.value, 0.125), "{roughness:?}");
    assert!(close(specular.value.r, 0.04));
    assert_eq!(rest, [0.0; 4]);
    // What exporters write when they mean nothing.
    let lambert = Surface::Lambert { albedo: grey(0.4) };
    assert_eq!(surface("Kd .4\nKs .4 .4 .4\nNs 1"), lambert);
    assert_eq!(surface("Kd .4\nKs 0 0 0\nNs 100"), lambert);
    assert_eq!(surface("Kd .4\nKs 1 1 1\nNs 100\nillum 1"), lambert);
    // However it is said, no surface reflects more than it receives.
    for ks in ["0", "0.5", "1"] {
        for kd in ["0.02", "0.5", "1"] {
            for illum in 0..=10 {
                let text = format!("Kd {kd}\nKs {ks}\nNs 300\nillum {illum}");
                let most = match surface(&text) {
                    Surface::Lambert { albedo } => albedo.value.g,
                    Surface::Mirror { reflectance } => reflectance.value.g,
                    Surface::Principled { base_color, specular, .. } if matches!(illum, 3 | 5) => {
                        base_color.value.g + specular.value.g
                    }
                    Surface::Principled { base_color, .. } => base_color.value.g,
                    _ => 1.0,
                };
                assert!(most <= 1.0 + 1e-6, "{text}");
            }
        }
    }
}

#[test]
fn the_pbr_extension_speaks_for_itself() {
    let (base_color, metallic, roughness, specular, rest) =
        principled("Kd .8\nPr .3\nPm .7\nPc .1\nPcr .2\nPs .4\naniso .5");
    assert_eq!((base_color, metallic.value, roughness.value), (grey(0.8), 0.7, 0.3));
    assert_eq!(specular, grey(0.04));
    assert_eq!(rest, [0.5, 0.1, 0.2, 0.4]);
    assert!(close(principled("Pr .3\nKs .5").3.value.r, 0.04));
    assert!(close(principled("Pr .3\nNi 2").3.value.r, 1.0 / 9.0));
    // A quarter turn stretches across instead of along.
    assert!(close(principled("aniso .5\nanisor .25").4[0], -0.5));
    let (_, metallic, roughness, ..) = principled("map_Pr a.png\nPm .5\nmap_Pm b.png");
    assert_eq!((roughness.value, metallic.value), (1.0, 0.5));
    assert_eq!(roughness.texture, Some((plain_texture_of(1), Channel::Red)));
    assert_eq!(metallic.texture, Some((plain_texture_of(0), Channel::Red)));
}

fn plain_texture_of(image: u32) -> TextureReference {
    TextureReference { image: ImageId(image), ..plain_texture() }
}

#[test]
fn emission_opacity_and_normals() {
    assert_eq!(material("Ke 0 0 0").emission, None);
    let emission = material("Ke 3 2 1").emission.unwrap();
    assert_eq!(emission.radiance, ColorInput::constant(Rgb::new(3.0, 2.0, 1.0)));
    let textured = ColorInput { value: Rgb::WHITE, texture: Some(plain_texture()) };
    assert_eq!(material("map_Ke a.png").emission.unwrap().radiance, textured);

    assert_eq!(material("d 0.25").opacity, ScalarInput::constant(0.25));
    assert_eq!(material("Tr 0.25").opacity, ScalarInput::constant(0.75));
    assert_eq!(material("Tr 1\nd 0.25").opacity, ScalarInput::constant(0.25));
    // Of glass it says how clear it is.
    assert_eq!(material("illum 7\nd 0.25").opacity, ScalarInput::constant(1.0));
    let alpha = |value| ScalarInput { value, texture: Some((plain_texture(), Channel::Alpha)) };
    let red = |value| ScalarInput { value, texture: Some((plain_texture(), Channel::Red)) };
    assert_eq!(material("map_Kd a.png\nd 0.5").opacity, alpha(0.5));
    assert_eq!(material("map_d a.png").opacity, red(1.0));
    let both = load_with("newmtl m\nmap_Kd a.png\nmap_d b.png", &[]);
    assert_eq!(both.materials[0].opacity.texture, Some((plain_texture_of(1), Channel::Red)));
    assert!(warnings("d 0")[0].contains("faces are invisible"));

    assert_eq!(material("norm a.png").normal, Some(NormalInput::Map(plain_texture())));
    let bump = NormalInput::Bump { texture: plain_texture(), strength: 0.3 };
    assert_eq!(material("map_Bump -bm 0.3 a.png").normal, Some(bump));
    // A normal map by any other name; its height would be nonsense.
    for file in ["brick_normal.png", "a\\brick_N.png", "BrickNRM.tga"] {
        let library = load_with(format!("newmtl m\nmap_Bump {file}\n"), &[]);
        assert_eq!(library.materials[0].normal, Some(NormalInput::Map(plain_texture())), "{file}");
        assert_eq!(library.warnings.len(), 1);
    }
}

#[test]
fn images_are_asked_for_once() {
    let text = "newmtl a\nmap_Kd wood.png\nmap_Ks wood.png\nbump -bm 2 wood.png\n\
                newmtl b\nmap_Kd ./wood.png\nmap_d sub\\leaf one.png\nmap_Ke none.png\n\
                newmtl c\nmap_Kd Sub/Leaf One.PNG\nmap_d D:\\work\\wood.png\n";
    let library = load_with(text, &["wood.png", "sub/leaf one.png"]);
    let requests: Vec<(String, ColorSpace, usize)> = library
        .images
        .iter()
        .map(|image| {
            let name = image.path.file_name().unwrap().to_string_lossy().into_owned();
            (name, image.color_space, image.location.line)
        })
        .collect();
    let expected = [
        ("wood.png", ColorSpace::Srgb, 2),
        ("wood.png", ColorSpace::Linear, 4),
        ("none.png", ColorSpace::Srgb, 8),
        ("leaf one.png", ColorSpace::Linear, 7),
        ("leaf one.png", ColorSpace::Srgb, 10),
    ];
    for (name, color_space, line) in expected {
        assert!(requests.contains(&(name.to_string(), color_space, line)), "{name} {requests:?}");
    }
    assert_eq!(requests.len(), expected.len());
    assert!(library.images[0].path.is_absolute(), "canonical where it exists");
    // Found under other names, with a word about it; the missing one is the decoder's to tell.
    let lines: Vec<usize> =
        library.warnings.iter().map(|w| w.location.as_ref().unwrap().line).collect();
    assert_eq!(lines, [10, 11]);
}

#[test]
fn textures_multiply_and_zero_does_not_blacken() {
    let with = |value| ColorInput { value, texture: Some(plain_texture()) };
    assert_eq!(surface("map_Kd a.png"), Surface::Lambert { albedo: with(Rgb::WHITE) });
    assert_eq!(surface("Kd .5\nmap_Kd a.png"), Surface::Lambert { albedo: with(Rgb::splat(0.5)) });
    let library = load_with("newmtl m\nKd 0 0 0\nmap_Kd a.png\n", &[]);
    assert_eq!(library.materials[0].surface, Surface::Lambert { albedo: with(Rgb::WHITE) });
    assert!(library.warnings[0].message.contains("taken as 1"));
}

#[test]
fn a_bad_statement_costs_itself_alone() {
    for bad in [
        "Kd",
        "Kd x",
        "Kd 0.5 0.5",
        "Kd nan 0 0",
        "Kd spectral a.rfl 1",
        "Kd xyz 1 1 1",
        "Ks 1e99",
        "Ns",
        "Ns -inf",
        "Ni x",
        "d",
        "d -halo 0.5",
        "illum",
        "illum two",
        "Tr x",
        "Pr",
        "map_Kd",
        "map_Kd -s a.png",
        "map_Kd -frob 1 a.png",
        "bump -bm a.png",
        "map_d -clamp",
        "norm  ",
        "mapKd a.png",
        "ilum 2",
        "disp a.png",
        "refl -type sphere a.png",
        "map_Ns a.png",
    ] {
        let text = format!("newmtl m\nKd 0.2 0.3 0.4\n{bad}\nKe 1 1 1\nnewmtl n\nKd 1\n");
        let library = load_with(text, &[]);
        assert_eq!(library.materials.len(), 2, "{bad}");
        let found = Material { location: None, ..library.materials[0].clone() };
        assert_eq!(found, material("Kd 0.2 0.3 0.4\nKe 1 1 1"), "{bad}");
        assert_eq!(library.warnings.len(), 1, "{bad}: {:?}", library.warnings);
        assert_eq!(library.warnings[0].location.as_ref().unwrap().line, 3, "{bad}");
    }
    // Out of range: cut, with a word.
    for (bad, good) in [
        ("Kd 255 0 0", "Kd 1 0 0"),
        ("Kd -1 0 0", "Kd 0 0 0"),
        ("d 1.5", "d 1"),
        ("Tr -1", "Tr 0"),
        ("Pr 7", "Pr 1"),
        ("illum 7\nNi 0", "illum 7\nNi 0.1"),
        ("illum 300", "illum 10"),
    ] {
        assert_eq!(warnings(bad).len(), 1, "{bad}");
        let library = load_with(format!("newmtl m\n{bad}\n"), &[]);
        assert_eq!(library.materials[0].surface, surface(good), "{bad}");
        assert_eq!(library.materials[0].opacity, material(good).opacity, "{bad}");
    }
}

#[test]
fn libraries_as_editors_write_them() {
    let text = "# x\nKd 1 0 0\nnewmtl my red # comment\n\tKd\t0.5 \\\n 0 0 # x\n\nnewmtl Material #25\nKd 0 1 0";
    for text in [text.to_string(), text.replace('\n', "\r\n"), format!("\u{feff}{text}")] {
        let library = load_with(&text, &[]);
        let names: Vec<&str> = library.materials.iter().map(|m| m.name.as_str()).collect();
        assert_eq!(names, ["my red", "Material #25"]);
        let lines: Vec<usize> =
            library.materials.iter().map(|m| m.location.as_ref().unwrap().line).collect();
        assert_eq!(lines, [3, 7]);
        let albedo = ColorInput::constant(Rgb::new(0.5, 0.0, 0.0));
        assert_eq!(library.materials[0].surface, Surface::Lambert { albedo });
        assert_eq!(library.warnings.len(), 1, "the Kd before any material");
    }
    assert_eq!(load_with(b"newmtl caf\xe9\n", &[]).materials[0].name, "café");
    assert!(load_with("", &[]).materials.is_empty());
}

#[test]
fn unreadable_libraries_are_errors() {
    let folder = tempfile::tempdir().unwrap();
    let load =
        |path: &std::path::Path| load_mtl(path, &mut ImageTable::new(), &mut Vec::new()).is_err();
    assert!(load(&folder.path().join("none.mtl")));
    assert!(load(folder.path()));
    std::fs::write(folder.path().join("binary.mtl"), b"newmtl a\n\0").unwrap();
    assert!(load(&folder.path().join("binary.mtl")));
}
