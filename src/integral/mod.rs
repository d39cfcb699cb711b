//! Integrals over convex spherical polygons: the solid angle and the diffuse form factor.
//!
//! A polygon is the list of its vertices as directions from the viewpoint, of any length, with
//! det[b0, b1, b2] > 0 for consecutive vertices: counter-clockwise seen from outside the unit
//! sphere, clockwise as the eye sees it. `docs/integrals.md` derives the formulas and tells what
//! was measured.

mod flux;
mod form_factor;
mod precise;
mod receiver;
mod solid_angle;
mod sums;
mod unit;
mod visible;

#[cfg(test)]
mod tests;

pub use form_factor::{form_factor, form_factor_of_units};
pub(crate) use receiver::Receiver;
pub use solid_angle::{solid_angle, solid_angle_of_units};
pub use unit::UnitDirection;

pub use sums::{PolygonSum, Sums};
