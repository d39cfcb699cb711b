//! What is seen of one element from a point, with all that may be between it known: shadows are cut off in its plane.
//!
//! A blocker hides what is on the other side of its plane, within the planes through the point and its sides: a convex polygon in the plane of the
//! element. This is done in floating point, as clipping of a few polygons in the plane: views are exact and tell everything at once, but most
//! of a row's entries need few points, and a few need many. All is in coordinates of the element's frame, with the height over it as the third.

use super::element::Element;
use super::shape::{Frame, clip, sides};
use crate::integral::Receiver;
use glam::{DVec2, DVec3};
use std::ops::Range;

/// An element, seen from another one.
pub(super) struct Target<'a> {
    frame: &'a Frame,
    /// What it is seen from, in its frame.
    receiver: Receiver,
}

/// A side of a blocker: the number of that, and of the side from 1 on; 0 is its plane.
pub(super) type ScreenSide = (u32, u32);

/// What is between, and memory that is used again.
#[derive(Default)]
pub(super) struct HiddenSpace {
    screens: Vec<Screen>,
    corners: Vec<DVec3>,
    /// What of the element is above the horizon.
    whole: Vec<DVec2>,
    parts: Vec<Vec<DVec2>>,
    next: Vec<Vec<DVec2>>,
    free: Vec<Vec<DVec2>>,
    lines: Vec<HalfPlane>,
    heights: Vec<f64>,
    ring: Vec<DVec3>,
    /// The blockers, those that have cut something off lately first.
    order: Vec<Tried>,
    /// The half planes that parts were cut along.
    cuts: Vec<(ScreenSide, HalfPlane)>,
    /// The sides whose shadows bound what is seen from any of the points, ascending, while they are noted.
    pub(super) bounds: Option<Vec<ScreenSide>>,
}

/// A blocker.
struct Screen {
    /// Its corners, counter-clockwise seen from its front.
    corners: Range<u32>,
    normal: DVec3,
    /// How high the origin is over its plane.
    offset: f64,
}

/// A blocker, and which of its lines has last had all of the element outside: that is tried first.
#[derive(Clone, Copy)]
struct Tried {
    screen: u32,
    line: u32,
}

/// Where `along . p + offset` is not negative.
#[derive(Clone, Copy, Debug)]
struct HalfPlane {
    along: DVec2,
    offset: f64,
}

impl HalfPlane {
    /// One of those that a blocker's shadow is in, from a point that high over its plane: that of its plane, or of a side.
    fn of(screen: &Screen, ring: &[DVec3], at: DVec3, height: f64, side: usize) -> Self {
        let sign = if height > 0.0 { -1.0 } else { 1.0 };
        if side == 0 {
            return Self { along: sign * screen.normal.truncate(), offset: sign * screen.offset };
        }
        let (a, b) = (ring[side - 1] - at, ring[if side == ring.len() { 0 } else { side }] - at);
        let inside = sign * a.cross(b);
        Self { along: inside.truncate(), offset: -inside.dot(at) }
    }

    fn height(&self, p: DVec2) -> f64 {
        self.along.dot(p) + self.offset
    }

    /// True if a side of a ring is on its boundary, up to rounding.
    fn bounds(&self, ring: &[DVec2]) -> bool {
        let length = self.along.length();
        let is_on = |p: DVec2| self.height(p).abs() <= 1e-9 * (length * p.abs().max_element()).max(self.offset.abs());
        sides(ring).any(|[a, b]| is_on(a) && is_on(b))
    }
}

impl<'a> Target<'a> {
    /// With what may be between: corners, counter-clockwise seen from the front, and the plane. What is behind the plane of what it is seen from is
    /// cut off if `has_horizon`. Forgets what was seen of another element.
    pub(super) fn new<'b>(
        element: &Element,
        frame: &'a Frame,
        from: &Frame,
        has_horizon: bool,
        blockers: impl Iterator<Item = (&'b [DVec3], &'b Frame)>,
        space: &mut HiddenSpace,
    ) -> Self {
        let normal = frame.turned(from.normal);
        space.screens.clear();
        space.corners.clear();
        for (ring, plane) in blockers {
            let first = space.corners.len() as u32;
            space.corners.extend(ring.iter().map(|&p| frame.local(p)));
            let corners = first..space.corners.len() as u32;
            space.screens.push(Screen {
                corners,
                normal: frame.turned(plane.normal),
                offset: plane.height(frame.origin),
            });
        }
        space.order.clear();
        space.order.extend((0..space.screens.len() as u32).map(|screen| Tried { screen, line: 0 }));
        if has_horizon {
            let above = HalfPlane { along: normal.truncate(), offset: from.height(frame.origin) };
            clip(&element.flat, |p| above.height(p), &mut space.whole);
        } else {
            space.whole.clone_from(&element.flat);
        }
        Self { frame, receiver: Receiver::new(normal) }
    }

    /// The form factor of what is seen of the element's front from a point.
    pub(super) fn factor(&self, point: DVec3, space: &mut HiddenSpace) -> f64 {
        let at = self.frame.local(point);
        if at.z <= 0.0 || !cut_off_shadows(at, space) {
            return 0.0;
        }
        let HiddenSpace { parts, free, ring, .. } = space;
        let mut sum = 0.0;
        for part in parts.drain(..) {
            sum += self.factor_of(&part, at, ring);
            free.push(part);
        }
        sum
    }

    /// The same if nothing were between.
    pub(super) fn whole_factor(&self, point: DVec3, space: &mut HiddenSpace) -> f64 {
        let at = self.frame.local(point);
        if at.z <= 0.0 { 0.0 } else { self.factor_of(&space.whole, at, &mut space.ring) }
    }

    fn factor_of(&self, part: &[DVec2], at: DVec3, ring: &mut Vec<DVec3>) -> f64 {
        if part.len() < 3 {
            return 0.0;
        }
        // Clockwise as seen from the point.
        let towards = |&p: &DVec2| DVec3::new(p.x - at.x, p.y - at.y, -at.z);
        self.receiver.factor_of(part.iter().rev().map(towards), ring)
    }

    /// Notes what bounds what is seen of the element from a point.
    pub(super) fn note_bounds(&self, point: DVec3, space: &mut HiddenSpace) {
        let at = self.frame.local(point);
        if at.z > 0.0 {
            cut_off_shadows(at, space);
            space.free.append(&mut space.parts);
        }
    }
}

/// Leaves what of the element is in no shadow from a point over it, as convex parts; false if that is nothing.
fn cut_off_shadows(at: DVec3, space: &mut HiddenSpace) -> bool {
    let HiddenSpace { screens, corners, whole, parts, next, free, lines, heights, order, cuts, bounds, .. } = space;
    let mut first = free.pop().unwrap_or_default();
    first.clone_from(whole);
    parts.push(first);
    cuts.clear();
    for k in 0..order.len() {
        let number = order[k].screen;
        let screen = &screens[number as usize];
        let ring = &corners[screen.corners.start as usize..screen.corners.end as usize];
        if !shadow(screen, ring, at, &mut order[k].line, parts, lines) {
            continue;
        }
        for part in parts.drain(..) {
            cut_off(part, lines, next, free, heights, |side| {
                if bounds.is_some() {
                    cuts.push(((number, side as u32), lines[side]));
                }
            });
        }
        std::mem::swap(parts, next);
        order[..=k].rotate_right(1);
        if parts.is_empty() {
            return false;
        }
    }
    if let Some(bounds) = bounds {
        for &(side, line) in &*cuts {
            if let Err(place) = bounds.binary_search(&side)
                && parts.iter().any(|part| line.bounds(part))
            {
                bounds.insert(place, side);
            }
        }
    }
    true
}

/// Finds the half planes that a blocker's shadow is in, seen from a point; false if one of them has all parts outside. That one is tried first the next time.
fn shadow(
    screen: &Screen,
    ring: &[DVec3],
    at: DVec3,
    tried: &mut u32,
    parts: &[Vec<DVec2>],
    lines: &mut Vec<HalfPlane>,
) -> bool {
    let height = screen.normal.dot(at) + screen.offset;
    let line = |side: usize| HalfPlane::of(screen, ring, at, height, side);
    let is_outside = |line: &HalfPlane| parts.iter().all(|part| part.iter().all(|&p| line.height(p) <= 0.0));
    // From a point in its plane it hides nothing.
    if height.abs() <= 0.0 || is_outside(&line(*tried as usize)) {
        return false;
    }
    lines.clear();
    for side in 0..=ring.len() {
        let line = line(side);
        if is_outside(&line) {
            *tried = side as u32;
            return false;
        }
        lines.push(line);
    }
    true
}

/// Puts what of a convex part is outside of some half plane into `next`, as convex parts; `cut` gets the places of those along which something is cut off.
fn cut_off(
    mut part: Vec<DVec2>,
    lines: &[HalfPlane],
    next: &mut Vec<Vec<DVec2>>,
    free: &mut Vec<Vec<DVec2>>,
    heights: &mut Vec<f64>,
    mut cut: impl FnMut(usize),
) {
    if lines.iter().any(|line| part.iter().all(|&p| line.height(p) <= 0.0)) {
        next.push(part);
        return;
    }
    for (place, line) in lines.iter().enumerate() {
        heights.clear();
        heights.extend(part.iter().map(|&p| line.height(p)));
        if heights.iter().all(|&height| height >= 0.0) {
            continue;
        }
        let mut outside = free.pop().unwrap_or_default();
        let mut inside = free.pop().unwrap_or_default();
        halve(&part, heights, &mut outside, &mut inside);
        if outside.len() >= 3 {
            next.push(outside);
            cut(place);
        } else {
            free.push(outside);
        }
        free.push(std::mem::replace(&mut part, inside));
        if part.len() < 3 {
            break;
        }
    }
    free.push(part);
}

/// The parts of a convex ring where the heights of its corners, which are linear, are not positive, and where they are not negative.
fn halve(ring: &[DVec2], heights: &[f64], below: &mut Vec<DVec2>, above: &mut Vec<DVec2>) {
    below.clear();
    above.clear();
    for (k, (&a, &from)) in ring.iter().zip(heights).enumerate() {
        let next = if k + 1 == ring.len() { 0 } else { k + 1 };
        let (b, to) = (ring[next], heights[next]);
        if from <= 0.0 {
            below.push(a);
        }
        if from >= 0.0 {
            above.push(a);
        }
        if from > 0.0 && to < 0.0 || from < 0.0 && to > 0.0 {
            let crossing = a + (b - a) * (from / (from - to));
            below.push(crossing);
            above.push(crossing);
        }
    }
}
