//! The in-house BVH: not part of this version. Says so when it is asked for, and cannot be built.

use super::{Accelerator, BuildStats, HitFilter};
use crate::error::{Error, Result};
use crate::geometry::{Geometry, Hit, Ray};
use std::sync::Arc;

/// A hierarchy that does not exist yet: there is no value of this type.
#[derive(Debug)]
pub enum Bvh {}

impl Bvh {
    /// # Errors
    /// Always.
    pub fn build(_geometry: Arc<Geometry>, _threads: usize) -> Result<Self> {
        let message =
            "this version has no in-house BVH; build with feature `embree` and use --accel embree";
        Err(Error::Backend { backend: "bvh", message: message.into() })
    }
}

impl Accelerator for Bvh {
    fn closest<F: HitFilter>(&self, _: &[Ray], _: &F, _: &mut [Hit]) {
        match *self {}
    }

    fn occluded<F: HitFilter>(&self, _: &[Ray], _: &F, _: &mut [bool]) {
        match *self {}
    }

    fn build_stats(&self) -> BuildStats {
        match *self {}
    }
}
