//! The one integration binary: physics, statistics and rules of the house.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod accel;
mod agreement;
mod allocation;
mod backends;
mod bench;
mod bsdf;
mod bvh;
mod bvh_packets;
mod camera;
mod census;
mod cli;
mod cli_input;
mod cli_options;
mod cli_plan;
mod cli_signals;
mod closed_forms;
mod compare;
mod compare_command;
mod cut_outs;
mod determinism;
mod effects;
mod effects_chain;
mod effects_lists;
mod effects_plan;
mod filter;
mod generate;
mod image;
mod lab_measures;
mod light;
mod load_mutations;
mod load_options;
mod mtl;
mod media;
mod obj;
mod oracle;
mod samplers;
mod samples_commands;
mod scene_file;
mod scene_file_errors;
mod statistics;
mod stipple_command;
mod support;
mod tidy;
mod x;
