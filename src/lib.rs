//! Exact from-point visibility.

pub mod exact;
pub mod samples;
pub mod scene;
