//! Which effects of light a render simulates, as users name the sets of them.

/// A set of effects.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Effects {
    /// Path tracing: every effect that a scene calls for.
    #[default]
    Path,
}

impl Effects {
    /// Every set with its name.
    pub const ALL: [(&'static str, Self); 1] = [(Self::Path.name(), Self::Path)];

    /// The name that users know it by.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Path => "path",
        }
    }
}
