//! Exact from-point visibility.

pub mod bsp;
pub mod contour;
pub mod exact;
pub mod integral;
pub mod io;
pub mod samples;
pub mod scene;
pub mod verify;
