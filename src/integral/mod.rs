//! Integrals over convex spherical polygons: the solid angle, the diffuse form factor, moments of lobes, and cubature of anything else.
//!
//! A polygon is the list of its vertices as directions from the viewpoint, of any length, with
//! det[b0, b1, b2] > 0 for consecutive vertices: counter-clockwise seen from outside the unit
//! sphere, clockwise as the eye sees it. `docs/integrals.md` derives the formulas and tells what
//! was measured.

#[cfg(test)]
pub(crate) mod brute;
mod cap;
mod clip;
mod cubature;
mod flux;
mod form_factor;
mod gradient;
mod harmonics;
mod moments;
mod precise;
#[cfg(test)]
pub(crate) mod random;
mod receiver;
mod solid_angle;
mod sums;
mod unit;
mod visible;
mod zonal;
mod zonal_sum;

#[cfg(test)]
mod tests;

pub(crate) use cap::Cap;
pub(crate) use clip::{clip, perimeter, unit_outline};
pub use cubature::{Cubature, CubatureOptions, Integral, Peak, Smoothness, integrate};
pub(crate) use cubature::{Linear, Weight};
pub use form_factor::{form_factor, form_factor_of_units};
pub use gradient::{GradientError, IrradianceGradient};
pub use harmonics::{Harmonics, harmonics};
pub(crate) use harmonics::{count as harmonic_count, index as harmonic_index};
pub use moments::{Estimate, axial_moment, double_axis_moment};
pub(crate) use receiver::Receiver;
pub use solid_angle::{solid_angle, solid_angle_of_units};
pub use unit::UnitDirection;
pub use zonal::zonal_integrals;
pub use zonal_sum::ZonalSum;

pub use sums::{PolygonSum, Sums};
