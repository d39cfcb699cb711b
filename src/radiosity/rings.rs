//! Convex rings of corners.

use glam::DVec3;

/// The mean of its corners.
pub(super) fn mean_of(ring: &[DVec3]) -> DVec3 {
    ring.iter().sum::<DVec3>() / ring.len() as f64
}

/// How far out of a convex ring a point is, along its plane or off it; at most 0 inside.
pub(crate) fn off(ring: &[DVec3], point: DVec3) -> f64 {
    let normal = normal(ring);
    let sides = ring.iter().zip(ring.iter().cycle().skip(1)).map(|(&a, &b)| {
        let outwards = (b - a).cross(normal).normalize_or_zero();
        outwards.dot(point - a)
    });
    sides.fold(f64::NEG_INFINITY, f64::max) + normal.dot(point - ring[0]).abs()
}

/// The unit normal of a ring, or zero.
pub(crate) fn normal(ring: &[DVec3]) -> DVec3 {
    let doubled: DVec3 = ring.windows(2).map(|ends| (ends[0] - ring[0]).cross(ends[1] - ring[0])).sum();
    doubled.normalize_or_zero()
}
