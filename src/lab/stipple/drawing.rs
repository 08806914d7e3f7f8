//! Dots of one colour on paper: the sizes that make a stippling as dark as its picture. Knows no file format.

use super::{Density, Stippling, Tone};
use std::f64::consts::PI;

/// A dot, in pixels of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dot {
    /// Centre, x to the right and y down.
    pub centre: [f64; 2],
    /// Radius.
    pub radius: f64,
}

/// Dots on paper.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// Width and height of the paper in pixels of the picture.
    pub size: [u32; 2],
    /// The dots; where they overlap they are one.
    pub dots: Vec<Dot>,
    /// White dots on black paper, instead of black ones on white.
    pub inverted: bool,
}

impl Drawing {
    /// Dots of one radius, in pixels.
    pub fn equal(stippling: &Stippling, size: [u32; 2], tone: Tone, radius: f64) -> Self {
        Self::new(stippling, size, tone, |_| radius)
    }

    /// Dots each of the area that its cell has to have covered.
    pub fn sized(stippling: &Stippling, size: [u32; 2], tone: Tone) -> Self {
        Self::new(stippling, size, tone, |darkness| (darkness / PI).sqrt())
    }

    fn new(stippling: &Stippling, size: [u32; 2], tone: Tone, radius: impl Fn(f64) -> f64) -> Self {
        let places = stippling.points.iter().zip(&stippling.darkness);
        let dots = places.map(|(&centre, &darkness)| Dot { centre, radius: radius(darkness) });
        Self { size, dots: dots.collect(), inverted: tone.inverted }
    }

    /// The radius in pixels with which the areas of `points` equal dots add up to the area that `density` has
    /// to have covered. Where dots overlap, as they must in black, less than that is covered.
    pub fn equal_radius(density: &Density, points: usize) -> f64 {
        (density.darkness() / (PI * points as f64)).sqrt()
    }
}
