//! temp
/// temp
pub struct FilterSampler;
/// temp
pub enum Filter {
    /// temp
    Box {
        /// temp
        radius: f32,
    },
}
impl FilterSampler {
    /// temp
    pub fn new(_f: Filter) -> Self { Self }
    /// temp
    pub fn sample(&self, u: [f32; 2]) -> ([f32; 2], f32) { ([u[0] - 0.5, u[1] - 0.5], 1.0) }
}
