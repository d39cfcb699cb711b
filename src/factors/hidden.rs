//! What is seen of one element from a point, with all that may be between it known: shadows are cut off in its plane.
//!
//! A blocker hides what is on the other side of its plane, within the planes through the point and its sides: a convex polygon in the plane of the
//! element. This is done in floating point, as clipping of a few polygons in the plane: views are exact and tell everything at once, but most
//! of a row's entries need few points, and a few need many.

use super::element::Element;
use super::shape::{Frame, clip};
use crate::integral::Receiver;
use glam::{DVec2, DVec3};

/// An element, seen from another one.
pub(super) struct Target<'a> {
    pub(super) element: &'a Element,
    /// Its plane.
    pub(super) frame: &'a Frame,
    /// The plane of what it is seen from, if part of it is behind that.
    pub(super) horizon: Option<&'a Frame>,
    /// What it is seen from.
    pub(super) receiver: Receiver,
    /// What may be between: corners, counter-clockwise seen from the front, and the plane.
    pub(super) blockers: Vec<(&'a [DVec3], &'a Frame)>,
}

/// Memory that is used again.
#[derive(Default)]
pub(super) struct HiddenSpace {
    parts: Vec<Vec<DVec2>>,
    next: Vec<Vec<DVec2>>,
    free: Vec<Vec<DVec2>>,
    lines: Vec<HalfPlane>,
    corners: Vec<DVec3>,
}

/// Where `along . p + offset` is not negative.
#[derive(Clone, Copy, Debug)]
struct HalfPlane {
    along: DVec2,
    offset: f64,
}

impl HalfPlane {
    /// Where a plane with that normal that meets `point` has the points of a frame in front of it.
    fn of(normal: DVec3, point: DVec3, frame: &Frame) -> Self {
        let (u, v) = frame.axes();
        Self { along: DVec2::new(normal.dot(u), normal.dot(v)), offset: normal.dot(frame.origin - point) }
    }

    fn height(&self, p: DVec2) -> f64 {
        self.along.dot(p) + self.offset
    }

    fn turned(&self) -> Self {
        Self { along: -self.along, offset: -self.offset }
    }
}

impl Target<'_> {
    /// The form factor of what is seen of the element's front from a point.
    pub(super) fn factor(&self, point: DVec3, space: &mut HiddenSpace) -> f64 {
        if self.frame.height(point) <= 0.0 {
            return 0.0;
        }
        let HiddenSpace { parts, next, free, lines, corners } = space;
        let mut whole = free.pop().unwrap_or_default();
        whole.clear();
        match self.horizon {
            None => whole.extend_from_slice(&self.element.flat),
            Some(horizon) => {
                let above = HalfPlane::of(horizon.normal, horizon.origin, self.frame);
                clip(&self.element.flat, |p| above.height(p), &mut whole);
            }
        }
        parts.push(whole);
        for &(ring, plane) in &self.blockers {
            let height = plane.height(point);
            if height == 0.0 {
                continue;
            }
            lines.clear();
            let behind = HalfPlane::of(plane.normal, plane.origin, self.frame);
            lines.push(if height > 0.0 { behind.turned() } else { behind });
            for [a, b] in super::shape::sides(ring) {
                let inside = (a - point).cross(b - point);
                lines.push(HalfPlane::of(if height > 0.0 { -inside } else { inside }, point, self.frame));
            }
            for part in parts.drain(..) {
                cut_off(part, lines, next, free);
            }
            std::mem::swap(parts, next);
            if parts.is_empty() {
                return 0.0;
            }
        }
        let mut sum = 0.0;
        for part in parts.drain(..) {
            if part.len() >= 3 {
                // Clockwise as seen from the point.
                let towards = |&p: &DVec2| self.frame.lift(p) - point;
                sum += self.receiver.factor_of(part.iter().rev().map(towards), corners);
            }
            free.push(part);
        }
        sum
    }
}

/// Puts what of a convex part is outside of some half plane into `next`, as convex parts.
fn cut_off(mut part: Vec<DVec2>, lines: &[HalfPlane], next: &mut Vec<Vec<DVec2>>, free: &mut Vec<Vec<DVec2>>) {
    if lines.iter().any(|line| part.iter().all(|&p| line.height(p) <= 0.0)) {
        next.push(part);
        return;
    }
    for line in lines {
        if part.iter().all(|&p| line.height(p) >= 0.0) {
            continue;
        }
        let mut outside = free.pop().unwrap_or_default();
        clip(&part, |p| -line.height(p), &mut outside);
        if outside.len() >= 3 {
            next.push(outside);
        } else {
            free.push(outside);
        }
        let mut inside = free.pop().unwrap_or_default();
        clip(&part, |p| line.height(p), &mut inside);
        free.push(std::mem::replace(&mut part, inside));
        if part.len() < 3 {
            break;
        }
    }
    free.push(part);
}
