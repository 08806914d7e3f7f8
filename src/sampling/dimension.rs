//! The name of every random decision along a path.

/// What a random number is for. `bounce` counts path vertices: 0 is the camera ray's hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Dimension {
    /// Position within the pixel filter's support (two).
    Film,
    /// Point on the lens (two).
    Lens,
    /// Which light is sampled (one).
    LightSelect {
        /// Path vertex.
        bounce: u32,
    },
    /// Point on the light (two).
    LightPosition {
        /// Path vertex.
        bounce: u32,
    },
    /// Which lobe of the BSDF scatters (one).
    ScatterLobe {
        /// Path vertex.
        bounce: u32,
    },
    /// Direction of scattering (two).
    ScatterDirection {
        /// Path vertex.
        bounce: u32,
    },
    /// Russian roulette (one).
    Roulette {
        /// Path vertex.
        bounce: u32,
    },
}

impl Dimension {
    /// A number that no other dimension has.
    #[inline(always)]
    pub const fn index(self) -> u32 {
        const PER_BOUNCE: u32 = 8;
        match self {
            Self::Film => 0,
            Self::Lens => 1,
            Self::LightSelect { bounce } => PER_BOUNCE * (bounce + 1),
            Self::LightPosition { bounce } => PER_BOUNCE * (bounce + 1) + 1,
            Self::ScatterLobe { bounce } => PER_BOUNCE * (bounce + 1) + 2,
            Self::ScatterDirection { bounce } => PER_BOUNCE * (bounce + 1) + 3,
            Self::Roulette { bounce } => PER_BOUNCE * (bounce + 1) + 4,
        }
    }
}
