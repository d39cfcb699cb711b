//! On which side of the plane through three points a fourth lies.

use super::Sign;
use glam::DVec3;
use robust::Coord3D;

/// The sign of `(b - a) x (c - a) . (d - a)`: positive when `d` lies on the side from which
/// `a`, `b`, `c` run counter-clockwise, zero exactly on their plane.
pub fn orient3d(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Sign {
    let coord = |p: DVec3| Coord3D { x: p.x, y: p.y, z: p.z };
    // `robust` has the opposite orientation.
    -Sign::of(robust::orient3d(coord(a), coord(b), coord(c), coord(d)))
}
