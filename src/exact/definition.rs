//! What planes, points, great circles and directions are, by exact definition.
//!
//! Nothing here is rounded: a definition names the f64 coordinates it comes from and stands for the
//! real object. "The eye" is the origin of the [`Kernel`](super::Kernel) that a definition is used with.

use glam::DVec3;

/// A plane in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Plane {
    /// All points whose coordinate number `axis` (0, 1 or 2) is `value`; its normal is that axis.
    Axis {
        /// The number of the coordinate.
        axis: usize,
        /// Its value.
        value: f64,
    },
    /// The plane through three points `a`, `b`, `c` that are not collinear; its normal is
    /// `(b - a) x (c - a)`.
    Points([DVec3; 3]),
}

/// A point in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Point {
    /// Given by its coordinates.
    Given(DVec3),
    /// Where the straight line between two points crosses a plane that strictly separates them.
    EdgePlane([DVec3; 2], Plane),
    /// Where three planes meet; their normals are linearly independent.
    Planes([Plane; 3]),
}

/// A great circle with a side: a plane through the eye, by its normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Splitter {
    /// Through two points that are not in line with the eye `e`: `(a - e) x (b - e)`.
    Edge([DVec3; 2]),
    /// Through the line where two planes meet: `h_2 N_1 - h_1 N_2`, with the planes' normals `N` and the
    /// heights `h = N . (e - p)` of the eye over them; at most one of the heights is 0.
    Crease([Plane; 2]),
    /// A normal given by its coordinates, not all of them 0.
    Given(DVec3),
    /// The plane moved to the eye.
    Parallel(Plane),
}

/// A direction from the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Direction {
    /// Given by its coordinates, not all of them 0.
    Given(DVec3),
    /// Towards a point other than the eye.
    Point(Point),
    /// `n_1 x n_2` for the normals of two different great circles.
    Crossing([Splitter; 2]),
}

impl Plane {
    /// The coordinates it is defined by, axis-aligned planes with zeros for the other two.
    pub(crate) fn coordinates(&self) -> [DVec3; 3] {
        match *self {
            Self::Axis { axis, value } => {
                let mut p = DVec3::ZERO;
                p[axis] = value;
                [p; 3]
            }
            Self::Points(points) => points,
        }
    }
}
