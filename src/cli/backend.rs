//! The choice of a backend: the only place where one is built and given to what is to be done with it.

use super::args::Backend;
#[cfg(feature = "bvh")]
use crate::accel::bvh::Bvh;
#[cfg(feature = "embree")]
use crate::accel::embree::EmbreeAccelerator;
use crate::accel::{Accelerator, BuildOptions};
use crate::error::Result;
use crate::geometry::Geometry;
use crate::os::Isa;
use std::sync::Arc;

/// Backends that this build has.
#[derive(Clone, Copy)]
pub(super) enum Chosen {
    #[cfg(feature = "embree")]
    Embree,
    #[cfg(feature = "bvh")]
    Bvh,
}

/// What is done with an accelerator, whatever its type.
pub(super) trait Task {
    /// Does it; the exit code.
    fn run<A: Accelerator>(
        self,
        name: &'static str,
        version: String,
        accelerator: &A,
    ) -> Result<u8>;
}

impl Chosen {
    pub(super) fn name(self) -> &'static str {
        match self {
            #[cfg(feature = "embree")]
            Self::Embree => "embree",
            #[cfg(feature = "bvh")]
            Self::Bvh => "bvh",
        }
    }

    /// Builds it over `geometry` and does `task` with it.
    ///
    /// # Errors
    /// Where it cannot be built, and those of the task.
    pub(super) fn build(
        self,
        geometry: Arc<Geometry>,
        options: &BuildOptions,
        task: impl Task,
    ) -> Result<u8> {
        match self {
            #[cfg(feature = "embree")]
            Self::Embree => {
                let embree = EmbreeAccelerator::with_options(geometry, options, Isa::detect())?;
                task.run(self.name(), embree.version(), &embree)
            }
            #[cfg(feature = "bvh")]
            Self::Bvh => {
                let bvh = Bvh::with_options(geometry, options)?;
                task.run(self.name(), env!("CARGO_PKG_VERSION").to_owned(), &bvh)
            }
        }
    }
}

/// The backend that is wanted, if this build has it.
///
/// # Errors
/// A usage error where it has not.
pub(super) fn choose(wanted: Backend) -> Result<Chosen> {
    match wanted {
        // README's table: with wide vectors the in-house BVH is ahead on every kind of scene. `--isa` has no say, so
        // that it changes no picture.
        #[cfg(feature = "bvh")]
        Backend::Auto if cfg!(not(feature = "embree")) || Isa::detect() == Isa::Avx512 => {
            Ok(Chosen::Bvh)
        }
        #[cfg(feature = "embree")]
        Backend::Embree | Backend::Auto => Ok(Chosen::Embree),
        #[cfg(not(feature = "embree"))]
        Backend::Embree => {
            Err(crate::error::Error::Usage("--accel embree: built without Embree".into()))
        }
        #[cfg(not(feature = "embree"))]
        Backend::Auto => Ok(Chosen::Bvh),
        #[cfg(feature = "bvh")]
        Backend::Bvh => Ok(Chosen::Bvh),
        #[cfg(not(feature = "bvh"))]
        Backend::Bvh => {
            Err(crate::error::Error::Usage("--accel bvh: built without the in-house BVH".into()))
        }
    }
}
