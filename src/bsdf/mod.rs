//! Scattering models (BSDFs): pure functions of parameters that are already evaluated.
//!
//! All directions are unit vectors of the local frame whose z axis is the shading normal. `wo` points
//! away from the surface, to where the light goes; the caller has flipped the frame so that
//! `wo.z > 0`, on either side of the surface. `wi` points to where the light comes from: `wi.z > 0` is
//! reflection, `wi.z < 0` transmission. A model says nothing of textures, absorption along a path or
//! which side is inside: its constructor takes what holds at the point.
//!
//! Radiance is transported: what a dielectric transmits carries the factor 1 / eta^2 (eta of the side of
//! `wi` over that of `wo`) by which radiance shrinks in a denser medium (Veach 1997, section 5.2).

mod fresnel;
mod microfacet;
mod grid;
mod energy;

mod lambert;
mod oren_nayar;
mod mirror;
mod dielectric;
mod rough_dielectric;
mod conductor;
mod metals;
mod plastic;
mod principled;

use crate::math::{Rgb, Vec3};
use std::ops::AddAssign;

pub use conductor::Conductor;
pub use dielectric::Dielectric;
pub use lambert::Lambert;
pub use metals::{METALS, Metal};
pub use mirror::Mirror;
pub use oren_nayar::OrenNayar;
pub use plastic::Plastic;
pub use principled::{Principled, PrincipledParameters};
pub use rough_dielectric::RoughDielectric;

/// What a model does with light. Never panics; a degenerate argument (`wo.z <= 0`) scatters nothing.
pub trait Scatter {
    /// Whether [`Scatter::sample`] depends on `lobe`: not where there is one lobe only.
    const HAS_LOBES: bool;

    /// Value and density for a pair of directions. Delta lobes are not part of it.
    fn evaluate(&self, wo: Vec3, wi: Vec3) -> BsdfValue;

    /// Draws `wi` from the numbers `lobe` and `direction`, uniform in [0, 1). `None`: the sample is
    /// absorbed (its weight is 0), which happens with the probability that the density is short of 1.
    fn sample(&self, wo: Vec3, lobe: f32, direction: [f32; 2]) -> Option<BsdfSample>;

    /// Fraction of the energy arriving from `wo` that is scattered, to all sides; approximate where no
    /// closed form exists. For the albedo AOV; nothing in the transport depends on it.
    fn albedo(&self, wo: Vec3) -> Rgb;

    /// Whether all lobes are delta: `evaluate` is zero and sampling lights is useless.
    fn is_delta(&self) -> bool;
}

/// A value of a BSDF, without its delta lobes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfValue {
    /// f(wo, wi) |cos theta_i|, finite and >= 0.
    pub f_cos: Rgb,
    /// Density with which [`Scatter::sample`] returns `wi`, over solid angle and over all lobes.
    pub pdf_solid_angle: f32,
}

impl BsdfValue {
    /// No scattering.
    pub const ZERO: Self = Self { f_cos: Rgb::BLACK, pdf_solid_angle: 0.0 };
}

impl AddAssign for BsdfValue {
    /// Adds a lobe: both are sums over lobes.
    #[inline]
    fn add_assign(&mut self, lobe: Self) {
        self.f_cos += lobe.f_cos;
        self.pdf_solid_angle += lobe.pdf_solid_angle;
    }
}

/// A sampled direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample {
    /// Direction towards the light.
    pub wi: Vec3,
    /// f |cos theta_i| / pdf, with the radiance factor 1 / eta^2 of a transmission in it; of a delta lobe
    /// its reflectance over the probability of having been chosen.
    pub weight: Rgb,
    /// Density of `wi` over solid angle, of the whole BSDF; 0 when `is_delta`.
    pub pdf_solid_angle: f32,
    /// Whether `wi` comes from a delta lobe, which `evaluate` cannot see.
    pub is_delta: bool,
    /// The lobe that was chosen.
    pub kind: LobeKind,
    /// eta^2 of a transmission, 1 otherwise. `weight` times it is the energy without the radiance factor, on
    /// which Russian roulette decides: along a path the factors of entering and leaving cancel.
    pub eta_scale: f32,
}

/// Kind of lobe, for the transport classes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LobeKind {
    /// Broad reflection.
    Diffuse,
    /// Reflection from a rough interface.
    Glossy,
    /// Delta reflection from a smooth interface.
    Mirror,
    /// Any transmission, rough or smooth.
    Refraction,
}

impl BsdfSample {
    /// The mirrored direction as a delta lobe.
    #[inline]
    fn mirrored(wo: Vec3, weight: Rgb) -> Option<Self> {
        (wo.z > 0.0).then(|| Self {
            wi: Vec3::new(-wo.x, -wo.y, wo.z),
            weight,
            pdf_solid_angle: 0.0,
            is_delta: true,
            kind: LobeKind::Mirror,
            eta_scale: 1.0,
        })
    }

    /// The direction `wi`, however drawn, with its value and its density over all lobes.
    #[inline]
    fn spread(wi: Vec3, value: BsdfValue, kind: LobeKind) -> Option<Self> {
        let BsdfValue { f_cos, pdf_solid_angle } = value;
        (pdf_solid_angle > 0.0).then(|| Self {
            wi,
            weight: f_cos / pdf_solid_angle,
            pdf_solid_angle,
            is_delta: false,
            kind,
            eta_scale: 1.0,
        })
    }
}

/// A reflectance clamped to [0, 1] (NaN to 0): no surface returns more than it gets, whatever a file says.
#[inline]
fn reflectance(color: Rgb) -> Rgb {
    color.map(unit)
}

/// A weight clamped to [0, 1] (NaN to 0).
#[inline]
fn unit(weight: f32) -> f32 {
    if weight > 0.0 { weight.min(1.0) } else { 0.0 }
}

/// The closed set of models.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bsdf {
    /// Ideal diffuse.
    Lambert(Lambert),
    /// Rough diffuse.
    OrenNayar(OrenNayar),
    /// Perfect mirror.
    Mirror(Mirror),
    /// Smooth glass, or a thin sheet of it.
    Dielectric(Dielectric),
    /// Frosted glass, or a thin sheet of it.
    RoughDielectric(RoughDielectric),
    /// Metal.
    Conductor(Conductor),
    /// Diffuse base under a dielectric coat.
    Plastic(Plastic),
    /// The artist's model.
    Principled(Principled),
}

impl Bsdf {
    /// Whether an interface of this roughness reflects like a mirror.
    pub fn is_smooth(roughness: f32) -> bool {
        microfacet::Ggx::new(roughness, 0.0).is_none()
    }

    /// Glass of any roughness: [`RoughDielectric::new`], or [`Dielectric::new`] where that is `None`.
    #[inline]
    pub fn dielectric(
        eta_inside_over_outside: f32,
        entering: bool,
        transmittance: Rgb,
        thin: bool,
        roughness: f32,
    ) -> Self {
        match RoughDielectric::new(
            eta_inside_over_outside,
            entering,
            transmittance,
            thin,
            roughness,
        ) {
            Some(rough) => Self::RoughDielectric(rough),
            None => Self::Dielectric(Dielectric::new(
                eta_inside_over_outside,
                entering,
                transmittance,
                thin,
            )),
        }
    }
}

/// Takes a model by its own type.
pub trait Receive<M> {
    /// Takes it.
    fn receive(&mut self, model: M);
}

macro_rules! receive_each {
    ($($model:ident)*) => {
        /// Takes whichever model a surface turns out to have, by its own type: nobody has to match on it later.
        pub trait ReceiveAny: $(Receive<$model> +)* {}

        impl<R: $(Receive<$model> +)*> ReceiveAny for R {}

        $(impl Receive<$model> for Bsdf {
            fn receive(&mut self, model: $model) {
                *self = Self::$model(model);
            }
        })*
    };
}

receive_each!(Lambert OrenNayar Mirror Dielectric RoughDielectric Conductor Plastic Principled);

/// Calls the same method on whichever model it is.
macro_rules! each {
    ($bsdf:expr, $model:ident => $call:expr) => {
        match $bsdf {
            Bsdf::Lambert($model) => $call,
            Bsdf::OrenNayar($model) => $call,
            Bsdf::Mirror($model) => $call,
            Bsdf::Dielectric($model) => $call,
            Bsdf::RoughDielectric($model) => $call,
            Bsdf::Conductor($model) => $call,
            Bsdf::Plastic($model) => $call,
            Bsdf::Principled($model) => $call,
        }
    };
}

impl Scatter for Bsdf {
    const HAS_LOBES: bool = true;

    #[inline]
    fn evaluate(&self, wo: Vec3, wi: Vec3) -> BsdfValue {
        each!(self, model => model.evaluate(wo, wi))
    }

    #[inline]
    fn sample(&self, wo: Vec3, lobe: f32, direction: [f32; 2]) -> Option<BsdfSample> {
        each!(self, model => model.sample(wo, lobe, direction))
    }

    #[inline]
    fn albedo(&self, wo: Vec3) -> Rgb {
        each!(self, model => model.albedo(wo))
    }

    #[inline]
    fn is_delta(&self) -> bool {
        each!(self, model => model.is_delta())
    }
}
