//! On which side of a plane points and polygons are, exactly.

use crate::exact::{Sign, U, orient3d};
use glam::{DVec3, Vec3Swizzles};

/// A plane through three points, for many signs.
pub(super) struct Plane {
    pub(super) points: [DVec3; 3],
    pub(super) normal: DVec3,
    /// The sum of the absolute values of the products that each component of the normal is a difference of.
    pub(super) permanent: DVec3,
}

impl Plane {
    pub(super) fn through([a, b, c]: [DVec3; 3]) -> Self {
        let (p, q) = (b - a, c - a);
        let permanent = p.yzx().abs() * q.zxy().abs() + p.zxy().abs() * q.yzx().abs();
        Self { points: [a, b, c], normal: p.cross(q), permanent }
    }

    /// The sign of `orient3d` of the three points and another one, if a filter is sure of it.
    ///
    /// The filter is that of `orient3d` (docs/numerics.md): the determinant is off by less than 10 u times the permanent, of factors that
    /// neither over- nor underflow.
    #[inline]
    pub(super) fn sure_side(&self, p: DVec3) -> Option<Sign> {
        let r = p - self.points[0];
        let (det, permanent) = (self.normal.dot(r), self.permanent.dot(r.abs()));
        let is_sure = permanent > 1e-180
            && permanent < 1e120
            && r.abs().max_element() < 1e120
            && det.abs() > 10.0 * U * permanent;
        is_sure.then_some(if det > 0.0 { Sign::Positive } else { Sign::Negative })
    }

    #[inline]
    pub(super) fn side(&self, p: DVec3) -> Sign {
        self.sure_side(p).unwrap_or_else(|| exact_side(self.points, p))
    }
}

/// The sign of `orient3d`, where zero is likely.
pub(super) fn exact_side([a, b, c]: [DVec3; 3], p: DVec3) -> Sign {
    if is_on_evidently([a, b, c], p) { Sign::Zero } else { orient3d(a, b, c, p) }
}

/// True if a point is on a plane for a reason that shows without arithmetic, as is the rule among things with axis-parallel sides: it is one of the three,
/// in a plane of equal coordinates with all of them, or beside one of them in a direction that two of them are apart in.
#[inline]
fn is_on_evidently([a, b, c]: [DVec3; 3], p: DVec3) -> bool {
    let same = |p: DVec3, q: DVec3| p.cmpeq(q).bitmask();
    let [ab, bc, ca] = [same(a, b), same(b, c), same(c, a)];
    let to_p = [same(a, p), same(b, p), same(c, p)];
    // For each axis, the bits of the others.
    to_p.contains(&0b111)
        || ab & bc & to_p[0] != 0
        || [0b110, 0b101, 0b011].iter().any(|&others| {
            let holds = |bits: &u32| bits & others == others;
            [ab, bc, ca].iter().any(holds) && to_p.iter().any(holds)
        })
}

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
    pub(super) fn of(ring: &[DVec3], plane: [DVec3; 3]) -> Self {
        let plane = Plane::through(plane);
        Self::of_signs(ring.iter().map(|&p| plane.side(p)))
    }

    pub(super) fn of_signs(signs: impl Iterator<Item = Sign>) -> Self {
        let (mut front, mut behind) = (false, false);
        for sign in signs {
            front |= sign == Sign::Positive;
            behind |= sign == Sign::Negative;
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

#[cfg(test)]
mod tests {
    use super::super::shape::square;
    use super::*;

    #[test]
    fn points_are_evidently_on_planes_that_hold_them() {
        let on = |points: [[i32; 3]; 3], p: [i32; 3]| {
            let [a, b, c, p] = [points[0], points[1], points[2], p].map(|p| DVec3::from(p.map(f64::from)));
            let evident = is_on_evidently([a, b, c], p);
            assert!(!evident || orient3d(a, b, c, p).is_zero(), "{points:?} {p}");
            evident
        };
        assert!(on([[1, 2, 3], [4, 6, 5], [7, 7, 8]], [4, 6, 5]));
        assert!(on([[1, 2, 3], [4, 6, 3], [7, 7, 3]], [9, 1, 3]));
        assert!(on([[1, 2, 3], [1, 2, 5], [7, 7, 8]], [7, 7, 1]));
        assert!(!on([[1, 2, 3], [1, 3, 5], [7, 7, 8]], [7, 7, 1]));
        // All of a small grid: whatever is evident is so.
        let point = |k: i32| [k % 2, k / 2 % 2, k / 4 % 3];
        let places = || 0..12;
        for a in places() {
            for b in places() {
                for c in places() {
                    places().for_each(|p| _ = on([point(a), point(b), point(c)], point(p)));
                }
            }
        }
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
