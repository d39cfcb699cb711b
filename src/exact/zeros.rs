//! Zeros that need no arithmetic: known by what things are defined from, or by comparing coordinates.
//!
//! In buildings most zeros are of the second kind: edges along one axis, the sides of a quadtree,
//! vertices as high as the eye.

use super::definition::{Direction, Plane, Point, Splitter};
use glam::DVec3;

/// The components of a vector that are certainly 0, one bit for each axis. A bit that is not set says nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ZeroComponents(u8);

impl ZeroComponents {
    fn from_fn(zero: impl Fn(usize) -> bool) -> Self {
        Self((0..3).fold(0, |bits, axis| bits | u8::from(zero(axis)) << axis))
    }

    /// True if three vectors share a zero: their determinant is 0. So it is for three edges along one axis.
    pub(crate) fn shared([a, b, c]: [Self; 3]) -> bool {
        a.0 & b.0 & c.0 != 0
    }

    /// True if each term of the dot product of two vectors has a zero.
    pub(crate) fn cover(self, other: Self) -> bool {
        self.0 | other.0 == 0b111
    }

    /// Those of the normal of a splitter.
    ///
    /// For an edge, component `k` is `p_i q_j - p_j q_i` with `p = a - e`, `q = b - e`. It is 0 where the edge runs
    /// along axis `k`, and where `p` and `q` share a zero in `i` or `j`.
    pub(crate) fn of_splitter(splitter: &Splitter, eye: DVec3) -> Self {
        match splitter {
            Splitter::Edge([a, b]) => Self::from_fn(|k| {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                let level = |axis: usize| equal(a[axis], eye[axis]) && equal(b[axis], eye[axis]);
                level(i) || level(j) || (equal(a[i], b[i]) && equal(a[j], b[j]))
            }),
            Splitter::Crease([Plane::Axis { axis: i, .. }, Plane::Axis { axis: j, .. }]) => {
                Self::from_fn(|k| k != *i && k != *j)
            }
            Splitter::Given(normal) => Self::from_fn(|k| normal[k] == 0.0),
            Splitter::Parallel(Plane::Axis { axis, .. }) => Self::from_fn(|k| k != *axis),
            Splitter::Crease(_) | Splitter::Parallel(Plane::Points(_)) => Self(0),
        }
    }

    /// Those of a direction. Two normals with a zero in `k` cross along axis `k`.
    pub(crate) fn of_direction(direction: &Direction, eye: DVec3) -> Self {
        match direction {
            Direction::Given(d) => Self::from_fn(|k| d[k] == 0.0),
            Direction::Point(point) => Self::of_point(point, eye),
            Direction::Crossing(splitters) => {
                let [m, n] = splitters.map(|s| Self::of_splitter(&s, eye));
                Self::from_fn(|k| (0..3).any(|other| other != k && m.0 & n.0 & 1 << other != 0))
            }
        }
    }

    /// Those of the direction to a point.
    pub(crate) fn of_point(point: &Point, eye: DVec3) -> Self {
        let in_plane = |plane: &Plane, k: usize| matches!(*plane, Plane::Axis { axis, value } if axis == k && equal(value, eye[k]));
        Self::from_fn(|k| match point {
            Point::Given(p) => equal(p[k], eye[k]),
            Point::EdgePlane([a, b], plane) => (equal(a[k], eye[k]) && equal(b[k], eye[k])) || in_plane(plane, k),
            Point::Planes(planes) => planes.iter().any(|plane| in_plane(plane, k)),
        })
    }
}

/// Exact: denormal numbers are kept, so a difference is 0 for equal numbers only.
fn equal(x: f64, y: f64) -> bool {
    x - y == 0.0
}

/// True if a direction lies on a splitter because of what the two are defined from.
pub(crate) fn defined_on(direction: &Direction, splitter: &Splitter) -> bool {
    match (direction, splitter) {
        (Direction::Crossing(pair), _) => pair.contains(splitter),
        (Direction::Point(Point::Given(p)), Splitter::Edge(ends)) => ends.contains(p),
        (Direction::Point(Point::EdgePlane(ends, _)), Splitter::Edge(other)) => {
            ends == other || (ends[0] == other[1] && ends[1] == other[0])
        }
        (Direction::Point(Point::Planes(three)), Splitter::Crease(two)) => two.iter().all(|p| three.contains(p)),
        _ => false,
    }
}

/// True if three splitters pass through one point that is an end of three edges: they meet in its direction.
pub(crate) fn have_common_end(splitters: [&Splitter; 3]) -> bool {
    let [Splitter::Edge(a), Splitter::Edge(b), Splitter::Edge(c)] = splitters else { return false };
    a.iter().any(|end| b.contains(end) && c.contains(end))
}

/// True if a point is known to lie in a plane.
pub(crate) fn point_in_plane(point: &Point, plane: &Plane) -> bool {
    match (point, plane) {
        (Point::Given(p), Plane::Points(points)) => points.contains(p),
        (Point::EdgePlane(_, cut), _) if cut == plane => true,
        (Point::EdgePlane(ends, _), Plane::Points(points)) => ends.iter().all(|end| points.contains(end)),
        (Point::Planes(planes), _) => planes.contains(plane),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EYE: DVec3 = DVec3::new(1.0, 2.0, 3.0);

    /// The bits for the axes named.
    fn axes(names: &str) -> ZeroComponents {
        ZeroComponents::from_fn(|k| names.contains(["x", "y", "z"][k]))
    }

    fn v(x: f64, y: f64, z: f64) -> DVec3 {
        DVec3::new(x, y, z)
    }

    #[test]
    fn normals_are_zero_where_definitions_say_so() {
        let level = |axis, value| Plane::Axis { axis, value };
        let tilted = Plane::Points([DVec3::X, DVec3::Y, DVec3::Z]);
        for (splitter, names) in [
            // As high as the eye in x: the normal is along x.
            (Splitter::Edge([v(1.0, 5.0, 7.0), v(1.0, 6.0, 9.0)]), "yz"),
            (Splitter::Edge([v(4.0, 2.0, 7.0), v(5.0, 2.0, 9.0)]), "xz"),
            (Splitter::Edge([v(4.0, 5.0, 3.0), v(5.0, 6.0, 3.0)]), "xy"),
            // Along an axis.
            (Splitter::Edge([v(4.0, 5.0, 7.0), v(5.0, 5.0, 7.0)]), "x"),
            (Splitter::Edge([v(4.0, 5.0, 7.0), v(4.0, 6.0, 7.0)]), "y"),
            (Splitter::Edge([v(4.0, 5.0, 7.0), v(4.0, 5.0, 9.0)]), "z"),
            // Only one end is as high as the eye; the ends share one coordinate only.
            (Splitter::Edge([v(1.0, 5.0, 7.0), v(5.0, 6.0, 9.0)]), ""),
            (Splitter::Edge([v(4.0, 5.0, 7.0), v(4.0, 6.0, 9.0)]), ""),
            (Splitter::Crease([level(0, 5.0), level(2, 7.0)]), "y"),
            (Splitter::Crease([level(0, 5.0), tilted]), ""),
            (Splitter::Given(v(0.0, -0.0, 5e-324)), "xy"),
            (Splitter::Parallel(level(1, 9.0)), "xz"),
            (Splitter::Parallel(tilted), ""),
        ] {
            assert_eq!(ZeroComponents::of_splitter(&splitter, EYE), axes(names), "{splitter:?}");
        }
    }

    #[test]
    fn directions_are_zero_where_definitions_say_so() {
        let level = |axis, value| Plane::Axis { axis, value };
        let tilted = Plane::Points([DVec3::X, DVec3::Y, DVec3::Z]);
        let upright = |x: f64| Splitter::Given(v(x, 1.0, 0.0));
        for (direction, names) in [
            (Direction::Given(v(0.0, 1.0, -0.0)), "xz"),
            (Direction::Point(Point::Given(v(1.0, 5.0, 3.0))), "xz"),
            (Direction::Point(Point::EdgePlane([v(1.0, 5.0, 7.0), v(1.0, 9.0, 8.0)], level(2, 7.5))), "x"),
            (Direction::Point(Point::EdgePlane([v(1.0, 5.0, 7.0), v(2.0, 9.0, 8.0)], level(1, 7.5))), ""),
            (Direction::Point(Point::EdgePlane([v(0.0, 5.0, 7.0), v(4.0, 9.0, 8.0)], level(0, 1.0))), "x"),
            (Direction::Point(Point::Planes([level(0, 1.0), level(1, 5.0), tilted])), "x"),
            (Direction::Point(Point::Planes([tilted, level(2, 3.0), level(1, 2.0)])), "yz"),
            // Two circles through an axis cross there.
            (Direction::Crossing([upright(3.0), upright(4.0)]), "xy"),
            (Direction::Crossing([upright(3.0), Splitter::Given(v(1.0, 0.0, 2.0))]), ""),
        ] {
            assert_eq!(ZeroComponents::of_direction(&direction, EYE), axes(names), "{direction:?}");
        }
    }

    #[test]
    fn zeros_are_shared_by_all_three_and_cover_all_axes() {
        assert!(ZeroComponents::shared([axes("xy"), axes("yz"), axes("y")]));
        assert!(!ZeroComponents::shared([axes("xy"), axes("yz"), axes("xz")]));
        assert!(axes("xy").cover(axes("z")) && axes("xyz").cover(axes("")));
        assert!(axes("xy").cover(axes("yz")));
        assert!(!axes("xy").cover(axes("x")) && !axes("").cover(axes("yz")));
    }

    #[test]
    fn what_is_defined_from_the_same_ends_and_planes_meets() {
        let (a, b, c, d) = (DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE);
        let plane = |k: f64| Plane::Axis { axis: 0, value: k };
        let (edge, other) = (Splitter::Edge([a, b]), Splitter::Edge([c, d]));
        let cut = |p, q| Direction::Point(Point::EdgePlane([p, q], plane(0.5)));
        assert!(defined_on(&Direction::Crossing([other, edge]), &edge));
        assert!(!defined_on(&Direction::Crossing([other, edge]), &Splitter::Edge([a, c])));
        assert!(defined_on(&Direction::Point(Point::Given(b)), &edge));
        assert!(!defined_on(&Direction::Point(Point::Given(c)), &edge));
        assert!(defined_on(&cut(a, b), &edge) && defined_on(&cut(b, a), &edge));
        assert!(!defined_on(&cut(a, c), &edge) && !defined_on(&cut(c, b), &edge) && !defined_on(&cut(b, c), &edge));
        let three = Direction::Point(Point::Planes([plane(1.0), plane(2.0), plane(3.0)]));
        assert!(defined_on(&three, &Splitter::Crease([plane(3.0), plane(1.0)])));
        assert!(!defined_on(&three, &Splitter::Crease([plane(3.0), plane(4.0)])));
        assert!(!defined_on(&Direction::Given(a), &Splitter::Given(a)));

        let edge = |p, q| Splitter::Edge([p, q]);
        assert!(have_common_end([&edge(a, b), &edge(c, a), &edge(a, d)]));
        assert!(!have_common_end([&edge(a, b), &edge(b, c), &edge(c, a)]));
        assert!(!have_common_end([&edge(a, b), &edge(a, c), &edge(b, d)]));
        assert!(!have_common_end([&edge(a, b), &edge(c, a), &Splitter::Given(a)]));

        let points = Plane::Points([a, b, c]);
        assert!(point_in_plane(&Point::Given(c), &points) && !point_in_plane(&Point::Given(d), &points));
        assert!(point_in_plane(&Point::EdgePlane([a, d], plane(2.0)), &plane(2.0)));
        assert!(point_in_plane(&Point::EdgePlane([a, c], plane(2.0)), &points));
        assert!(!point_in_plane(&Point::EdgePlane([a, d], plane(2.0)), &points));
        assert!(point_in_plane(&Point::Planes([points, plane(1.0), plane(2.0)]), &plane(2.0)));
        assert!(!point_in_plane(&Point::Planes([points, plane(1.0), plane(2.0)]), &plane(3.0)));
    }
}
