//! Exact from-point visibility.

pub mod exact;
pub mod scene;
