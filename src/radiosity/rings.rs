//! Convex rings of corners.

use crate::exact::power_of_two_at_most;
use glam::DVec3;

/// The mean of its corners.
pub(super) fn mean_of(ring: &[DVec3]) -> DVec3 {
    ring.iter().sum::<DVec3>() / ring.len() as f64
}

/// How far out of a convex ring a point is, along its plane or off it; at most 0 inside.
pub(crate) fn off(ring: &[DVec3], point: DVec3) -> f64 {
    let normal = normal(ring);
    let sides = ring.iter().zip(ring.iter().cycle().skip(1)).map(|(&a, &b)| {
        let [along] = in_own_unit([b - a]);
        let outwards = along.cross(normal).normalize_or_zero();
        outwards.dot(point - a)
    });
    sides.fold(f64::NEG_INFINITY, f64::max) + normal.dot(point - ring[0]).abs()
}

/// The unit normal of a ring, or zero.
pub(crate) fn normal(ring: &[DVec3]) -> DVec3 {
    let most = ring.iter().fold(0.0, |most, &p| f64::max(most, (p - ring[0]).abs().max_element()));
    let unit = power_of_two_at_most(most);
    let off = |p: DVec3| (p - ring[0]) / unit;
    let doubled: DVec3 = ring.windows(2).map(|ends| off(ends[0]).cross(off(ends[1]))).sum();
    doubled.normalize_or_zero()
}

/// The length of a vector, of which squares need not be numbers.
pub(super) fn length(v: DVec3) -> f64 {
    let unit = power_of_two_at_most(v.abs().max_element());
    (v / unit).length() * unit
}

/// Vectors in a unit of their own, a power of two so that nothing is rounded: products of them are numbers in any scene.
pub(crate) fn in_own_unit<const N: usize>(vectors: [DVec3; N]) -> [DVec3; N] {
    let most = vectors.iter().fold(0.0, |most, v| f64::max(most, v.abs().max_element()));
    let unit = power_of_two_at_most(most);
    vectors.map(|v| v / unit)
}
