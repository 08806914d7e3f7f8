//! One integration binary.

mod support;

mod bsdf;
