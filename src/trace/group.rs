//! Path vertices grouped by scattering model, so that the loops over them are monomorphic.
//!
//! Each model of the closed set has a list of its own: inside a group's loop there is no `match`, and the
//! model's `evaluate` and `sample` are inlined.

use crate::bsdf::{
    Conductor, Dielectric, Lambert, Mirror, OrenNayar, Plastic, Principled, Receive,
    RoughDielectric, Scatter,
};

/// A vertex by its place in the batch, and its model.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry<M> {
    pub(super) vertex: u32,
    pub(super) model: M,
}

/// Work on one group after the other.
pub(super) trait GroupStage {
    /// Every vertex of one model.
    fn visit<M: Scatter>(&mut self, group: &[Entry<M>]);
}

/// Files the model that it receives under its own group, for one vertex.
pub(super) struct Receiver<'a> {
    pub(super) groups: &'a mut Groups,
    pub(super) vertex: u32,
}

macro_rules! models {
    ($($list:ident: $model:ident,)*) => {
        /// The vertices by model; the memory is kept from batch to batch.
        #[derive(Debug)]
        pub(super) struct Groups {
            $($list: Vec<Entry<$model>>,)*
        }

        $(impl Receive<$model> for Receiver<'_> {
            #[inline(always)]
            fn receive(&mut self, model: $model) {
                self.groups.$list.push(Entry { vertex: self.vertex, model });
            }
        })*

        impl Groups {
            /// Room for `capacity` vertices of each model.
            pub(super) fn with_capacity(capacity: usize) -> Self {
                Self { $($list: Vec::with_capacity(capacity),)* }
            }

            pub(super) fn clear(&mut self) {
                $(self.$list.clear();)*
            }

            /// Runs a stage over every group that is not empty.
            pub(super) fn each(&self, stage: &mut impl GroupStage) {
                $(if !self.$list.is_empty() {
                    stage.visit(&self.$list);
                })*
            }
        }
    };
}

models! {
    lambert: Lambert,
    oren_nayar: OrenNayar,
    mirror: Mirror,
    dielectric: Dielectric,
    rough_dielectric: RoughDielectric,
    conductor: Conductor,
    plastic: Plastic,
    principled: Principled,
}
