//! Kinds of lights, by how a direction to one is chosen and how sharp the shadows are that it throws.

/// A kind of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LightKind {
    /// A point that radiates equally in all directions.
    Point,
    /// A point that radiates into a cone.
    Spot,
    /// A single direction.
    Direction,
    /// A disc at infinity: a sun.
    Disc,
    /// Emissive surfaces.
    Surface,
    /// The same radiance from everywhere.
    Constant,
    /// An image around the scene, a sky's included.
    Image,
}

impl LightKind {
    /// Every kind.
    pub const ALL: [Self; 7] = [
        Self::Point,
        Self::Spot,
        Self::Direction,
        Self::Disc,
        Self::Surface,
        Self::Constant,
        Self::Image,
    ];

    /// Whether it is a point or a single direction: no ray ever meets it, and its shadows are hard.
    pub const fn is_delta(self) -> bool {
        matches!(self, Self::Point | Self::Spot | Self::Direction)
    }

    /// Whether it is so far away that rays which leave the scene see it.
    pub const fn is_seen_at_infinity(self) -> bool {
        matches!(self, Self::Disc | Self::Constant | Self::Image)
    }
}
