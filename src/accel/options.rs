//! How a hierarchy is to be built: what may be spent on it, in time and in memory.
//!
//! The same words for every backend; what each makes of them is its own affair. Never changes which primitive
//! is hit.

/// How much a hierarchy may cost to build, against what it saves later.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Quality {
    /// Built in the shortest time.
    Fast,
    /// Best for most renders.
    #[default]
    Default,
    /// Traversed in the shortest time. Embree's robust mode has nothing better than its default.
    High,
}

impl Quality {
    /// Every quality with its name, lowest first.
    pub const ALL: [(&'static str, Self); 3] =
        [("fast", Self::Fast), ("default", Self::Default), ("high", Self::High)];

    /// Its name.
    pub fn name(self) -> &'static str {
        Self::ALL[self as usize].0
    }
}

/// How a hierarchy is built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BuildOptions {
    /// At most so many threads, or all if 0. Their number changes nothing in the result.
    pub threads: usize,
    /// How much work to spend on it.
    pub quality: Quality,
    /// Whether memory matters more than speed. The in-house BVH then keeps of each leaf which triangles it is made of, and
    /// gathers their corners whenever a ray visits it; Embree shares vertices with the mesh.
    pub is_compact: bool,
}

impl BuildOptions {
    /// Quality and kind, such as "high compact".
    pub fn name(&self) -> String {
        let compact = if self.is_compact { " compact" } else { "" };
        format!("{}{compact}", self.quality.name())
    }
}
