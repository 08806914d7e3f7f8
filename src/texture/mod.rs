//! Image textures: filtered lookup in mip maps. Knows images and numbers, no materials or surfaces.

mod mipmap;

pub use mipmap::{MipMap, Wrap};
