//! One integration binary.

mod scene_file;
mod scene_file_errors;
