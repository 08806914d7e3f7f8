//! The stages of the wavefront, in their order.

use crate::error::named_set;

named_set! {
    /// A stage of the wavefront.
    Stage {
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
}
