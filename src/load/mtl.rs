//! Reads MTL libraries: statements to records, one a material; the records' meaning is `mtl_material`'s.
//!
//! Written out rather than left to `tobj`, whose MTL half panics on `Kd 0.5`, drops a whole library for one
//! bad line, knows neither texture options nor the PBR keys, and has no line numbers. Here a malformed
//! statement costs that statement, with a warning. Sources: Wavefront's MTL specification (1995), and the
//! PBR extension of Exocortex (`Pr Pm Pc Pcr Ps aniso anisor norm`). Keys are matched without case.

use super::image_request::ImageTable;
use super::line_filter::{Statement, Statements};
use super::mtl_material::Context;
use super::mtl_texture::{TextureStatement, parse_texture};
use super::warning_list::WarningList;
use crate::error::{Location, Result, Warning};
use crate::math::Rgb;
use crate::scene::Material;
use std::path::Path;

/// What a library says of one material; `None` where it says nothing.
#[derive(Clone, Debug, Default)]
pub(super) struct MtlRecord {
    pub(super) name: String,
    /// Line of its `newmtl`.
    pub(super) line: usize,
    pub(super) diffuse: Option<Rgb>,
    pub(super) specular: Option<Rgb>,
    pub(super) emission: Option<Rgb>,
    pub(super) transmittance: Option<Rgb>,
    /// Phong exponent `Ns`.
    pub(super) exponent: Option<f32>,
    /// Index of refraction `Ni`.
    pub(super) eta: Option<f32>,
    /// `d`: 1 opaque.
    pub(super) dissolve: Option<f32>,
    /// `Tr`: 0 opaque.
    pub(super) transparency: Option<f32>,
    pub(super) illumination: Option<f32>,
    pub(super) roughness: Option<f32>,
    pub(super) metallic: Option<f32>,
    pub(super) clearcoat: Option<f32>,
    pub(super) clearcoat_roughness: Option<f32>,
    pub(super) sheen: Option<f32>,
    pub(super) anisotropy: Option<f32>,
    /// In turns.
    pub(super) anisotropy_rotation: Option<f32>,
    pub(super) diffuse_map: Option<TextureStatement>,
    pub(super) specular_map: Option<TextureStatement>,
    pub(super) emission_map: Option<TextureStatement>,
    pub(super) dissolve_map: Option<TextureStatement>,
    pub(super) bump_map: Option<TextureStatement>,
    pub(super) normal_map: Option<TextureStatement>,
    pub(super) roughness_map: Option<TextureStatement>,
    pub(super) metallic_map: Option<TextureStatement>,
}

/// Where the value of a statement goes, and what values it may have.
enum Slot<'a> {
    /// A colour of channels from 0 to the bound; larger ones are cut to it.
    Color(&'a mut Option<Rgb>, f32),
    /// A number between the bounds; others are cut to them.
    Number(&'a mut Option<f32>, f32, f32),
    /// An image.
    Map(&'a mut Option<TextureStatement>),
}

/// Every key that has a meaning, in lower case.
const KEYS: &str = "newmtl kd ks ke tf ns ni d tr illum pr pm pc pcr ps aniso anisor map_kd map_ks map_ke \
    map_d map_bump bump map_norm norm map_pr map_pm ka map_ka";

/// Keys of effects that are not rendered: worth a word, since the picture will lack them.
const UNSUPPORTED: &str = "disp map_disp decal refl map_refl map_ns map_tr map_tf map_ps map_pc map_pcr \
    map_aniso map_anisor map_rma";

/// Whether `key` is in one of the lists above.
fn is_in(list: &str, key: &str) -> bool {
    list.split(' ').any(|listed| listed == key)
}

impl MtlRecord {
    /// The place of the value of `key` (in lower case); `None` for keys without a place.
    fn slot(&mut self, key: &str) -> Option<Slot<'_>> {
        Some(match key {
            "kd" => Slot::Color(&mut self.diffuse, 1.0),
            "ks" => Slot::Color(&mut self.specular, 1.0),
            "ke" => Slot::Color(&mut self.emission, f32::MAX),
            "tf" => Slot::Color(&mut self.transmittance, 1.0),
            "ns" => Slot::Number(&mut self.exponent, 0.0, f32::MAX),
            // A vacuum bubble in diamond has 0.41; below is a mistake.
            "ni" => Slot::Number(&mut self.eta, 0.1, 10.0),
            "d" => Slot::Number(&mut self.dissolve, 0.0, 1.0),
            "tr" => Slot::Number(&mut self.transparency, 0.0, 1.0),
            "illum" => Slot::Number(&mut self.illumination, 0.0, 10.0),
            "pr" => Slot::Number(&mut self.roughness, 0.0, 1.0),
            "pm" => Slot::Number(&mut self.metallic, 0.0, 1.0),
            "pc" => Slot::Number(&mut self.clearcoat, 0.0, 1.0),
            "pcr" => Slot::Number(&mut self.clearcoat_roughness, 0.0, 1.0),
            "ps" => Slot::Number(&mut self.sheen, 0.0, 1.0),
            "aniso" => Slot::Number(&mut self.anisotropy, -1.0, 1.0),
            "anisor" => Slot::Number(&mut self.anisotropy_rotation, -1.0, 1.0),
            "map_kd" => Slot::Map(&mut self.diffuse_map),
            "map_ks" => Slot::Map(&mut self.specular_map),
            "map_ke" => Slot::Map(&mut self.emission_map),
            "map_d" => Slot::Map(&mut self.dissolve_map),
            "map_bump" | "bump" => Slot::Map(&mut self.bump_map),
            "norm" | "map_norm" => Slot::Map(&mut self.normal_map),
            "map_pr" => Slot::Map(&mut self.roughness_map),
            "map_pm" => Slot::Map(&mut self.metallic_map),
            _ => return None,
        })
    }
}

/// Loads every material of the library at `path`. Their images are requested from `images`, warnings
/// are appended to `warnings`.
///
/// # Errors
/// When the file cannot be read or is not text.
pub fn load_mtl(
    path: &Path,
    images: &mut ImageTable,
    warnings: &mut Vec<Warning>,
) -> Result<Vec<Material>> {
    let mut found = WarningList::default();
    let records = read_mtl(path, &mut found)?;
    let mut context = Context { library: path, images, warnings: &mut found };
    let materials = records.iter().map(|record| context.material(record)).collect();
    warnings.extend(found.finish(path));
    Ok(materials)
}

/// Reads the records of the library at `path`.
///
/// # Errors
/// When the file cannot be read or is not text.
pub(super) fn read_mtl(path: &Path, warnings: &mut WarningList) -> Result<Vec<MtlRecord>> {
    let mut statements = Statements::open(path)?;
    let mut records: Vec<MtlRecord> = Vec::new();
    while let Some(statement) = statements.next()? {
        let key = statement.keyword.to_lowercase();
        if key == "newmtl" {
            let name = statement.name().to_string();
            if name.is_empty() {
                let location = Location::new(path, statement.line);
                warnings.add("nameless materials", location, || "newmtl needs a name".to_string());
            }
            records.push(MtlRecord { name, line: statement.line, ..Default::default() });
            continue;
        }
        let mut warn = |kind, message: String| {
            warnings.add(kind, Location::new(path, statement.line), || message);
        };
        let Some(record) = records.last_mut() else {
            if is_in(KEYS, &key) {
                let message = format!("{:?} stands before any newmtl; ignored", shown(statement));
                warn("statements without a material", message);
            }
            continue;
        };
        if let Some(slot) = record.slot(&key) {
            match fill(slot, statement) {
                Ok(None) => {}
                Ok(Some(repair)) => {
                    warn("values out of range", format!("{:?}: {repair}", shown(statement)));
                }
                Err(reason) => {
                    let message = format!("{:?}: {reason}; statement dropped", shown(statement));
                    warn("malformed statements", message);
                }
            }
        } else if is_in(UNSUPPORTED, &key) {
            let message = format!("{:?}: not rendered; ignored", shown(statement));
            warn("unsupported statements", message);
        } else if let Some(meant) = similar_key(&key) {
            let message = format!(
                "{:?} is no statement of MTL files; did you mean {meant}?",
                shown(statement)
            );
            warn("unknown statements", message);
        }
    }
    Ok(records)
}

/// The beginning of a statement, for messages.
fn shown(statement: Statement<'_>) -> String {
    statement.text.chars().take(80).collect()
}

/// A key that `key` may be a misspelling of.
fn similar_key(key: &str) -> Option<&'static str> {
    let is_near = |known: &&str| key.len() > 2 && strsim::osa_distance(key, known) == 1;
    if is_in(KEYS, key) { None } else { KEYS.split(' ').find(is_near) }
}

/// Parses the arguments of `statement` into `slot`.
///
/// # Errors
/// A message when they are malformed; `slot` is left as it was. `Ok` holds a message when they had to be
/// cut to their range.
fn fill(slot: Slot<'_>, statement: Statement<'_>) -> std::result::Result<Option<String>, String> {
    match slot {
        Slot::Map(map) => {
            *map = Some(parse_texture(statement.name(), statement.line)?);
            Ok(None)
        }
        Slot::Color(color, bound) => {
            let parsed = parse_color(statement.numbers())?;
            let cut = parsed.map(|x| x.clamp(0.0, bound));
            *color = Some(cut);
            Ok((cut != parsed).then(|| format!("channels are cut to 0..{bound}")))
        }
        Slot::Number(number, low, high) => {
            let words = statement.numbers();
            let parsed = match words.split_whitespace().next() {
                Some(word) => parse_number(word)?,
                None => return Err("a number is missing".to_string()),
            };
            let cut = parsed.clamp(low, high);
            *number = Some(cut);
            Ok((cut != parsed).then(|| format!("taken as {cut}")))
        }
    }
}

/// `r g b`, or `r` alone for a grey.
fn parse_color(text: &str) -> std::result::Result<Rgb, String> {
    let mut words = text.split_whitespace();
    match (words.next(), words.next(), words.next()) {
        (Some(method @ ("spectral" | "xyz")), ..) => {
            Err(format!("colours by {method} are not supported; give r g b"))
        }
        (Some(grey), None, _) => Ok(Rgb::splat(parse_number(grey)?)),
        (Some(r), Some(g), Some(b)) => {
            Ok(Rgb::new(parse_number(r)?, parse_number(g)?, parse_number(b)?))
        }
        _ => Err("a colour has three numbers".to_string()),
    }
}

/// A finite number.
pub(super) fn parse_number(word: &str) -> std::result::Result<f32, String> {
    let number: f32 = word.parse().map_err(|_| format!("{word:?} is not a number"))?;
    if number.is_finite() { Ok(number) } else { Err(format!("{word:?} is not finite")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_has_a_place_and_every_place_a_key() {
        let mut record = MtlRecord::default();
        for key in KEYS.split(' ') {
            let has_place = record.slot(key).is_some();
            assert_eq!(has_place, !["newmtl", "ka", "map_ka"].contains(&key), "{key}");
        }
        for key in UNSUPPORTED.split(' ') {
            assert!(record.slot(key).is_none() && !is_in(KEYS, key), "{key}");
        }
    }

    #[test]
    fn misspellings_are_noticed_and_extensions_are_not() {
        for (key, meant) in [("mapkd", "map_kd"), ("ilum", "illum"), ("map_kb", "map_kd")] {
            assert_eq!(similar_key(key), Some(meant));
        }
        for key in ["km", "kt", "sharpness", "map_aat", "ka", "vendor_key"] {
            assert_eq!(similar_key(key), None, "{key}");
        }
    }

    #[test]
    fn colours() {
        assert_eq!(parse_color("0.5").unwrap(), Rgb::splat(0.5));
        assert_eq!(parse_color("0.1 0.2 0.3 0.4").unwrap(), Rgb::new(0.1, 0.2, 0.3));
        for text in ["", "1 2", "1 2 x", "nan 0 0", "1 inf 1", "spectral a.rfl", "xyz 1 1 1"] {
            assert!(parse_color(text).is_err(), "{text}");
        }
    }
}
