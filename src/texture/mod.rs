//! temp
use crate::image::Image;
use crate::math::Rgb;
use std::sync::Arc;
/// temp
#[derive(Clone, Copy, Debug)]
pub enum Wrap {
    /// temp
    Repeat,
    /// temp
    Clamp,
}
/// temp
pub struct MipMap(Arc<Image>);
impl MipMap {
    /// temp
    pub fn new(image: Arc<Image>) -> Self { Self(image) }
    /// temp
    pub fn lookup(&self, uv: [f32; 2], _f: f32, _w: Wrap) -> (Rgb, f32) {
        let x = ((uv[0] - uv[0].floor()) * self.0.width() as f32) as u32;
        let y = ((1.0 - uv[1] + uv[1].floor()) * self.0.height() as f32) as u32;
        self.0.texel(x.min(self.0.width() - 1), y.min(self.0.height() - 1))
    }
    /// temp
    pub fn average(&self) -> Rgb { Rgb::WHITE }
    /// temp
    pub fn bytes(&self) -> usize { 0 }
    /// temp
    pub fn has_alpha(&self) -> bool { self.0.has_alpha() }
    /// temp
    pub fn size(&self) -> [u32; 2] { [self.0.width(), self.0.height()] }
}
