//! The stages of the wavefront, in their order.

macro_rules! stages {
    ($($(#[doc = $doc:literal])* $stage:ident = $name:literal,)*) => {
        /// A stage of the wavefront.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Stage {
            $($(#[doc = $doc])* $stage,)*
        }

        impl Stage {
            /// Every stage, in order.
            pub const ALL: &'static [Self] = &[$(Self::$stage,)*];
            /// How many there are.
            pub(super) const COUNT: usize = Self::ALL.len();

            /// Name in tables and JSON.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$stage => $name,)*
                }
            }
        }
    };
}

stages! {
    /// Camera rays into free slots.
    Generate = "generate",
    /// Points on the lens for them.
    Lens = "lens",
    /// Closest hits.
    Intersect = "intersect",
    /// Rays that leave the scene to the lights at infinity.
    Environment = "environment",
    /// Hits to surface interactions.
    Interact = "interact",
    /// The same where texture coordinates, footprints and normal maps are needed.
    Details = "details",
    /// Emission found by the rays themselves.
    Emit = "emit",
    /// Materials to scattering models.
    Materials = "materials",
    /// The same where textures are looked up.
    Textures = "textures",
    /// Choosing lights and evaluating BSDFs towards them.
    SampleLights = "sample lights",
    /// Shadow rays.
    Shadow = "shadow",
    /// Choosing the next directions.
    Scatter = "scatter",
    /// Russian roulette and compaction.
    Roulette = "roulette",
    /// Finished paths into the film.
    Accumulate = "accumulate",
}
