//! Exact from-point visibility.

pub mod bsp;
pub mod contour;
pub mod exact;
pub mod scene;
