//! The values that keys take: numbers with a range, vectors, colours.
//!
//! The range is checked where the value is read, so that the error has the value's own line and says
//! what is allowed. Numbers are rounded to `f32` first where that is what they are kept in.

use crate::math::{DVec3, Rgb};
use serde::de::{
    Deserialize, Deserializer, Error, IntoDeserializer, SeqAccess, Unexpected, Visitor,
};
use std::fmt;
use std::marker::PhantomData;

/// A number that knows its range.
pub(super) trait Ranged: for<'de> Deserialize<'de> {
    /// The range in words, after "expected".
    const EXPECTED: &'static str;
    /// The number.
    fn get(&self) -> f64;
}

/// Defines numbers by name, range in words, and range; all of them are finite.
macro_rules! ranged {
    ($($(#[$doc:meta])* $name:ident($float:ty): $expected:literal, $valid:expr;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub(super) struct $name(pub(super) $float);

        impl Ranged for $name {
            const EXPECTED: &'static str = $expected;
            fn get(&self) -> f64 {
                f64::from(self.0)
            }
        }

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let valid: fn($float) -> bool = $valid;
                let in_range = |v: f64| (v as $float).is_finite() && valid(v as $float);
                deserializer
                    .deserialize_f64(NumberVisitor { expected: $expected, in_range })
                    .map(|v| Self(v as $float))
            }
        }
    )*};
}

ranged! {
    /// A number without a range.
    Finite(f32): "a finite number", |_| true;
    /// An eta, a colour channel of eta, or the like.
    Positive(f32): "a number above 0", |v| v > 0.0;
    /// Radiance, absorption.
    NonNegative(f32): "a number of at least 0", |v| v >= 0.0;
    /// Reflectance, roughness, opacity.
    Fraction(f32): "a number from 0 to 1", |v| (0.0..=1.0).contains(&v);
    /// Anisotropy.
    SignedFraction(f32): "a number from -1 to 1", |v| (-1.0..=1.0).contains(&v);
    /// A radius of a lens; 0 is a pinhole.
    Radius(f64): "a length from 0 to 1e15", |v| (0.0..=1e15).contains(&v);
    /// A length in the scene that cannot be 0: a distance, a height.
    Length(f64): "a length above 0 and up to 1e15", |v| v > 0.0 && v <= 1e15;
    /// One coordinate of a position: far beyond what `f64` resolves to a millimetre, far within `f32`.
    Coordinate(f64): "a coordinate from -1e15 to 1e15", |v| v.abs() <= 1e15;
    /// A number of a direction or a matrix.
    Component(f64): "a number from -1e15 to 1e15", |v| v.abs() <= 1e15;
    /// Any angle.
    Degrees(f64): "a finite angle in degrees", |_| true;
    /// A field of view.
    FieldOfView(f64): "an angle above 0 and below 180 degrees", |v| v > 0.0 && v < 180.0;
    /// A half-angle of a cone within which there is light.
    OuterAngle(f64): "an angle above 0 and up to 180 degrees", |v| v > 0.0 && v <= 180.0;
    /// Another half-angle of a cone, or an angular diameter.
    ConeAngle(f64): "an angle from 0 to 180 degrees", |v| (0.0..=180.0).contains(&v);
    /// Of the sun.
    Elevation(f64): "an angle from -90 to 90 degrees", |v| (-90.0..=90.0).contains(&v);
    /// Of the sky.
    Turbidity(f64): "a number from 1 (pure air) to 10 (haze)", |v| (1.0..=10.0).contains(&v);
    /// Multiplies the radiance of the sky.
    Factor(f64): "a number of at least 0", |v| v >= 0.0 && v <= f64::from(f32::MAX);
}

struct NumberVisitor<F> {
    expected: &'static str,
    in_range: F,
}

impl<F: Fn(f64) -> bool> Visitor<'_> for NumberVisitor<F> {
    type Value = f64;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.expected)
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<f64, E> {
        if (self.in_range)(value) {
            return Ok(value);
        }
        Err(E::custom(format!("{value} is out of range: expected {}", self.expected)))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<f64, E> {
        self.visit_f64(value as f64)
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<f64, E> {
        self.visit_f64(value as f64)
    }
}

/// A whole number from 1 to `MAX`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Count<const MAX: u64>(pub(super) u64);

impl<'de, const MAX: u64> Deserialize<'de> for Count<MAX> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct CountVisitor<const MAX: u64>;
        impl<const MAX: u64> Visitor<'_> for CountVisitor<MAX> {
            type Value = u64;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "a whole number from 1 to {MAX}")
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<u64, E> {
                u64::try_from(value)
                    .ok()
                    .filter(|value| (1..=MAX).contains(value))
                    .ok_or_else(|| E::invalid_value(Unexpected::Signed(value), &self))
            }
        }
        deserializer.deserialize_u64(CountVisitor::<MAX>).map(Self)
    }
}

/// Exactly `N` of `T` in brackets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct List<T, const N: usize>(pub(super) [T; N]);

impl<'de, T: Deserialize<'de>, const N: usize> Deserialize<'de> for List<T, N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ListVisitor<T, const N: usize>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>, const N: usize> Visitor<'de> for ListVisitor<T, N> {
            type Value = List<T, N>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "{N} numbers in brackets")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, sequence: A) -> Result<Self::Value, A::Error> {
                fixed(sequence, &self).map(List)
            }
        }
        deserializer.deserialize_seq(ListVisitor(PhantomData))
    }
}

/// Reads a sequence of exactly `N`; a shorter or longer one is an error that says what was `expected`.
pub(super) fn fixed<'de, T, const N: usize, A>(
    mut sequence: A,
    expected: &dyn serde::de::Expected,
) -> Result<[T; N], A::Error>
where
    T: Deserialize<'de>,
    A: SeqAccess<'de>,
{
    let mut items = Vec::with_capacity(N);
    while let Some(item) = sequence.next_element()? {
        items.push(item);
    }
    items.try_into().map_err(|items: Vec<T>| A::Error::invalid_length(items.len(), expected))
}

/// A point, `[x, y, z]`.
pub(super) type Point = List<Coordinate, 3>;

impl Point {
    /// The point as a vector.
    pub(super) fn vector(self) -> DVec3 {
        DVec3::from_array(self.0.map(|v| v.0))
    }
}

/// A direction of any length but 0, scaled so that its largest component is 1 in size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Direction(pub(super) DVec3);

impl<'de> Deserialize<'de> for Direction {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let vector = List::<Component, 3>::deserialize(deserializer)?;
        let vector = DVec3::from_array(vector.0.map(|v| v.0));
        match vector.abs().max_element() {
            0.0 => Err(D::Error::custom("a direction must not be [0, 0, 0]")),
            largest => Ok(Self(vector / largest)),
        }
    }
}

/// A colour, `[r, g, b]` in linear Rec. 709, or one number for all three; each channel in the range of `C`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Color<C> {
    pub(super) rgb: Rgb,
    range: PhantomData<C>,
}

impl<C> Color<C> {
    /// The colour `rgb`, unchecked.
    pub(super) const fn new(rgb: Rgb) -> Self {
        Self { rgb, range: PhantomData }
    }
}

impl<'de, C: Ranged> Deserialize<'de> for Color<C> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ColorVisitor<C>(PhantomData<C>);
        impl<'de, C: Ranged> Visitor<'de> for ColorVisitor<C> {
            type Value = Color<C>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "{} or a colour [r, g, b] of such", C::EXPECTED)
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<Self::Value, E> {
                let channel = C::deserialize(value.into_deserializer())?;
                Ok(Color::new(Rgb::splat(channel.get() as f32)))
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<Self::Value, E> {
                self.visit_f64(value as f64)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, sequence: A) -> Result<Self::Value, A::Error> {
                let channels: [C; 3] = fixed(sequence, &self)?;
                Ok(Color::new(Rgb::from(channels.map(|c| c.get() as f32))))
            }
        }
        deserializer.deserialize_any(ColorVisitor(PhantomData))
    }
}
