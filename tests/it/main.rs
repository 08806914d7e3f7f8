//! One integration binary.
#![cfg(test)]

mod scene_file;
mod scene_file_errors;
