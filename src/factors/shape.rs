//! Flat convex polygons in space.

use glam::{DVec2, DVec3};

/// An orthonormal frame in a plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub(super) origin: DVec3,
    u: DVec3,
    v: DVec3,
    /// The unit normal u x v.
    pub(super) normal: DVec3,
}

impl Frame {
    /// Of the plane through three points that are not in line and run counter-clockwise seen from the normal's side; u runs from the first to the second.
    pub(super) fn through([a, b, c]: [DVec3; 3]) -> Self {
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let u = (b - a).normalize_or_zero();
        Self { origin: a, u, v: normal.cross(u), normal }
    }

    /// The coordinates of a point of the plane.
    #[inline]
    pub(super) fn flat(&self, p: DVec3) -> DVec2 {
        let d = p - self.origin;
        DVec2::new(d.dot(self.u), d.dot(self.v))
    }

    /// The point with these coordinates.
    pub(super) fn lift(&self, p: DVec2) -> DVec3 {
        self.origin + self.u * p.x + self.v * p.y
    }

    /// The coordinates of any point, with its height over the plane as the third.
    #[inline]
    pub(super) fn local(&self, p: DVec3) -> DVec3 {
        self.turned(p - self.origin)
    }

    /// A vector along its coordinates and its normal.
    #[inline]
    pub(super) fn turned(&self, v: DVec3) -> DVec3 {
        DVec3::new(v.dot(self.u), v.dot(self.v), v.dot(self.normal))
    }

    /// The unit vectors along its coordinates.
    #[inline]
    pub(super) fn axes(&self) -> (DVec3, DVec3) {
        (self.u, self.v)
    }

    /// The height of a point over the plane.
    #[inline]
    pub(super) fn height(&self, p: DVec3) -> f64 {
        self.normal.dot(p - self.origin)
    }
}

/// The sides of a ring, as pairs of corners.
pub(super) fn sides<T: Copy>(ring: &[T]) -> impl Iterator<Item = [T; 2]> + '_ {
    ring.iter().zip(ring.iter().cycle().skip(1)).map(|(&a, &b)| [a, b])
}

/// Twice the area vector of a ring.
pub(super) fn double_area(ring: &[DVec3]) -> DVec3 {
    let Some(&first) = ring.first() else { return DVec3::ZERO };
    sides(ring).map(|[a, b]| (a - first).cross(b - a)).sum()
}

/// The centre of mass of a convex ring; its first corner if it has no area.
pub(super) fn centre(ring: &[DVec3]) -> DVec3 {
    let [first, rest @ ..] = ring else { return DVec3::ZERO };
    let (mut sum, mut whole) = (DVec3::ZERO, 0.0);
    for pair in rest.windows(2) {
        let (b, c) = (pair[0] - first, pair[1] - first);
        let area = b.cross(c).length();
        sum += (b + c) * area;
        whole += area;
    }
    if whole > 0.0 { first + sum / (3.0 * whole) } else { *first }
}

/// Cuts a convex ring to where `side` is not negative; `side` is linear. What is left has less than three corners if it is nothing.
pub(super) fn clip<T>(ring: &[T], side: impl Fn(T) -> f64, kept: &mut Vec<T>)
where
    T: Copy + std::ops::Add<Output = T> + std::ops::Sub<Output = T> + std::ops::Mul<f64, Output = T>,
{
    kept.clear();
    for [a, b] in sides(ring) {
        let (from, to) = (side(a), side(b));
        if from >= 0.0 {
            kept.push(a);
        }
        if from > 0.0 && to < 0.0 || from < 0.0 && to > 0.0 {
            kept.push(a + (b - a) * (from / (from - to)));
        }
    }
}

/// Twice the signed area on the side of q - p: positive if p, q, r run counter-clockwise.
pub(super) fn turn(p: DVec2, q: DVec2, r: DVec2) -> f64 {
    (q - p).perp_dot(r - p)
}

/// A square at a height.
#[cfg(test)]
pub(super) fn square(z: f64, half: f64, centre: [f64; 2]) -> Vec<DVec3> {
    let [x, y] = centre;
    [[-1., -1.], [1., -1.], [1., 1.], [-1., 1.]].map(|[u, v]| DVec3::new(x + half * u, y + half * v, z)).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_and_centres_are_those_of_rectangles_and_triangles() {
        let ring = [[1., 1., 3.], [5., 1., 3.], [5., 3., 3.], [1., 3., 3.]].map(DVec3::from);
        assert_eq!(double_area(&ring), DVec3::new(0.0, 0.0, 16.0));
        assert_eq!(centre(&ring), DVec3::new(3.0, 2.0, 3.0));
        let off = centre(&ring[..3]).distance(DVec3::new(11.0, 5.0, 9.0) / 3.0);
        assert!(off < 1e-15, "{off:e}");
        assert_eq!(double_area(&ring[..2]), DVec3::ZERO);
    }

    #[test]
    fn a_ring_is_cut_where_the_line_crosses_it() {
        let ring = [[0., 0.], [2., 0.], [2., 2.], [0., 2.]].map(DVec2::from);
        let mut kept = Vec::new();
        clip(&ring, |p| 1.0 - p.x, &mut kept);
        assert_eq!(kept, [[0., 0.], [1., 0.], [1., 2.], [0., 2.]].map(DVec2::from));
        clip(&ring, |p| p.x - 2.0, &mut kept);
        assert_eq!(kept.len(), 2);
        clip(&ring, |p| p.x - 3.0, &mut kept);
        assert!(kept.is_empty());
    }

    #[test]
    fn a_frame_is_turned_towards_its_front() {
        let frame = Frame::through([DVec3::ZERO, DVec3::new(0.0, 2.0, 0.0), DVec3::new(0.0, 1.0, 3.0)]);
        assert_eq!(frame.normal, DVec3::X);
        let p = DVec3::new(0.0, 0.5, 0.25);
        assert_eq!(frame.flat(p), DVec2::new(0.5, 0.25));
        assert_eq!(frame.lift(frame.flat(p)), p);
        assert!((frame.height(DVec3::new(4.0, 1.0, 1.0)) - 4.0).abs() <= 0.0);
    }
}
