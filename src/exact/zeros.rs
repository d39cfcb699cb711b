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
