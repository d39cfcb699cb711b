//! Exact from-point visibility.

pub mod exact;
pub mod integral;
pub mod scene;
pub mod verify;
