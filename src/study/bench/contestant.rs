//! Who takes part: a backend, one way of calling it, and rays in the layout that it likes best.

use super::rays::Query;
use crate::accel::oracle::{Class, Judgement};
use crate::geometry::{PrimitiveId, Ray};
use crate::os::Isa;

/// One way to have rays traced.
pub struct Contestant<'a> {
    /// "embree" or "bvh".
    pub backend: &'static str,
    /// How it was built and is called, such as "medium robust, single".
    pub variant: String,
    /// The widest instructions that it may use.
    pub isa: Isa,
    /// What its answers are held to.
    pub law: Law,
    /// What it is to the others.
    pub role: Role,
    /// What is timed.
    pub tracer: Box<dyn Tracer + 'a>,
}

/// What answers are held to, by the exact oracle ([`crate::accel::oracle`]). It knows no tolerance, but how far from the
/// edges of a triangle the kernel of the in-house BVH may err, which is proven, and for that kernel alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Law {
    /// The law of the in-house BVH. An answer is wrong unless it is lawful ([`Judgement::is_lawful`]): what is met first,
    /// of several equally near the first by id, or off by what the rounding of that kernel is proven to be
    /// worth. None may be wrong.
    Exact,
    /// For who rounds in ways of its own and chooses freely among what is equally near: Embree, whose robust modes
    /// promise no leaks, but no bound either. An answer is wrong unless it is lawful, or within an ulp of being the nearest.
    /// One in ten thousand may be wrong.
    Approximate,
}

/// What a contestant is to the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Is compared with the best rival, and with the baseline.
    Challenger,
    /// The rival that gives the same guarantees, called in the same way as by renders. Its answers are the
    /// reference.
    Baseline,
    /// Another rival.
    Rival,
    /// A rival that must qualify in the heats.
    Heat,
}

impl Law {
    /// Whether an answer that is so judged is not wrong.
    pub fn allows(self, judgement: &Judgement) -> bool {
        let is_tied = matches!(judgement.class, Class::Tie | Class::NearTie);
        judgement.is_lawful() || self == Self::Approximate && is_tied
    }

    /// Whether so many wrong answers of `compared` are let pass.
    pub fn tolerates(self, wrong: usize, compared: usize) -> bool {
        match self {
            Self::Exact => wrong == 0,
            Self::Approximate => wrong <= compared.div_ceil(10_000),
        }
    }
}

/// Makes room for rays in a layout of its own.
pub trait Tracer: Sync {
    /// Room for rays to be asked `query`, empty; none from who cannot answer that.
    fn batch(&self, query: Query) -> Option<Box<dyn Batch + '_>>;
}

/// Some rays in a layout of their tracer's own. Only [`Batch::trace`] is timed.
pub trait Batch: Send {
    /// Puts rays in place of whatever was there.
    fn load(&mut self, rays: &[Ray]);
    /// Traces all rays; once after each load.
    fn trace(&mut self);
    /// Adds the answers to all rays, in their order, to `answers`.
    fn read(&self, answers: &mut Vec<Answer>);
}

/// What a contestant says about a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Answer {
    /// Whether a surface is met.
    pub hit: bool,
    /// Which, if that was asked; otherwise [`PrimitiveId::MISS`].
    pub id: PrimitiveId,
}
