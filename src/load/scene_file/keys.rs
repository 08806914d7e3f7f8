//! Tests that `scenes/README.md` lists every key of the format, and no other.

use super::*;
use serde::de::value::Error as PlainError;
use serde::de::{Deserializer, Error as _, Visitor};

/// Answers nothing, but notes which fields a table asks for.
struct FieldNames<'f>(&'f mut Vec<&'static str>);

impl<'de> Deserializer<'de> for FieldNames<'_> {
    type Error = PlainError;

    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> std::result::Result<V::Value, PlainError> {
        Err(PlainError::custom("not a table"))
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> std::result::Result<V::Value, PlainError> {
        self.0.extend(fields);
        self.deserialize_any(visitor)
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit
        unit_struct newtype_struct seq tuple tuple_struct map enum identifier ignored_any
    }
}

/// The keys of the table that `T` is read from.
fn keys<'de, T: Deserialize<'de>>() -> Vec<&'static str> {
    let mut names = Vec::new();
    assert!(T::deserialize(FieldNames(&mut names)).is_err());
    names
}

/// Every table under its heading in the README.
fn tables() -> Vec<(&'static str, Vec<&'static str>)> {
    use value::Fraction;
    vec![
        ("the file", keys::<Document>()),
        ("[film]", keys::<settings::FilmTable>()),
        ("[render]", keys::<settings::RenderTable>()),
        ("[camera.NAME]", keys::<camera::CameraTable>()),
        ("perspective", keys::<camera::Perspective>()),
        ("thin_lens", keys::<camera::ThinLens>()),
        ("orthographic", keys::<camera::Orthographic>()),
        ("panoramic", keys::<camera::Panoramic>()),
        ("[[object]]", keys::<place::ObjectTable>()),
        ("transforms", keys::<transform::TransformTable>()),
        ("rotate", keys::<transform::AxisAngle>()),
        ("[model.NAME]", keys::<place::ModelTable>()),
        ("[material.NAME]", keys::<material::MaterialTable>()),
        ("lambert", keys::<material::Lambert>()),
        ("oren_nayar", keys::<material::OrenNayar>()),
        ("mirror", keys::<material::Mirror>()),
        ("dielectric", keys::<material::Dielectric>()),
        ("conductor", keys::<material::Conductor>()),
        ("plastic", keys::<material::Plastic>()),
        ("principled", keys::<material::Principled>()),
        ("colour texture", keys::<texture::ColorTexture<Fraction>>()),
        ("number texture", keys::<texture::ScalarTexture>()),
        ("normal_map", keys::<texture::NormalMap>()),
        ("bump_map", keys::<texture::BumpMap>()),
        ("[light]", keys::<light::LightTables>()),
        ("[[light.point]]", keys::<light::PointLight>()),
        ("[[light.spot]]", keys::<light::Spot>()),
        ("[[light.directional]]", keys::<light::Directional>()),
        ("[environment]", keys::<light::EnvironmentTable>()),
        ("[environment.constant]", keys::<light::Constant>()),
        ("[environment.image]", keys::<light::ImageTable>()),
        ("[environment.sky]", keys::<light::Sky>()),
    ]
}

#[test]
fn the_readme_lists_every_key() {
    let readme = include_str!("../../../scenes/README.md");
    let mut written: Vec<(&str, Vec<&str>)> = Vec::new();
    for line in readme.lines() {
        if let Some(heading) = line.strip_prefix("#### ") {
            written.push((heading.trim_matches('`'), Vec::new()));
        } else if let Some(row) = line.strip_prefix("| `")
            && let Some((_, keys)) = written.last_mut()
        {
            keys.push(row.split('`').next().unwrap());
        }
    }
    assert_eq!(written, tables());
}
