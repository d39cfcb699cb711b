//! Boxes against planes in floating point: on which side a whole box certainly lies.

use super::approx::{Approx3, U};
use super::sign::Sign;
use glam::DVec3;

/// An axis-aligned box seen from a point, for any number of planes through that point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SeenBox {
    /// Its middle, from the point, and half its size.
    center: DVec3,
    half: DVec3,
    /// The sum of the sizes of `|center| + half`, and what rounding may add to a height.
    size: f64,
    margin: f64,
}

impl SeenBox {
    /// The box between two corners, seen from `from`.
    ///
    /// The margin is derived in docs/numerics.md.
    pub(crate) fn new(from: DVec3, low: DVec3, high: DVec3) -> Self {
        let center = (low + high) * 0.5 - from;
        let half = (high - low) * 0.5;
        let sum = (from.abs() + low.abs() + high.abs()).element_sum();
        // Beyond that a dot product might overflow.
        let margin = if sum < 1e300 { 64.0 * U * sum + f64::MIN_POSITIVE } else { f64::INFINITY };
        Self { center, half, size: (center.abs() + half).element_sum(), margin }
    }

    /// The side of the plane with that normal that all of the box lies on, if f64 can tell.
    ///
    /// The normal is off by `slack / 8` in each component.
    #[inline]
    pub(crate) fn side(&self, normal: &Approx3) -> Option<Sign> {
        let height = normal.v.dot(self.center);
        let reach = normal.v.abs().dot(self.half) + self.margin + normal.slack * self.size;
        if height > reach {
            Some(Sign::Positive)
        } else if height < -reach {
            Some(Sign::Negative)
        } else {
            None
        }
    }
}
