//! The exchange between two elements that see each other wholly.
//!
//! Far apart, a few points on each are enough: the integrand cos cos' / (pi r^2) is (n.r)(-n'.r) / (pi r^4), a polynomial over r^4, and for elements whose radii sum to
//! delta times their distance, r^-4 is a series in delta of which rules of degree 1 and 3 take all below delta^2 and delta^4. Otherwise the contour
//! integral. Either way the exchange `A_i` `F_ij` is the same number seen from both: reciprocity holds to the last bit.

use super::contour;
use super::element::Element;
use super::row::Share;
use glam::DVec3;
use std::f64::consts::PI;

/// The error of one point, over delta^2; and of 4 points a quadrilateral, over delta^4: above the worst of random pairs in the tests.
const ONE: f64 = 4.0;
const FOUR: f64 = 4.0;
/// Points are not used above this delta.
const FAR: f64 = 0.5;
/// The error allowed of what is allowed at most, relative to the exchange: entries are better than the tolerance asks for where that is cheap, as
/// rows are to close.
const RELATIVE: f64 = 1e-3;

/// `A_i` `F_ij` and an estimate of its absolute error, at most `tolerance` times the smaller area as far as numbers go. `lower` and `upper` are given in the order of their numbers, each wholly
/// in front of the plane of the other.
pub(super) fn exchange(lower: (&Element, DVec3), upper: (&Element, DVec3), tolerance: f64) -> Share {
    let ((i, n_i), (j, n_j)) = (lower, upper);
    let between = j.centre - i.centre;
    let square = between.length_squared();
    let distance = square.sqrt();
    let delta = (i.radius + j.radius) / distance;
    let allowed = tolerance * i.area.min(j.area);
    if delta < FAR {
        // Cosines at the centres, and what they may grow to.
        let (cos_i, cos_j) = (n_i.dot(between) / distance, -n_j.dot(between) / distance);
        let most = i.area * j.area / (PI * square) * (cos_i.abs() + delta) * (cos_j.abs() + delta);
        let one = i.area * j.area * cos_i * cos_j / (PI * square);
        let fits = |error: f64, value: f64| error <= allowed && error <= RELATIVE * value.max(allowed);
        let error = ONE * delta * delta * most;
        if fits(error, one) {
            return Share { factor: one.max(0.0), error };
        }
        let error = FOUR * delta.powi(4) * most;
        // The value of one point is good enough to tell whether four are.
        if fits(error, one) {
            return Share { factor: by_points(i, n_i, j, n_j).max(0.0), error };
        }
    }
    let share = contour::exchange(&i.ring, &j.ring, allowed);
    Share { factor: share.factor.max(0.0), error: share.error }
}

fn by_points(i: &Element, n_i: DVec3, j: &Element, n_j: DVec3) -> f64 {
    let mut sum = 0.0;
    for &(x, weight_x) in &i.points {
        let mut inner = 0.0;
        for &(y, weight_y) in &j.points {
            let r = y - x;
            let inverse = 1.0 / r.length_squared();
            inner -= weight_y * n_i.dot(r) * n_j.dot(r) * inverse * inverse;
        }
        sum += weight_x * inner;
    }
    sum / PI
}
