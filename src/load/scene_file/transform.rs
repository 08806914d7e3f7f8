//! The transform of an object: `matrix`, then `scale`, then `rotate`, then `translate`, in `f64`.
//!
//! A rotation by a multiple of 90 degrees has entries of exactly 0 and 1, so that what a user lines up
//! stays lined up.

use super::value::{Component, Degrees, Direction, List, Point, fixed};
use crate::math::fun::double;
use crate::math::{DAffine3, DMat3, DVec3};
use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, Error, IntoDeserializer, MapAccess, SeqAccess, Visitor};
use std::fmt;

/// The four keys of a transform, each optional.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct TransformTable {
    pub(super) matrix: Option<Matrix>,
    pub(super) scale: Option<Scale>,
    pub(super) rotate: Option<Rotation>,
    pub(super) translate: Option<Point>,
}

impl TransformTable {
    /// The map that applies the matrix first and the translation last.
    pub(super) fn affine(&self) -> DAffine3 {
        let matrix = self.matrix.map_or(DAffine3::IDENTITY, |matrix| matrix.0);
        let scale = self.scale.map_or(DMat3::IDENTITY, |scale| DMat3::from_diagonal(scale.0));
        let rotation = self.rotate.map_or(DMat3::IDENTITY, |rotation| rotation.0);
        let translation = self.translate.map_or(DVec3::ZERO, Point::vector);
        let linear = rotation * scale;
        DAffine3 {
            matrix3: linear * matrix.matrix3,
            translation: linear * matrix.translation + translation,
        }
    }
}

/// Whether `map` has an inverse that survives rounding to `f32`, and no size beyond 1e-15 to 1e15.
pub(super) fn is_regular(map: &DAffine3) -> bool {
    let [x, y, z] = [map.matrix3.x_axis, map.matrix3.y_axis, map.matrix3.z_axis];
    let sizes = [x.length(), y.length(), z.length()];
    // Volume of the image of the unit cube, over that of a box with the same edges.
    let volume = map.matrix3.determinant().abs() / sizes.iter().product::<f64>();
    sizes.iter().all(|size| (1e-15..=1e15).contains(size))
        && volume > 1e-6
        && map.translation.abs().max_element() <= 1e15
}

/// `scale = s` or `[x, y, z]`; negative mirrors.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale(DVec3);

impl<'de> Deserialize<'de> for Scale {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ScaleVisitor;
        impl<'de> Visitor<'de> for ScaleVisitor {
            type Value = DVec3;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number or [x, y, z]")
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<DVec3, E> {
                Component::deserialize(value.into_deserializer()).map(|v| DVec3::splat(v.0))
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<DVec3, E> {
                self.visit_f64(value as f64)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, sequence: A) -> Result<DVec3, A::Error> {
                fixed(sequence, &self).map(|v: [Component; 3]| DVec3::from_array(v.map(|v| v.0)))
            }
        }
        let factors = deserializer.deserialize_any(ScaleVisitor)?;
        match factors.abs().min_element() {
            0.0 => Err(D::Error::custom("a scale of 0 flattens the object: use another number")),
            _ => Ok(Self(factors)),
        }
    }
}

/// `rotate = [x, y, z]`, degrees about the fixed axes x, then y, then z; or `{ axis, angle }`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rotation(DMat3);

/// `rotate = { axis = [x, y, z], angle = degrees }`, counter-clockwise as seen from the axis' tip.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AxisAngle {
    axis: Direction,
    angle: Degrees,
}

impl<'de> Deserialize<'de> for Rotation {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct RotationVisitor;
        impl<'de> Visitor<'de> for RotationVisitor {
            type Value = DMat3;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("[x, y, z] in degrees, or { axis = [x, y, z], angle = degrees }")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, sequence: A) -> Result<DMat3, A::Error> {
                let [x, y, z] = fixed::<Degrees, 3, A>(sequence, &self)?.map(|angle| angle.0);
                Ok(about(DVec3::Z, z) * about(DVec3::Y, y) * about(DVec3::X, x))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<DMat3, A::Error> {
                let table = AxisAngle::deserialize(MapAccessDeserializer::new(map))?;
                Ok(about(table.axis.0.normalize(), table.angle.0))
            }
        }
        deserializer.deserialize_any(RotationVisitor).map(Self)
    }
}

/// `matrix = [[..4], [..4], [..4]]`: rows, as on paper; a fourth row must be `[0, 0, 0, 1]`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Matrix(DAffine3);

impl<'de> Deserialize<'de> for Matrix {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let rows = Vec::<List<Component, 4>>::deserialize(deserializer)?;
        let rows: Vec<[f64; 4]> = rows.into_iter().map(|row| row.0.map(|v| v.0)).collect();
        let (Some([x, y, z]), [] | [[0.0, 0.0, 0.0, 1.0]]) =
            (rows.first_chunk::<3>(), rows.get(3..).unwrap_or_default())
        else {
            return Err(D::Error::custom(
                "a matrix has three rows of four numbers; a fourth one can only be [0, 0, 0, 1]",
            ));
        };
        let column = |i: usize| DVec3::new(x[i], y[i], z[i]);
        let map = DAffine3::from_cols(column(0), column(1), column(2), column(3));
        if !is_regular(&map) {
            return Err(D::Error::custom(
                "this matrix is singular: it flattens the object, so it has no inverse",
            ));
        }
        Ok(Self(map))
    }
}

/// Rotation by `degrees` about the unit vector `axis` (Rodrigues' formula).
fn about(axis: DVec3, degrees: f64) -> DMat3 {
    let (sin, cos) = sin_cos_degrees(degrees);
    // The image of v: v cos + (axis x v) sin + axis (axis . v) (1 - cos).
    let image = |v: DVec3| v * cos + axis.cross(v) * sin + axis * axis.dot(v) * (1.0 - cos);
    DMat3::from_cols(image(DVec3::X), image(DVec3::Y), image(DVec3::Z))
}

/// (sin, cos) of an angle in degrees, exact at multiples of 90.
fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    let turn = degrees % 360.0;
    let quarters = (turn / 90.0).round();
    let rest = (turn - 90.0 * quarters).to_radians();
    let (sin, cos) = (double::sin(rest), double::cos(rest));
    match quarters as i32 & 3 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sine_and_cosine_of_degrees() {
        for quarter in -9..9_i32 {
            let exact = [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)];
            let (sin, cos) = sin_cos_degrees(f64::from(quarter) * 90.0);
            assert_eq!((sin, cos), exact[quarter.rem_euclid(4) as usize]);
        }
        for degree in -800..800 {
            let degrees = f64::from(degree) * 0.93;
            let (sin, cos) = sin_cos_degrees(degrees);
            let radians = degrees.to_radians();
            assert!((sin - double::sin(radians)).abs() < 1e-13);
            assert!((cos - double::cos(radians)).abs() < 1e-13);
        }
    }

    #[test]
    fn rotations_are_counter_clockwise() {
        assert_eq!(about(DVec3::Z, 90.0) * DVec3::X, DVec3::Y);
        assert_eq!(about(DVec3::X, 90.0) * DVec3::Y, DVec3::Z);
        assert_eq!(about(DVec3::Y, 90.0) * DVec3::Z, DVec3::X);
        let skew = DVec3::new(1.0, 2.0, -2.0) / 3.0;
        let turned = about(skew, 33.0);
        assert!((turned * skew - skew).length() < 1e-15);
        assert!((turned.determinant() - 1.0).abs() < 1e-15);
        assert!((about(skew, -33.0) * turned - DMat3::IDENTITY).determinant().abs() < 1e-15);
    }

    #[test]
    fn flat_maps_are_singular_at_every_size() {
        let regular = |scale: DVec3| is_regular(&DAffine3::from_scale(scale));
        assert!(regular(DVec3::new(1e-9, 1e9, -1.0)));
        assert!(!regular(DVec3::new(1.0, 0.0, 1.0)));
        assert!(!regular(DVec3::new(1.0, f64::NAN, 1.0)));
        let sheared = DMat3::from_cols(DVec3::X, DVec3::X + 1e-8 * DVec3::Y, DVec3::Z);
        assert!(!is_regular(&DAffine3::from_mat3(sheared)));
    }
}
