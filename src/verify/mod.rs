//! Checks that do not trust the engine.
//!
//! [`Evidence`] is what a contour image claims; [`Evidence::check`] proves it, for all directions, or tells what is
//! wrong. [`RayOracle`] tells what a single ray sees, by brute force over all pieces. Neither uses anything
//! of the code that makes contour images.

mod boxes;
mod certificate;
mod checker;
mod defect;
mod evidence;
mod filter;
mod integers;
mod kernel_signs;
mod labels;
mod rational_signs;
mod ray;
mod signs;
mod tiling;

#[cfg(test)]
mod tests;

pub use certificate::{Arithmetic, Certificate, Extent};
pub use defect::{Defect, Rule};
pub use evidence::{Evidence, EvidenceCell, EvidenceDomain, EvidenceSliver, HalfSphere};
pub use ray::{RayAnswer, RayOracle, RayStats};
