//! Seeing a polygon flat: projections along an axis and exact signs in the plane.

use super::Axis;
use crate::exact::{Sign, orient3d};
use glam::{DVec2, DVec3};

/// Drops the coordinate on `axis`, so that what runs counter-clockwise seen from the side of larger
/// coordinates still does. Exact.
pub(super) fn project(p: DVec3, axis: Axis) -> DVec2 {
    match axis {
        Axis::X => DVec2::new(p.y, p.z),
        Axis::Y => DVec2::new(p.z, p.x),
        Axis::Z => DVec2::new(p.x, p.y),
    }
}

/// Positive if `a`, `b`, `c` run counter-clockwise, zero if they are collinear. Exact for all finite
/// numbers: it is the three-dimensional sign with a fourth point one unit above `a`.
pub(super) fn orient2d(a: DVec2, b: DVec2, c: DVec2) -> Sign {
    orient3d(a.extend(0.0), b.extend(0.0), c.extend(0.0), a.extend(1.0))
}

/// The orientation of a triangle seen along an axis. Exact.
pub(super) fn orientation(triangle: [DVec3; 3], axis: Axis) -> Sign {
    let [a, b, c] = triangle.map(|p| project(p, axis));
    orient2d(a, b, c)
}

/// True if three points are collinear in space. Exact.
pub(super) fn collinear(triangle: [DVec3; 3]) -> bool {
    Axis::ALL.into_iter().all(|axis| orientation(triangle, axis).is_zero())
}

/// The axes by falling size of a normal's components.
pub(super) fn axes_by_size(normal: DVec3) -> [Axis; 3] {
    let size = normal.abs();
    let mut axes = [(size.x, Axis::X), (size.y, Axis::Y), (size.z, Axis::Z)];
    axes.sort_by(|a, b| b.0.total_cmp(&a.0));
    axes.map(|(_, axis)| axis)
}

/// The power of two that brings the largest of some coordinates near 1, for estimates that neither
/// overflow nor vanish.
pub(crate) fn unit_scale(points: impl IntoIterator<Item = DVec3>) -> f64 {
    let largest = points.into_iter().fold(0.0, |size: f64, p| size.max(p.abs().max_element()));
    if largest == 0.0 {
        return 1.0;
    }
    let exponent = (largest.to_bits() >> 52) as i32 - 1023;
    2.0_f64.powi((-exponent).clamp(-1020, 1020))
}

/// A length that was taken of points multiplied by a scale: without it, the largest f64 if it is longer than that.
pub(super) fn unscaled(length: f64, scale: f64) -> f64 {
    (length / scale).min(f64::MAX)
}

/// The distance of two points, rounded; the largest f64 if it is longer than that.
pub(super) fn distance(a: DVec3, b: DVec3) -> f64 {
    // Halves have finite differences, and the scale is taken of those, so that short ones do not vanish.
    let step = a * 0.5 - b * 0.5;
    let scale = unit_scale([step]);
    unscaled((step * scale).length(), scale * 0.5)
}

/// The diagonal of the box around some points, rounded; 0 without any.
pub(super) fn box_diagonal(points: impl IntoIterator<Item = DVec3>) -> f64 {
    let bounds = points.into_iter().fold(None, |bounds, p| {
        let (low, high) = bounds.unwrap_or((p, p));
        Some((p.min(low), p.max(high)))
    });
    bounds.map_or(0.0, |(low, high)| distance(low, high))
}

/// Three vertices that span a large triangle, in ascending order of their places; `None` if all
/// points are collinear.
///
/// The choice is an estimate (the point farthest from the first, then the one that makes the
/// largest triangle with both); that they are not collinear is exact. Linear time.
pub(super) fn spread(points: &[DVec3]) -> Option<[usize; 3]> {
    let scale = unit_scale(points.iter().copied());
    let first = *points.first()?;
    let offset = |p: DVec3| p * scale - first * scale;
    let b = largest(points.iter().map(|&p| offset(p).abs().max_element()))?;
    let along = offset(points[b]);
    let c = largest(points.iter().map(|&p| along.cross(offset(p)).length_squared()))?;
    let b = if points[b] == first { points.iter().position(|&p| p != first)? } else { b };
    let is_off = |k: &usize| !collinear([first, points[b], points[*k]]);
    let c = Some(c).filter(is_off).or_else(|| (0..points.len()).find(is_off))?;
    Some([0, b.min(c), b.max(c)])
}

/// True if all points lie in one plane or on one line. Exact; linear time.
pub(super) fn is_planar(points: &[DVec3]) -> bool {
    let Some(corners) = spread(points) else { return true };
    let [a, b, c] = corners.map(|k| points[k]);
    points.iter().enumerate().all(|(k, &p)| corners.contains(&k) || orient3d(a, b, c, p).is_zero())
}

/// The place of the first largest number.
fn largest(numbers: impl Iterator<Item = f64>) -> Option<usize> {
    let mut best: Option<(usize, f64)> = None;
    for (k, number) in numbers.enumerate() {
        if best.is_none_or(|(_, size)| number > size) {
            best = Some((k, number));
        }
    }
    best.map(|(k, _)| k)
}

/// An estimate of the normal of a triangle, of no particular length.
pub(super) fn triangle_normal(triangle: [DVec3; 3]) -> DVec3 {
    let scale = unit_scale(triangle);
    let [a, b, c] = triangle.map(|p| p * scale);
    (b - a).cross(c - a)
}

/// An estimate of the vector area of a closed ring (Newell's normal), scaled to no particular
/// length; zero or nearly so for rings that fold back on themselves.
pub(super) fn newell_normal(ring: &[DVec3]) -> DVec3 {
    let Some(&first) = ring.first() else { return DVec3::ZERO };
    let scale = unit_scale(ring.iter().copied());
    let offset = |p: DVec3| p * scale - first * scale;
    ring.windows(2).map(|pair| offset(pair[0]).cross(offset(pair[1]))).sum()
}

/// True if the ring, seen along `axis`, is weakly convex: it turns to one side only, goes around
/// once and never runs back along itself. Exact; linear time.
///
/// No two consecutive points may be equal.
pub(super) fn is_convex(ring: &[DVec3], axis: Axis) -> bool {
    let flat = |k: usize| project(ring[k % ring.len()], axis);
    // Going around a convex ring once, one runs to the right once and to the left once.
    let rightward = |a: DVec2, b: DVec2| a.to_array() < b.to_array();
    let mut side = Sign::Zero;
    let mut reversals = 0;
    for k in 0..ring.len() {
        let (a, b, c) = (flat(k), flat(k + 1), flat(k + 2));
        let turns_back = rightward(a, b) != rightward(b, c);
        reversals += u32::from(turns_back);
        let turn = orient2d(a, b, c);
        if turn.is_zero() {
            if turns_back {
                return false;
            }
        } else if turn == -side {
            return false;
        } else {
            side = turn;
        }
    }
    !side.is_zero() && reversals == 2
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: &[[f64; 2]]) -> Vec<DVec3> {
        points.iter().map(|p| DVec3::new(p[0], p[1], 0.0)).collect()
    }

    #[test]
    fn projections_keep_counter_clockwise() {
        let triangle = [DVec3::X, DVec3::Y, DVec3::Z];
        for axis in Axis::ALL {
            assert_eq!(orientation(triangle, axis), Sign::Positive);
        }
    }

    #[test]
    fn convex_rings_may_have_straight_corners() {
        assert!(is_convex(&ring(&[[0., 0.], [1., 0.], [2., 0.], [2., 2.], [0., 2.]]), Axis::Z));
        assert!(is_convex(&ring(&[[0., 2.], [2., 2.], [2., 0.], [0., 0.]]), Axis::Z));
    }

    #[test]
    fn spikes_dents_and_double_turns_are_not_convex() {
        assert!(!is_convex(&ring(&[[0., 0.], [3., 0.], [2., 0.], [2., 2.]]), Axis::Z), "spike");
        assert!(!is_convex(&ring(&[[0., 0.], [2., 0.], [1., 0.5], [2., 2.]]), Axis::Z), "dent");
        let square = [[0., 0.], [1., 0.], [1., 1.], [0., 1.]];
        let twice: Vec<_> = square.iter().chain(&square).copied().collect();
        assert!(!is_convex(&ring(&twice), Axis::Z), "going around twice");
        let star: Vec<_> =
            (0..5).map(|k| f64::from(k) * 0.8 * std::f64::consts::PI).map(|a| [a.cos(), a.sin()]).collect();
        assert!(!is_convex(&ring(&star), Axis::Z), "pentagram");
    }

    #[test]
    fn spread_finds_the_one_point_off_a_line() {
        let mut points: Vec<_> = (0..50).map(|k| DVec3::new(f64::from(k), f64::from(k), 0.0)).collect();
        assert_eq!(spread(&points), None);
        points.push(DVec3::new(25.0, 25.0, 1e-300));
        assert_eq!(spread(&points), Some([0, 49, 50]));
        assert_eq!(spread(&[DVec3::ONE; 4]), None);
        assert_eq!(spread(&[]), None);
    }

    #[test]
    fn estimates_survive_huge_and_tiny_coordinates() {
        for size in [1e-300, 1e300, f64::MAX] {
            let triangle = [DVec3::ZERO, DVec3::X * size, DVec3::new(-size, size, 0.0)];
            let normal = triangle_normal(triangle);
            assert!(normal.is_finite() && normal.z > 0.0, "{size:e}: {normal}");
            assert!(newell_normal(&triangle).z > 0.0, "{size:e}");
        }
    }
}
