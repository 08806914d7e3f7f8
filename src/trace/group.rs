//! Path vertices grouped by scattering model, so that the loops over them are monomorphic.
//!
//! Inside a group's loop there is no `match`: the model's own `evaluate` and `sample` are inlined.

use super::Vertex;
use crate::bsdf::{
    Bsdf, Conductor, Dielectric, Lambert, Mirror, OrenNayar, Plastic, Principled, RoughDielectric,
    Scatter,
};

/// A model of the closed set, and its place in the enum.
pub(super) trait Model: Scatter + Copy {
    /// Whether `sample` depends on the number that chooses a lobe: not where there is one lobe only.
    const HAS_LOBES: bool;

    /// The model in a BSDF of this model's group.
    fn of(bsdf: &Bsdf) -> &Self;
}

/// Work on one group after the other.
pub(super) trait GroupStage {
    /// The vertices `group` all have model `M`.
    fn visit<M: Model>(&mut self, group: &[u32]);
}

/// The order of vertices by model; the memory is kept from batch to batch.
#[derive(Debug, Default)]
pub(super) struct Groups {
    order: Vec<u32>,
    /// One past each group's last place in `order`.
    ends: [usize; MODELS],
}

macro_rules! models {
    ($($model:ident $has_lobes:literal),*) => {
        const MODELS: usize = [$(stringify!($model)),*].len();

        /// Place of a BSDF's model in the closed set.
        #[inline]
        fn place(bsdf: &Bsdf) -> usize {
            enum Place { $($model),* }
            match bsdf { $(Bsdf::$model(_) => Place::$model as usize),* }
        }

        $(impl Model for $model {
            const HAS_LOBES: bool = $has_lobes;

            #[inline]
            fn of(bsdf: &Bsdf) -> &Self {
                match bsdf {
                    Bsdf::$model(model) => model,
                    _ => unreachable!("vertices are grouped by model"),
                }
            }
        })*

        impl Groups {
            /// Runs a stage over every group that is not empty.
            pub(super) fn each(&self, stage: &mut impl GroupStage) {
                let mut start = 0;
                let mut ends = self.ends.iter();
                $(if let Some(&end) = ends.next() {
                    if start < end {
                        stage.visit::<$model>(&self.order[start..end]);
                    }
                    start = end;
                })*
                debug_assert_eq!(start, self.order.len());
            }
        }
    };
}

models!(
    Lambert false,
    OrenNayar false,
    Mirror false,
    Dielectric true,
    RoughDielectric true,
    Conductor true,
    Plastic true,
    Principled true
);

impl Groups {
    /// Room for `capacity` vertices.
    pub(super) fn with_capacity(capacity: usize) -> Self {
        Self { order: Vec::with_capacity(capacity), ends: [0; MODELS] }
    }

    /// Sorts the vertices by model, keeping their order within one (counting sort).
    pub(super) fn sort(&mut self, vertices: &[Vertex]) {
        let mut counts = [0; MODELS];
        for vertex in vertices {
            counts[place(&vertex.bsdf)] += 1;
        }
        let mut next = [0; MODELS];
        let mut end = 0;
        for ((count, next), group_end) in counts.iter().zip(&mut next).zip(&mut self.ends) {
            *next = end;
            end += count;
            *group_end = end;
        }
        self.order.resize(vertices.len(), 0);
        for (i, vertex) in vertices.iter().enumerate() {
            let next = &mut next[place(&vertex.bsdf)];
            self.order[*next] = i as u32;
            *next += 1;
        }
    }
}
