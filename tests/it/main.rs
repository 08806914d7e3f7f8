//! One integration binary.

mod filter;
mod image;
