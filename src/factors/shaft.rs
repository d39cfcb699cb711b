//! What may be between two convex polygons: everything that meets their shaft, the convex hull of both (Haines and Wallace 1991).
//!
//! All decisions are exact signs of determinants of corners. What touches the shaft only from outside does not block; what cannot be told stays a
//! possible blocker, at the price of views.

use super::shape::sides;
use crate::exact::{Sign, orient3d};
use glam::DVec3;

/// On which side of a plane a polygon is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lies {
    /// In front of it, or on it with some corners.
    Front,
    /// Behind it, or on it with some corners.
    Behind,
    /// In it.
    On,
    /// On both sides.
    Across,
}

impl Lies {
    /// Of a ring, to the plane through three points.
    pub(super) fn of(ring: &[DVec3], [a, b, c]: [DVec3; 3]) -> Self {
        let (mut front, mut behind) = (false, false);
        for &p in ring {
            match orient3d(a, b, c, p) {
                Sign::Positive => front = true,
                Sign::Negative => behind = true,
                Sign::Zero => {}
            }
        }
        match (front, behind) {
            (true, true) => Self::Across,
            (true, false) => Self::Front,
            (false, true) => Self::Behind,
            (false, false) => Self::On,
        }
    }

    /// True if no point of the two is on opposite sides.
    pub(super) fn is_beside(self, other: Self) -> bool {
        match (self, other) {
            (Self::Across, _) | (_, Self::Across) => false,
            (Self::On, _) | (_, Self::On) => true,
            (a, b) => a == b,
        }
    }
}

/// What a polygon does to light between two others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Blocks {
    Nothing,
    Everything,
    Unknown,
}

/// The shaft between two convex polygons.
pub(super) struct Shaft {
    /// Planes, by three points, that have both polygons in front of them or on them.
    planes: Vec<[DVec3; 3]>,
    low: DVec3,
    high: DVec3,
}

impl Shaft {
    /// Between two rings.
    pub(super) fn between(i: &[DVec3], j: &[DVec3]) -> Self {
        let all = || i.iter().chain(j).copied();
        let mut planes = Vec::new();
        for (ring, other) in [(i, j), (j, i)] {
            for [a, b] in sides(ring) {
                // A plane along this side that touches the other polygon. There are two of them; the one turned to have all in front is one of these orders.
                for &c in other {
                    for [a, b] in [[a, b], [b, a]] {
                        if is_in_front(all(), [a, b, c]) {
                            planes.push([a, b, c]);
                        }
                    }
                }
            }
        }
        let low = all().fold(DVec3::INFINITY, DVec3::min);
        let high = all().fold(DVec3::NEG_INFINITY, DVec3::max);
        Self { planes, low, high }
    }

    /// True if a box may have points inside of the shaft's own box.
    pub(super) fn may_meet(&self, low: DVec3, high: DVec3) -> bool {
        self.low.cmple(high).all() && self.high.cmpge(low).all()
    }

    /// True if a polygon is certainly outside, though it may touch.
    pub(super) fn excludes(&self, ring: &[DVec3]) -> bool {
        let is_outside = |&[a, b, c]: &[DVec3; 3]| ring.iter().all(|&p| !orient3d(a, b, c, p).is_positive());
        let beyond = |axis: usize| {
            ring.iter().all(|p| p[axis] <= self.low[axis]) || ring.iter().all(|p| p[axis] >= self.high[axis])
        };
        // A polygon may lie in a face of a box that is no more than that face.
        let is_flat = |axis: usize| self.low[axis] == self.high[axis];
        (0..3).any(|axis| !is_flat(axis) && beyond(axis)) || self.planes.iter().any(is_outside)
    }
}

/// True if no point is behind the plane and some are not on it.
fn is_in_front(points: impl Iterator<Item = DVec3>, [a, b, c]: [DVec3; 3]) -> bool {
    let mut some = false;
    for p in points {
        match orient3d(a, b, c, p) {
            Sign::Negative => return false,
            Sign::Positive => some = true,
            Sign::Zero => {}
        }
    }
    some
}

/// What a convex polygon does between two others that are on opposite sides of its plane, `front` on the front or on it, `behind` behind or on it:
/// lines between corners pass its sides all inside, or one all outside, or it cannot be told.
pub(super) fn across(front: &[DVec3], behind: &[DVec3], blocker: &[DVec3]) -> Blocks {
    let mut hides = true;
    for [a, b] in sides(blocker) {
        let (mut inside, mut outside) = (false, false);
        for &p in front {
            for &q in behind {
                // Seen from the front, along p to q, a side that runs counter-clockwise has its inside to the left.
                match orient3d(a, b, p, q) {
                    Sign::Positive => outside = true,
                    Sign::Negative => inside = true,
                    Sign::Zero => {}
                }
                if inside && outside {
                    break;
                }
            }
        }
        if outside && !inside {
            return Blocks::Nothing;
        }
        hides &= !outside;
    }
    if hides { Blocks::Everything } else { Blocks::Unknown }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(z: f64, half: f64, centre: [f64; 2]) -> Vec<DVec3> {
        let [x, y] = centre;
        [[-1., -1.], [1., -1.], [1., 1.], [-1., 1.]].map(|[u, v]| DVec3::new(x + half * u, y + half * v, z)).to_vec()
    }

    #[test]
    fn lines_pass_inside_outside_or_both() {
        let (front, behind) = (square(1.0, 1.0, [0.0; 2]), square(-1.0, 1.0, [0.0; 2]));
        assert_eq!(across(&front, &behind, &square(0.0, 1.0, [0.0; 2])), Blocks::Everything);
        assert_eq!(across(&front, &behind, &square(0.0, 0.999, [0.0; 2])), Blocks::Unknown);
        assert_eq!(across(&front, &behind, &square(0.0, 0.5, [1.5, 0.0])), Blocks::Nothing);
        assert_eq!(across(&front, &behind, &square(0.0, 0.5, [1.499, 0.0])), Blocks::Unknown);
        // A small source seen past a large receiver: the shaft is narrower in the middle.
        let point = square(1.0, 0.0, [0.0; 2]);
        assert_eq!(across(&point, &behind, &square(0.0, 0.5, [0.0; 2])), Blocks::Everything);
        assert_eq!(across(&point, &behind, &square(0.0, 0.5, [1.0, 0.0])), Blocks::Nothing);
    }

    #[test]
    fn a_shaft_excludes_what_touches_it_from_outside() {
        let shaft = Shaft::between(&square(1.0, 1.0, [0.0; 2]), &square(-1.0, 2.0, [0.0; 2]));
        assert!(shaft.excludes(&square(0.0, 0.5, [2.0, 0.0])));
        assert!(!shaft.excludes(&square(0.0, 0.5, [1.999, 0.0])));
        assert!(shaft.excludes(&square(1.0, 5.0, [0.0; 2])));
        assert!(!shaft.excludes(&square(0.999, 5.0, [0.0; 2])));
    }

    #[test]
    fn sides_of_planes_are_exact() {
        let plane = [DVec3::ZERO, DVec3::X, DVec3::Y];
        assert_eq!(Lies::of(&square(0.0, 1.0, [0.0; 2]), plane), Lies::On);
        assert_eq!(Lies::of(&square(1e-300, 1.0, [0.0; 2]), plane), Lies::Front);
        assert_eq!(Lies::of(&square(-1e-300, 1.0, [0.0; 2]), plane), Lies::Behind);
        assert_eq!(Lies::of(&[DVec3::ZERO, DVec3::Z, DVec3::NEG_Z], plane), Lies::Across);
        assert!(
            Lies::On.is_beside(Lies::Front)
                && !Lies::Front.is_beside(Lies::Behind)
                && !Lies::On.is_beside(Lies::Across)
        );
    }
}
