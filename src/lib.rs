//! Exact from-point visibility.

pub mod bsp;
pub mod exact;
pub mod scene;
