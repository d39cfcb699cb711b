//! The solid angle of a convex spherical polygon.

use super::flux::double_flux;
use super::unit::{UnitDirection, arcs, outline};
use glam::DVec3;

/// The solid angle of a convex spherical polygon, in steradians: 0 to 2 pi.
///
/// `boundary` holds its vertices as directions of any length (finite, not zero; others are left
/// out), with det[b0, b1, b2] > 0 for consecutive ones: counter-clockwise seen from outside the
/// unit sphere. The vectors count as exact, however short, long or unlike in length they are.
/// Repeated vertices are harmless. The polygon may be as large as a hemisphere; two consecutive
/// vertices may be almost antipodal, but if they are exactly so the arc between them is not defined,
/// and the value is some number from 0 to 2 pi.
///
/// The error is below 4e-16 times (the value + the polygon's perimeter times its diameter): about
/// 1e-15 of the value for polygons of moderate aspect, whatever their size, and never more than
/// 8e-15. A sliver thinner than its own rounding may come out negative and is returned as 0.
/// Never NaN. O(vertices).
///
/// ```
/// use glam::DVec3;
/// let octant = nusselt::integral::solid_angle(&[DVec3::X, DVec3::Y, DVec3::Z]);
/// assert!((octant - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
/// ```
pub fn solid_angle(boundary: &[DVec3]) -> f64 {
    of_outline(&outline(boundary.iter().filter_map(|&v| UnitDirection::new(v))))
}

/// [`solid_angle`] of a polygon whose vertices are known to more than `f64` precision.
pub fn solid_angle_of_units(boundary: &[UnitDirection]) -> f64 {
    of_outline(&outline(boundary.iter().copied()))
}

/// Van Oosterom and Strackee (1983), a fan of triangles: tan(Omega / 2) = det[g, a, b] /
/// (1 + a.b + g.a + g.b). With a.b >= 0 on every arc of the outline and g.a >= 0 for the apex the
/// denominator is at least 1: the arc tangent stays on its main branch, and a triangle that rounding turns over counts
/// its small negative area.
fn of_outline(outline: &[UnitDirection]) -> f64 {
    let Some(apex) = apex(outline) else {
        return 0.0;
    };
    let g = apex.rounded();
    let halves = arcs(outline).map(|[a, b]| {
        let determinant = g.dot(a.minus(&apex).cross(b.minus(a)));
        let [ra, rb] = [a.rounded(), b.rounded()];
        determinant.atan2(1.0 + ra.dot(rb) + g.dot(ra + rb))
    });
    let total = 2.0 * halves.sum::<f64>();
    if total > 0.0 { total } else { 0.0 }
}

/// A direction of the polygon that is at most 90 degrees from each of its points: the first vertex
/// if it is one, else about the centre of gravity.
///
/// Why the centre of gravity is one: seen from any point v of a convex polygon K, K covers an arc from 0
/// to some R(phi) in every azimuth phi, so v . (integral of u over K) is the integral of (sin R)^2 / 2 >= 0.
/// For a sliver this integral is noise. A thousandth of the centre of gravity of the boundary,
/// which is sound exactly there, takes over then.
fn apex(outline: &[UnitDirection]) -> Option<UnitDirection> {
    let first = outline.first()?;
    if outline.iter().all(|v| v.rounded().dot(first.rounded()) >= 0.0) {
        return Some(*first);
    }
    let rim: DVec3 = arcs(outline).map(|[a, b]| (a.rounded() + b.rounded()) * b.minus(a).length()).sum();
    UnitDirection::new(double_flux(outline) + 1e-3 * rim)
}
