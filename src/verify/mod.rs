//! Checks that do not trust the engine, and use nothing of it but the scene.
//!
//! [`Evidence`] is what a contour image claims; [`Evidence::check`] proves it, for all directions, or tells what is
//! wrong. [`RayOracle`] tells what a single ray sees, by brute force over all pieces. [`outside`] asks another
//! library, in rounded coordinates, for its opinion on a whole image.

mod boxes;
mod certificate;
mod checker;
mod clip;
mod defect;
mod domain;
mod evidence;
mod filter;
mod integers;
mod kernel_signs;
mod labels;
pub mod outside;
mod rational;
mod rational_signs;
mod ray;
mod signs;
mod slivers;
mod tiling;

#[cfg(test)]
mod tests;

pub use certificate::{Arithmetic, Certificate, Extent};
pub use defect::{Defect, Rule};
pub use evidence::{Evidence, EvidenceCell, EvidenceDomain, EvidenceHorizon, EvidencePane, EvidenceSliver, HalfSphere};
pub use ray::{RayAnswer, RayOracle, RayStats};
