//! Definitions in floating point, with proven bounds: what the filters work on.

use super::approx::Approx3;
use super::arena::Arena;
use super::ball::Ball;
use super::construct::Constructor;
use super::definition::{Plane, Splitter};
use super::frame::{BitRange, Frame};
use glam::DVec3;

/// A position with a bound on the error of each coordinate; 0 where a coordinate is exact.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ApproxPoint {
    pub(crate) position: DVec3,
    pub(crate) err: DVec3,
}

impl ApproxPoint {
    pub(crate) fn exact(position: DVec3) -> Self {
        Self { position, err: DVec3::ZERO }
    }

    fn coordinate(&self, k: usize) -> Ball {
        Ball::new(self.position[k], self.err[k])
    }

    /// The point at height 0 on the way between two points whose heights have opposite signs.
    pub(crate) fn between(from: Self, to: Self, at_from: Ball, at_to: Ball) -> Self {
        let t = at_from.div(at_from - at_to);
        let mut result = from;
        for k in 0..3 {
            let (a, b) = (from.coordinate(k), to.coordinate(k));
            // Exact where both ends are, and the same.
            if a.rad == 0.0 && b.rad == 0.0 && a.mid.total_cmp(&b.mid).is_eq() {
                continue;
            }
            let x = a + t * (b - a);
            result.position[k] = x.mid;
            result.err[k] = if x.rad.is_nan() { f64::INFINITY } else { x.rad };
        }
        result
    }
}

/// A plane in floating point: `normal . (p - anchor)` is the height of `p` times a positive number that
/// is the same for all points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ApproxPlane {
    pub(crate) normal: Approx3,
    pub(crate) anchor: DVec3,
    /// The axis that an axis-aligned plane is perpendicular to.
    axis: Option<usize>,
}

impl ApproxPlane {
    pub(crate) fn new(plane: &Plane) -> Self {
        match *plane {
            Plane::Axis { axis, value } => {
                let mut anchor = DVec3::ZERO;
                anchor[axis] = value;
                Self { normal: Approx3::given(DVec3::AXES[axis]), anchor, axis: Some(axis) }
            }
            Plane::Points([a, b, c]) => Self { normal: Approx3::edge_normal(a, b, c), anchor: a, axis: None },
        }
    }

    /// The same at any scale, with a normal from integers where f64 alone would know it poorly.
    pub(crate) fn refined(plane: &Plane) -> Self {
        let mut approx = Self::new(plane);
        if approx.normal.is_poor()
            && let Plane::Points(points) = plane
            && let Some([a, b, c]) = near_one(points)
        {
            approx.normal = Approx3::edge_normal(a, b, c);
        }
        if approx.normal.is_poor() {
            let frame = Frame::new(BitRange::of(plane.coordinates()), approx.anchor);
            let mut arena = Arena::default();
            let (normal, _) = Constructor { frame: &frame, arena: &mut arena }.plane(plane);
            approx.normal = Approx3::rounded(&arena, normal);
        }
        approx
    }

    /// The height of a point, in units of the stored normal.
    pub(crate) fn height(&self, point: &ApproxPoint) -> Ball {
        let difference = |k: usize| point.coordinate(k) - Ball::exact(self.anchor[k]);
        if let Some(axis) = self.axis {
            return difference(axis);
        }
        let term = |k: usize| difference(k) * self.normal.component(k);
        term(0) + term(1) + term(2)
    }

    /// The height of a point in scene units, rounded; for choices that need not be exact.
    pub(crate) fn rounded_height(&self, p: DVec3) -> f64 {
        if let Some(axis) = self.axis {
            return p[axis] - self.anchor[axis];
        }
        let length = self.normal.v.length();
        if length > 0.0 { self.normal.v.dot(p - self.anchor) / length } else { 0.0 }
    }

    /// The crease `h_2 N_1 - h_1 N_2` of two planes seen from the eye.
    pub(crate) fn crease([p, q]: [&Self; 2], eye: DVec3) -> Approx3 {
        let at = ApproxPoint::exact(eye);
        let (h1, h2) = (p.height(&at), q.height(&at));
        let m = [0, 1, 2].map(|k| h2 * p.normal.component(k) - h1 * q.normal.component(k));
        let err = m.iter().fold(0.0f64, |err, b| if b.rad.is_nan() { f64::INFINITY } else { err.max(b.rad) });
        Approx3::known(DVec3::from(m.map(|b| b.mid)), err)
    }
}

/// Points scaled by a power of two so that the largest coordinate is near 1, if that loses nothing.
fn near_one(points: &[DVec3; 3]) -> Option<[DVec3; 3]> {
    let largest = points.iter().fold(0.0f64, |most, p| most.max(p.abs().max_element()));
    let exponent = (largest.to_bits() >> 52) as i32 - 1023;
    let scale = 2.0_f64.powi((-exponent).clamp(-1020, 1020));
    let scaled = points.map(|p| p * scale);
    (scaled.map(|p| p / scale) == *points).then_some(scaled)
}

impl Approx3 {
    fn component(&self, k: usize) -> Ball {
        Ball::new(self.v[k], self.error_bound())
    }

    /// The normal of a splitter.
    pub(crate) fn splitter(splitter: &Splitter, eye: DVec3) -> Self {
        match splitter {
            Splitter::Edge([a, b]) => Self::edge_normal(eye, *a, *b),
            Splitter::Crease(planes) => {
                let [p, q] = planes.map(|plane| ApproxPlane::new(&plane));
                ApproxPlane::crease([&p, &q], eye)
            }
            Splitter::Given(normal) => Self::given(*normal),
            Splitter::Parallel(plane) => ApproxPlane::new(plane).normal,
        }
    }
}
