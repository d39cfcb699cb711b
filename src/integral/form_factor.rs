//! The diffuse form factor of a spherical polygon.

use super::flux::double_flux;
use super::unit::{UnitDirection, outline};
use glam::DVec3;
use std::f64::consts::TAU;

/// The form factor from a surface element to a convex polygon: the integral of n.u / pi over
/// the polygon's directions u, 0 to 1 (Lambert 1760; Baum, Rushmeier and Winget 1989).
///
/// `boundary` as for [`solid_angle`](super::solid_angle), and clipped to n.u >= 0: parts below
/// the horizon would count as negative. `normal` is the element's normal n, of any length; without a direction (zero or not
/// finite) the value is 0.
///
/// The error is below 2e-16 times (the value + the polygon's perimeter times its diameter): about
/// 1e-15 of the value for polygons of moderate aspect well above the horizon, whatever their
/// size. Close to the horizon the error is that of the same polygon at the zenith. Never negative, never NaN. O(vertices).
///
/// ```
/// use glam::DVec3;
/// let octant = [DVec3::X, DVec3::Y, DVec3::Z];
/// assert!((nusselt::integral::form_factor(&octant, DVec3::Z) - 0.25).abs() < 1e-16);
/// ```
pub fn form_factor(boundary: &[DVec3], normal: DVec3) -> f64 {
    of_outline(&outline(boundary.iter().filter_map(|&v| UnitDirection::new(v))), normal)
}

/// [`form_factor`] to a polygon whose vertices are known to more than `f64` precision.
pub fn form_factor_of_units(boundary: &[UnitDirection], normal: DVec3) -> f64 {
    of_outline(&outline(boundary.iter().copied()), normal)
}

fn of_outline(outline: &[UnitDirection], normal: DVec3) -> f64 {
    let Some(normal) = UnitDirection::new(normal) else { return 0.0 };
    let factor = normal.rounded().dot(double_flux(outline)) / TAU;
    if factor > 0.0 { factor } else { 0.0 }
}
