//! Perfect mirror: all light into the mirrored direction, times a reflectance.

use super::{BsdfSample, BsdfValue, Scatter};
use crate::math::{Rgb, Vec3};

/// Perfect mirror.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mirror {
    reflectance: Rgb,
}

impl Mirror {
    /// `reflectance` in [0, 1], the same at every angle.
    #[inline]
    pub fn new(reflectance: Rgb) -> Self {
        Self { reflectance: super::reflectance(reflectance) }
    }
}

impl Scatter for Mirror {
    const HAS_LOBES: bool = false;

    #[inline]
    fn evaluate(&self, _wo: Vec3, _wi: Vec3) -> BsdfValue {
        BsdfValue::ZERO
    }

    #[inline]
    fn sample(&self, wo: Vec3, _lobe: f32, _direction: [f32; 2]) -> Option<BsdfSample> {
        BsdfSample::mirrored(wo, self.reflectance)
    }

    #[inline]
    fn albedo(&self, _wo: Vec3) -> Rgb {
        self.reflectance
    }

    #[inline]
    fn is_delta(&self) -> bool {
        true
    }
}
