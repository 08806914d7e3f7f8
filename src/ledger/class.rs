//! Transport classes: a partition of all light that reaches the camera, by the most demanding thing that happened to
//! it on the way.
//!
//! A path scatters at each of its vertices. What it did at the last one before the light does not count where both
//! ways of finding lights can do it (a rough reflection): that is direct light for the vertex. So the class of a
//! contribution does not depend on which of the two found it. Of everything else that happened, what comes last in
//! [`Class::ALL`] gives the class its name.

use crate::error::named_set;

/// What happened to a path between the camera and the light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Events(u8);

impl Events {
    /// Nothing.
    pub const NONE: Self = Self(0);
    /// Broad reflection.
    pub const DIFFUSE: Self = Self(1);
    /// Rough reflection.
    pub const GLOSSY: Self = Self(2);
    /// Mirror reflection.
    pub const MIRROR: Self = Self(4);
    /// Transmission.
    pub const REFRACTION: Self = Self(8);
    /// Mirror reflection or transmission after a broad or rough reflection, seen from the camera.
    pub const CAUSTIC: Self = Self(16);
    /// All of them.
    pub const ALL: Self = Self(31);

    /// Both together.
    #[inline]
    #[must_use]
    pub const fn and(self, more: Self) -> Self {
        Self(self.0 | more.0)
    }

    /// Whether all of them are in `allowed`.
    #[inline]
    pub const fn are_within(self, allowed: Self) -> bool {
        self.0 & !allowed.0 == 0
    }

    /// Whether any of them is in `others`.
    #[inline]
    pub const fn meet(self, others: Self) -> bool {
        self.0 & others.0 != 0
    }

    /// `event`, with what it makes of a path on which `self` has happened.
    #[inline]
    #[must_use]
    pub const fn followed_by(self, event: Self) -> Self {
        let is_rough = self.meet(Self::DIFFUSE.and(Self::GLOSSY));
        let is_sharp = event.meet(Self::MIRROR.and(Self::REFRACTION));
        let caustic = if is_rough && is_sharp { Self::CAUSTIC } else { Self::NONE };
        self.and(event).and(caustic)
    }

    /// The class of a path of more than direct light; `None` where nothing happened.
    #[inline]
    pub const fn class(self) -> Option<Class> {
        CLASSES[(self.0 & Self::ALL.0) as usize]
    }

    /// [`Events::class`], by the rule itself.
    const fn most_demanding(self) -> Option<Class> {
        if self.meet(Self::CAUSTIC) {
            Some(Class::Caustic)
        } else if self.meet(Self::REFRACTION) {
            Some(Class::Refraction)
        } else if self.meet(Self::MIRROR) {
            Some(Class::Mirror)
        } else if self.meet(Self::GLOSSY) {
            Some(Class::Glossy)
        } else if self.meet(Self::DIFFUSE) {
            Some(Class::Diffuse)
        } else {
            None
        }
    }
}

/// The class for each set of events: it is asked for at every vertex.
const CLASSES: [Option<Class>; 32] = {
    let (mut classes, mut events) = ([None; 32], 0);
    while events < 32 {
        classes[events] = Events(events as u8).most_demanding();
        events += 1;
    }
    classes
};

named_set! {
    /// A class of contributions; where several could name a path, the last one does.
    Class {
        /// Lights that the camera sees, the surroundings included.
        Seen = "emission seen",
        /// From a point or spot, by one reflection.
        DirectPoint = "direct, points",
        /// From a direction or a disc at infinity, by one reflection.
        DirectSun = "direct, suns",
        /// From an emissive surface, by one reflection.
        DirectSurface = "direct, surfaces",
        /// From the surroundings, by one reflection.
        DirectEnvironment = "direct, environment",
        /// By broad reflections only.
        Diffuse = "diffuse",
        /// By a rough reflection of another surface.
        Glossy = "glossy",
        /// By a mirror.
        Mirror = "mirror",
        /// Through a transparent surface.
        Refraction = "refraction",
        /// Thrown on a rough surface by a mirror or through a transparent one.
        Caustic = "caustic",
    }
}

impl Class {
    /// How many there are.
    pub const COUNT: usize = Self::ALL.len();
}

impl Default for Class {
    /// That of a ray from the camera.
    fn default() -> Self {
        Self::Seen
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_caustic_is_sharp_after_rough_and_not_before() {
        let after = |events: &[Events]| {
            events.iter().fold(Events::NONE, |all, &event| all.followed_by(event)).class()
        };
        use Events as E;
        assert_eq!(after(&[]), None);
        assert_eq!(after(&[E::DIFFUSE, E::DIFFUSE]), Some(Class::Diffuse));
        assert_eq!(after(&[E::MIRROR, E::DIFFUSE]), Some(Class::Mirror));
        assert_eq!(after(&[E::DIFFUSE, E::GLOSSY]), Some(Class::Glossy));
        assert_eq!(after(&[E::REFRACTION, E::MIRROR, E::DIFFUSE]), Some(Class::Refraction));
        assert_eq!(after(&[E::DIFFUSE, E::REFRACTION]), Some(Class::Caustic));
        assert_eq!(after(&[E::GLOSSY, E::MIRROR, E::DIFFUSE]), Some(Class::Caustic));
    }
}
