//! The material libraries of the models, as MTL.

use super::Kind;

/// Name, diffuse colour and what else is said of a material.
type Entry<'a> = (&'static str, [f32; 3], &'a str);

/// The library of `kind`; leaves are cut out by the image file `cut_out`.
pub(super) fn library(kind: Kind, cut_out: &str) -> String {
    let leaf = format!("map_d {cut_out}\n");
    let entries: &[Entry<'_>] = match kind {
        Kind::Terrain => &[("rock", [0.46, 0.41, 0.35], "")],
        Kind::City => &[
            ("asphalt", [0.12, 0.12, 0.125], ""),
            ("pavement", [0.3, 0.29, 0.28], ""),
            ("brick", [0.42, 0.24, 0.18], ""),
            ("concrete", [0.45, 0.44, 0.42], ""),
            ("plaster", [0.6, 0.55, 0.45], ""),
            ("pane", [0.03, 0.035, 0.04], "Ks 0.5 0.5 0.5\nNs 400\nillum 2\n"),
            ("warm", [0.1, 0.1, 0.1], "Ke 12 7.5 3.5\n"),
            ("neutral", [0.1, 0.1, 0.1], "Ke 9 8.5 7.5\n"),
            ("cool", [0.1, 0.1, 0.1], "Ke 5 7 9\n"),
        ],
        Kind::Sphereflake => &[
            ("even", [0.62, 0.5, 0.3], "Ks 0.5 0.5 0.5\nNs 200\nillum 2\n"),
            ("odd", [0.25, 0.38, 0.55], "Ks 0.5 0.5 0.5\nNs 200\nillum 2\n"),
            ("floor", [0.4, 0.4, 0.4], ""),
        ],
        Kind::Foliage => &[
            ("bark", [0.19, 0.13, 0.09], ""),
            ("leaf_dark", [0.07, 0.19, 0.04], &leaf),
            ("leaf", [0.13, 0.28, 0.06], &leaf),
            ("leaf_light", [0.24, 0.36, 0.08], &leaf),
            ("soil", [0.25, 0.23, 0.13], ""),
        ],
        Kind::Hairball => &[
            ("skin", [0.3, 0.2, 0.15], ""),
            ("hair", [0.5, 0.33, 0.18], ""),
            ("floor", [0.5, 0.5, 0.5], ""),
        ],
    };
    let mut text = String::new();
    for (name, [r, g, b], more) in entries {
        text += &format!("newmtl {name}\nKd {r} {g} {b}\n{more}\n");
    }
    text
}
