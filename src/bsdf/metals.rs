//! Optical constants of real metals, as linear Rec. 709 channels.
//!
//! Source: measurements of P. Johnson and R. Christy, Phys. Rev. B 6, 4370 (1972: copper, gold, silver) and
//! Phys. Rev. B 9, 5056 (1974: chromium, cobalt, iron, nickel, palladium, titanium); A. Rakic, Applied
//! Optics 34, 4755 (1995: aluminium); J. Weaver et al., Phys. Rev. B 12, 1293 (1975: tungsten).
//! Each channel is the measured curve, interpolated linearly, at the dominant wavelength of the Rec. 709
//! primary: 611, 549 and 464 nm. So the colours are those of three spectral lines, not an average over
//! the eye's sensitivities; gold and copper come out a little more saturated.

use crate::math::Rgb;

/// A metal with its complex index of refraction `eta + i k`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Metal {
    /// Lower-case English name.
    pub name: &'static str,
    /// Index of refraction.
    pub eta: Rgb,
    /// Extinction coefficient.
    pub k: Rgb,
}

impl Metal {
    /// The metal of that name, in any case; also by chemical symbol and, for aluminium, by its other
    /// spelling.
    pub fn by_name(name: &str) -> Option<&'static Self> {
        let name = name.to_ascii_lowercase();
        let name = match name.as_str() {
            "al" | "aluminum" => "aluminium",
            "cr" => "chromium",
            "co" => "cobalt",
            "cu" => "copper",
            "au" => "gold",
            "fe" => "iron",
            "ni" => "nickel",
            "pd" => "palladium",
            "ag" => "silver",
            "ti" => "titanium",
            "w" => "tungsten",
            name => name,
        };
        METALS.iter().find(|metal| metal.name == name)
    }
}

const fn metal(name: &'static str, eta: [f32; 3], k: [f32; 3]) -> Metal {
    Metal { name, eta: Rgb::new(eta[0], eta[1], eta[2]), k: Rgb::new(k[0], k[1], k[2]) }
}

/// All known metals, by name.
pub const METALS: [Metal; 11] = [
    metal("aluminium", [1.320, 1.011, 0.683], [7.31, 6.62, 5.62]),
    metal("chromium", [3.179, 3.180, 2.447], [3.30, 3.33, 3.21]),
    metal("cobalt", [2.180, 2.050, 1.786], [4.08, 3.82, 3.36]),
    metal("copper", [0.367, 1.016, 1.246], [3.12, 2.58, 2.45]),
    metal("gold", [0.223, 0.428, 1.335], [3.20, 2.46, 1.87]),
    metal("iron", [2.890, 2.950, 2.642], [3.04, 2.93, 2.80]),
    metal("nickel", [1.985, 1.920, 1.763], [3.98, 3.61, 3.04]),
    metal("palladium", [1.738, 1.640, 1.443], [4.18, 3.84, 3.34]),
    metal("silver", [0.058, 0.060, 0.046], [4.10, 3.59, 2.79]),
    metal("titanium", [2.658, 2.540, 2.303], [3.70, 3.43, 3.08]),
    metal("tungsten", [3.578, 3.522, 3.324], [2.88, 2.74, 2.57]),
];
