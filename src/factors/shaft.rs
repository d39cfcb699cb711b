//! What may be between two convex polygons: everything that meets their shaft, the convex hull of both (Haines and Wallace 1991).
//!
//! All decisions are exact signs of determinants of corners. What touches the shaft only from outside does not block; what cannot be told stays a
//! possible blocker, at the price of views.

use super::lies::Plane;
use super::shape::sides;
use crate::exact::{Sign, U};
use glam::DVec3;

/// The shaft between two convex polygons.
pub(super) struct Shaft {
    /// Planes that have both polygons on one side of them or on them, and that side.
    planes: Vec<(Plane, Sign)>,
    bounds: Vec<Bound>,
    low: DVec3,
    high: DVec3,
}

/// A plane of a shaft, for boxes: heights over it are positive on the shaft's side.
struct Bound {
    normal: DVec3,
    offset: f64,
    /// The error of a height is below this times the largest coordinates of the box and of the plane together.
    error: f64,
    coordinate: f64,
}

impl Bound {
    /// The filter of [`Plane`], with as much again for each of rounding of the offset, of the box's centre and of what it reaches out.
    fn of(plane: &Plane, side: Sign) -> Self {
        let normal = if side == Sign::Positive { plane.normal } else { -plane.normal };
        let error = 40.0 * U * plane.permanent.element_sum();
        Self { normal, offset: -normal.dot(plane.points[0]), error, coordinate: plane.points[0].abs().max_element() }
    }

    /// True if all of a box is certainly on the other side; `coordinate` is its largest.
    #[inline]
    fn excludes(&self, centre: DVec3, half: DVec3, coordinate: f64) -> bool {
        let highest = self.normal.dot(centre) + self.offset + self.normal.abs().dot(half);
        let bound = self.error * (coordinate + self.coordinate);
        bound > 1e-180 && bound < 1e120 && highest < -bound
    }
}

impl Shaft {
    /// Between two rings.
    pub(super) fn between(i: &[DVec3], j: &[DVec3]) -> Self {
        let all = || i.iter().chain(j).copied();
        let mut planes = Vec::new();
        for (ring, other) in [(i, j), (j, i)] {
            for (k, [a, b]) in sides(ring).enumerate() {
                let next = if k + 1 == ring.len() { 0 } else { k + 1 };
                // A plane along this side that touches the other polygon.
                for (m, &c) in other.iter().enumerate() {
                    let plane = Plane::through([a, b, c]);
                    // The points that it is through are on it; next to the last of them is what is most often on both sides.
                    let (before, after) = other.split_at(m);
                    let others = after[1..].iter().chain(before.iter().rev());
                    let own = ring.iter().enumerate().filter(|&(n, _)| n != k && n != next).map(|(_, p)| p);
                    if let Some(side) = common_side(others.chain(own.clone()).copied(), &plane) {
                        // There is one more only if this is the plane of the ring itself.
                        let is_last = own.copied().any(|p| plane.side(p) == side);
                        planes.push((plane, side));
                        if is_last {
                            break;
                        }
                    }
                }
            }
        }
        let low = all().fold(DVec3::INFINITY, DVec3::min);
        let high = all().fold(DVec3::NEG_INFINITY, DVec3::max);
        let bounds = planes.iter().map(|(plane, side)| Bound::of(plane, *side)).collect();
        Self { planes, bounds, low, high }
    }

    /// False if a box is certainly outside of the shaft's own box, or of one of its planes.
    pub(super) fn may_meet(&self, low: DVec3, high: DVec3) -> bool {
        let (centre, half) = (0.5 * (low + high), 0.5 * (high - low));
        let coordinate = low.abs().max(high.abs()).max_element();
        self.low.cmple(high).all()
            && self.high.cmpge(low).all()
            && !self.bounds.iter().any(|bound| bound.excludes(centre, half, coordinate))
    }

    /// True if a polygon is certainly outside, though it may touch.
    pub(super) fn excludes(&self, ring: &[DVec3]) -> bool {
        // Mostly some corner is surely inside, and one beside it on the plane.
        let is_outside = |(plane, side): &(Plane, Sign)| {
            !ring.iter().any(|&p| plane.sure_side(p) == Some(*side)) && ring.iter().all(|&p| plane.side(p) != *side)
        };
        let beyond = |axis: usize| {
            ring.iter().all(|p| p[axis] <= self.low[axis]) || ring.iter().all(|p| p[axis] >= self.high[axis])
        };
        // A polygon may lie in a face of a box that is no more than that face.
        let is_flat = |axis: usize| self.high[axis] <= self.low[axis];
        (0..3).any(|axis| !is_flat(axis) && beyond(axis)) || self.planes.iter().any(is_outside)
    }
}

/// The one side that all points are on that are not on the plane.
fn common_side(points: impl Iterator<Item = DVec3> + Clone, plane: &Plane) -> Option<Sign> {
    let mut common = Sign::Zero;
    // Mostly some are surely on both sides.
    for side in points.clone().filter_map(|p| plane.sure_side(p)) {
        if common.is_zero() {
            common = side;
        } else if side != common {
            return None;
        }
    }
    for p in points.filter(|&p| plane.sure_side(p).is_none()) {
        let side = plane.side(p);
        if common.is_zero() {
            common = side;
        } else if side == -common {
            return None;
        }
    }
    (!common.is_zero()).then_some(common)
}

#[cfg(test)]
mod tests {
    use super::super::shape::square;
    use super::*;

    #[test]
    fn a_shaft_excludes_what_touches_it_from_outside() {
        let shaft = Shaft::between(&square(1.0, 1.0, [0.0; 2]), &square(-1.0, 2.0, [0.0; 2]));
        assert!(shaft.excludes(&square(0.0, 0.5, [2.0, 0.0])));
        assert!(!shaft.excludes(&square(0.0, 0.5, [1.999, 0.0])));
        assert!(shaft.excludes(&square(1.0, 5.0, [0.0; 2])));
        assert!(!shaft.excludes(&square(0.999, 5.0, [0.0; 2])));
    }
}
