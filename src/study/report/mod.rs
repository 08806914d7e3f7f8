//! Pages that show studies: one self-contained HTML file each, with charts as inline SVG.
//!
//! A page names no other file and no server, so it can be mailed and kept. Whatever comes from outside, such as
//! the names of scenes, goes through `html::Html::text` or an attribute, which escape it.

mod bars;
mod bench;
mod frames;
mod html;
mod panel;
mod render;
mod samples;
mod stack;

pub use bench::bench_page;
pub use panel::panel;
pub use render::render_page;
pub use samples::samples_page;
