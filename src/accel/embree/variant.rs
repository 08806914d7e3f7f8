//! The choices that Embree leaves to its user: how a scene is built, and by which call rays are traced.

use super::sys;
use crate::accel::{BuildOptions, Quality};
use std::ffi::c_int;

/// How Embree builds and traverses a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct EmbreeVariant {
    /// High is with spatial splits, fast is by Morton codes.
    pub quality: Quality,
    /// Watertight and conservative. Embree then silently builds no better than at its default quality.
    pub robust: bool,
    /// Without copies of the vertices.
    pub is_compact: bool,
}

impl EmbreeVariant {
    /// What renders use.
    pub const PRODUCTION: Self =
        Self { quality: Quality::Default, robust: true, is_compact: false };

    /// Every variant that is a different scene, with its name.
    pub const ALL: [(&'static str, Self); 3] = [
        ("medium robust", Self::PRODUCTION),
        ("medium fast", Self { robust: false, ..Self::PRODUCTION }),
        ("high fast", Self { quality: Quality::High, robust: false, ..Self::PRODUCTION }),
    ];

    /// What renders use, as they want it built.
    pub fn production(options: &BuildOptions) -> Self {
        Self { quality: options.quality, is_compact: options.is_compact, ..Self::PRODUCTION }
    }

    pub(super) fn flags(self) -> sys::RTCSceneFlags {
        let none = sys::RTCSceneFlags::RTC_SCENE_FLAG_NONE;
        let robust = if self.robust { sys::RTCSceneFlags::RTC_SCENE_FLAG_ROBUST } else { none };
        let compact =
            if self.is_compact { sys::RTCSceneFlags::RTC_SCENE_FLAG_COMPACT } else { none };
        robust | compact
    }

    pub(super) fn quality(self) -> sys::RTCBuildQuality {
        match self.quality {
            Quality::Fast => sys::RTCBuildQuality::RTC_BUILD_QUALITY_LOW,
            Quality::Default => sys::RTCBuildQuality::RTC_BUILD_QUALITY_MEDIUM,
            Quality::High => sys::RTCBuildQuality::RTC_BUILD_QUALITY_HIGH,
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
