//! The choices that Embree leaves to its user: how a scene is built, and by which call rays are traced.

use super::sys;
use std::ffi::c_int;

/// How Embree builds and traverses a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct EmbreeVariant {
    /// With spatial splits (quality "high") or without ("medium", the default).
    pub high_quality: bool,
    /// Watertight and conservative. Embree then silently builds at medium quality.
    pub robust: bool,
}

impl EmbreeVariant {
    /// What renders use.
    pub const PRODUCTION: Self = Self { high_quality: false, robust: true };

    /// Every variant that is a different scene, with its name.
    pub const ALL: [(&'static str, Self); 3] = [
        ("medium robust", Self::PRODUCTION),
        ("medium fast", Self { high_quality: false, robust: false }),
        ("high fast", Self { high_quality: true, robust: false }),
    ];

    pub(super) fn flags(self) -> sys::RTCSceneFlags {
        if self.robust {
            sys::RTCSceneFlags::RTC_SCENE_FLAG_ROBUST
        } else {
            sys::RTCSceneFlags::RTC_SCENE_FLAG_NONE
        }
    }

    pub(super) fn quality(self) -> sys::RTCBuildQuality {
        if self.high_quality {
            sys::RTCBuildQuality::RTC_BUILD_QUALITY_HIGH
        } else {
            sys::RTCBuildQuality::RTC_BUILD_QUALITY_MEDIUM
        }
    }
}

/// What Embree is told about the rays of a packet or a stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Hint {
    /// They go different ways.
    Incoherent,
    /// They start and go alike.
    Coherent,
}

/// A call of Embree's interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EmbreeCall {
    /// `rtcIntersect1`, `rtcOccluded1`: one ray.
    Single,
    /// `rtcIntersect8`, `rtcOccluded8`: eight rays side by side.
    Packet8(Hint),
    /// `rtcIntersect16`, `rtcOccluded16`: sixteen rays side by side.
    Packet16(Hint),
    /// `rtcIntersect1M`, `rtcOccluded1M`: that many rays, one after the other in memory. Embree 3 only.
    Stream(u32, Hint),
}

impl EmbreeCall {
    /// Every call for several rays that the linked Embree has; streams in three lengths.
    pub fn for_several() -> Vec<Self> {
        let lengths: &[u32] = if major() == 3 { &[64, 256, 1024] } else { &[] };
        [Hint::Incoherent, Hint::Coherent]
            .into_iter()
            .flat_map(|hint| {
                let streams = lengths.iter().map(move |&n| Self::Stream(n, hint));
                [Self::Packet8(hint), Self::Packet16(hint)].into_iter().chain(streams)
            })
            .collect()
    }

    /// Whether an any-hit query on a scene with instances returns. Embree 3.13.5 with AVX-512 loops for ever in
    /// packets of 16 with the coherent hint, of which its coherent streams are made, too.
    pub(super) fn returns_on_instances(self) -> bool {
        let hangs =
            matches!(self, Self::Packet16(Hint::Coherent) | Self::Stream(_, Hint::Coherent));
        major() != 3 || !hangs
    }

    /// Embree's hint as C has it.
    pub(super) fn is_coherent(self) -> c_int {
        match self {
            Self::Single => 0,
            Self::Packet8(hint) | Self::Packet16(hint) | Self::Stream(_, hint) => {
                c_int::from(hint == Hint::Coherent)
            }
        }
    }

    /// For example "streams of 64, incoherent".
    pub fn name(self) -> String {
        let (rays, hint) = match self {
            Self::Single => return "single".into(),
            Self::Packet8(hint) => ("packets of 8".into(), hint),
            Self::Packet16(hint) => ("packets of 16".into(), hint),
            Self::Stream(length, hint) => (format!("streams of {length}"), hint),
        };
        match hint {
            Hint::Incoherent => format!("{rays}, incoherent"),
            Hint::Coherent => format!("{rays}, coherent"),
        }
    }
}

/// Which Embree is linked: 3 or 4.
fn major() -> c_int {
    // SAFETY: takes nothing and returns a constant.
    unsafe { sys::glint_embree_major() }
}
