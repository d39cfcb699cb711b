//! Boxes against planes in floating point: on which side a whole box certainly lies.

use super::approx::{Approx3, U, decided};
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
        let [height, reach] = self.height(normal);
        decided(height, reach)
    }

    /// Whether all of the box certainly lies on the negative side of that plane, and whether on the positive one: what [`SeenBox::side`] tells, without a
    /// branch on it.
    #[inline]
    pub(crate) fn sides(&self, normal: &Approx3) -> [bool; 2] {
        let [height, reach] = self.height(normal);
        [height < -reach, height > reach]
    }

    /// The height of the middle over a plane, and how far the heights of the box's points may be from that.
    #[inline]
    fn height(&self, normal: &Approx3) -> [f64; 2] {
        let reach = normal.v.abs().dot(self.half) + self.margin + normal.slack * self.size;
        [normal.v.dot(self.center), reach]
    }
}

impl SeenBox {
    /// At least the size of every point's height over the plane with that normal through the point it is seen from.
    pub(super) fn most_height(&self, normal: &Approx3) -> f64 {
        let reach = normal.v.abs().dot(self.half) + self.margin + normal.slack * self.size;
        (normal.v.dot(self.center).abs() + reach) * (1.0 + 8.0 * U)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = DVec3> {
        prop::array::uniform3(-8i8..=8).prop_map(|v| DVec3::from(v.map(f64::from)))
    }

    proptest! {
        #[test]
        fn a_box_is_on_a_side_if_all_its_corners_are(from in vector(), a in vector(), b in vector(), normal in vector()) {
            prop_assume!(normal != DVec3::ZERO);
            let (low, high) = (a.min(b), a.max(b));
            let corners = (0..8).map(|k| DVec3::new(
                if k & 1 == 0 { low.x } else { high.x },
                if k & 2 == 0 { low.y } else { high.y },
                if k & 4 == 0 { low.z } else { high.z },
            ));
            // Whole numbers: exact.
            let heights: Vec<f64> = corners.map(|p| normal.dot(p - from)).collect();
            let side = if heights.iter().all(|&h| h > 0.0) {
                Some(Sign::Positive)
            } else if heights.iter().all(|&h| h < 0.0) {
                Some(Sign::Negative)
            } else {
                None
            };
            let (seen, normal) = (SeenBox::new(from, low, high), Approx3::given(normal));
            prop_assert_eq!(seen.side(&normal), side);
            prop_assert_eq!(seen.sides(&normal), [Sign::Negative, Sign::Positive].map(|sign| side == Some(sign)));
        }
    }

    #[test]
    fn what_may_be_rounded_away_is_not_told() {
        let touching = |gap: f64| {
            let low = DVec3::new(1e6 + gap, -1.0, -1.0);
            SeenBox::new(DVec3::X * 1e6, low, low + 2.0).side(&Approx3::given(DVec3::X))
        };
        assert_eq!(touching(1e-3), Some(Sign::Positive));
        assert_eq!(touching(2e-10), None);
        assert_eq!(
            SeenBox::new(DVec3::ZERO, DVec3::splat(1e299), DVec3::splat(1e300)).side(&Approx3::given(DVec3::X)),
            None
        );
    }
}
