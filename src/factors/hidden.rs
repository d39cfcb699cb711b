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
    /// The blockers, those that have cut something off lately first.
    order: Vec<Tried>,
}

/// A blocker, and which of its lines has last had all of the element outside: that is tried first.
#[derive(Clone, Copy)]
struct Tried {
    blocker: u32,
    line: u32,
}

impl HiddenSpace {
    /// Forgets what was seen of another element.
    pub(super) fn start(&mut self, target: &Target<'_>) {
        self.order.clear();
        self.order.extend((0..target.blockers.len() as u32).map(|blocker| Tried { blocker, line: 0 }));
    }
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
    /// The form factor of what is seen of the element's front from a point. `space` is started with this target.
    pub(super) fn factor(&self, point: DVec3, space: &mut HiddenSpace) -> f64 {
        if self.frame.height(point) <= 0.0 {
            return 0.0;
        }
        let HiddenSpace { parts, next, free, lines, corners, order } = space;
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
        for k in 0..order.len() {
            if !self.shadow(point, &mut order[k], parts, lines) {
                continue;
            }
            for part in parts.drain(..) {
                cut_off(part, lines, next, free);
            }
            std::mem::swap(parts, next);
            order[..=k].rotate_right(1);
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

impl Target<'_> {
    /// Finds the half planes that a blocker's shadow is in, seen from a point; false if one of them has all parts outside.
    fn shadow(&self, point: DVec3, tried: &mut Tried, parts: &[Vec<DVec2>], lines: &mut Vec<HalfPlane>) -> bool {
        let (ring, plane) = self.blockers[tried.blocker as usize];
        let height = plane.height(point);
        let line = |k: usize| {
            if k == 0 {
                let behind = HalfPlane::of(plane.normal, plane.origin, self.frame);
                return if height > 0.0 { behind.turned() } else { behind };
            }
            let (a, b) = (ring[k - 1], ring[if k == ring.len() { 0 } else { k }]);
            let inside = (a - point).cross(b - point);
            HalfPlane::of(if height > 0.0 { -inside } else { inside }, point, self.frame)
        };
        let is_outside = |line: &HalfPlane| parts.iter().flatten().all(|&p| line.height(p) <= 0.0);
        // From a point in its plane it hides nothing.
        if height.abs() <= 0.0 || is_outside(&line(tried.line as usize)) {
            return false;
        }
        lines.clear();
        for k in 0..=ring.len() {
            let line = line(k);
            if is_outside(&line) {
                tried.line = k as u32;
                return false;
            }
            lines.push(line);
        }
        true
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
