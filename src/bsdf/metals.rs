//! Optical constants of real metals, as linear Rec. 709 channels.
//!
//! Sources: P. Johnson and R. Christy, Phys. Rev. B 6, 4370 (1972: copper, silver) and Phys. Rev. B 9, 5056
//! (1974: chromium, cobalt, iron, nickel, palladium, titanium); A. Rakic, Applied Optics 34, 4755 (1995:
//! aluminium); R. Olmon et al., Phys. Rev. B 86, 235147 (2012: gold); J. Weaver et al., Phys. Rev. B 12, 1293
//! (1975: tungsten).
//! `scenes/metals.py` holds their spectra and makes this table. A channel reflects, at normal incidence, what
//! integrating the measured reflectance against the CIE 1931 observer under D65 gives; its `eta` is a mean over
//! the channel and its `k` follows. At other angles the channels stay within 0.015 of the spectral integral
//! (copper and gold in red: 0.04). Gold's red is outside of Rec. 709, at 1.04, and is clipped to 0.999.

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
    metal("aluminium", [1.273, 0.974, 0.648], [7.062, 6.509, 5.537]),
    metal("chromium", [3.127, 3.046, 2.368], [3.276, 3.328, 3.148]),
    metal("cobalt", [2.146, 2.016, 1.747], [4.141, 3.782, 3.264]),
    metal("copper", [0.505, 1.028, 1.246], [5.127, 2.611, 2.321]),
    metal("gold", [0.269, 0.454, 1.400], [32.778, 2.434, 1.632]),
    metal("iron", [2.889, 2.888, 2.585], [3.071, 2.936, 2.755]),
    metal("nickel", [1.963, 1.892, 1.745], [4.132, 3.565, 2.906]),
    metal("palladium", [1.710, 1.609, 1.419], [4.265, 3.801, 3.237]),
    metal("silver", [0.054, 0.054, 0.044], [4.365, 3.517, 2.619]),
    metal("titanium", [2.631, 2.496, 2.270], [3.792, 3.395, 3.025]),
    metal("tungsten", [3.569, 3.486, 3.337], [2.933, 2.751, 2.501]),
];
