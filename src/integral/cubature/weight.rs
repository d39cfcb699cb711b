//! What a function is multiplied by over a polygon.

use glam::{DMat3, DVec3};

/// A factor for each of the three components.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Weight {
    Constant(DVec3),
    Linear(Linear),
}

/// Linear over a triangle in space: the k-th component by direction u is (row k of `above` . u) / (`below` . u), kept within `range`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Linear {
    above: DMat3,
    below: DVec3,
    range: [DVec3; 2],
}

impl Linear {
    /// By values at the corners of a triangle, which are given relative to the eye.
    ///
    /// Of a point of the triangle in direction u the second barycentric coordinate is u.(c x a) / (u.n), the third u.(a x b) / (u.n),
    /// n = (b - a) x (c - a). The products are taken with differences, so that small triangles far away lose nothing.
    pub(crate) fn new([a, b, c]: [DVec3; 3], values: [DVec3; 3]) -> Self {
        let [ab, ac] = [b - a, c - a];
        let below = ab.cross(ac);
        let [second, third] = [ac.cross(a), a.cross(ab)];
        let row = |k: usize| {
            let [f, g, h] = values.map(|value| value[k]);
            below * f + second * (g - f) + third * (h - f)
        };
        let [low, high] =
            [values.iter().copied().fold(values[0], DVec3::min), values.iter().copied().fold(values[0], DVec3::max)];
        Self { above: DMat3::from_cols(row(0), row(1), row(2)).transpose(), below, range: [low, high] }
    }

    /// The largest values.
    pub(crate) fn most(&self) -> DVec3 {
        self.range[1]
    }

    /// In a unit direction.
    pub(crate) fn at(&self, direction: DVec3) -> DVec3 {
        let ratio = self.above * direction / self.below.dot(direction);
        let [low, high] = self.range;
        // Where the triangle is seen edge-on the ratio may be no number; this makes it the lowest value.
        DVec3::from([0, 1, 2].map(|k| ratio[k].max(low[k]).min(high[k])))
    }
}

impl Weight {
    /// In a unit direction.
    pub(super) fn at(&self, direction: DVec3) -> DVec3 {
        match self {
            Self::Constant(weight) => *weight,
            Self::Linear(linear) => linear.at(direction),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Linear;
    use glam::DVec3;

    #[test]
    fn values_are_linear_in_space_however_small_the_triangle() {
        let values = [DVec3::new(1.0, 0.0, 5.0), DVec3::new(2.0, 7.0, 5.0), DVec3::new(4.0, 0.5, 5.0)];
        for size in [1.0, 1e-3, 1e-6] {
            let middle = DVec3::new(1.0, -2.0, 3.0);
            let corners = [DVec3::X, DVec3::Y, DVec3::new(-1.0, -1.0, 0.5)].map(|d| middle + d * size);
            let linear = Linear::new(corners, values);
            for [s, t] in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.3, 0.3], [0.1, 0.7]] {
                let mixed = |of: [DVec3; 3]| of[0] * (1.0 - s - t) + of[1] * s + of[2] * t;
                let off = (linear.at(mixed(corners).normalize()) - mixed(values)).length();
                // A direction is rounded by 1e-16 of the distance, that is 4e-16 / size of the triangle, of which the values differ by 7.
                assert!(off < 2e-14 / size, "{size}: {off}");
            }
        }
    }
}
