//! What is seen of one element from a point, with all that may be between it known: shadows are cut off in its plane.
//!
//! A blocker hides what is on the other side of its plane, within the planes through the point and its sides: a convex polygon in the plane of the
//! element. This is done in floating point, as clipping of a few polygons in the plane: views are exact and tell everything at once, but most
//! of a row's entries need few points, and a few need many. All is in coordinates of the element's frame, with the height over it as the third.

use super::bodies::FacetSide;
use super::element::{Element, Elements};
use super::facets::Facets;
use super::screens::{HalfPlane, Screens};
use super::shaft::Lies;
use super::shape::{Frame, clip};
use crate::integral::Receiver;
use glam::{DVec2, DVec3};

/// An element, seen from another one.
pub(super) struct Target<'a> {
    frame: &'a Frame,
    /// What it is seen from, in its frame.
    receiver: Receiver,
}

/// What is between, and memory that is used again.
#[derive(Default)]
pub(super) struct HiddenSpace {
    screens: Screens,
    /// What of the element is above the horizon.
    whole: Vec<DVec2>,
    parts: Vec<Vec<DVec2>>,
    next: Vec<Vec<DVec2>>,
    free: Vec<Vec<DVec2>>,
    lines: Vec<(HalfPlane, FacetSide)>,
    heights: Vec<f64>,
    ring: Vec<DVec3>,
    /// The blockers, those that have cut something off lately first.
    order: Vec<Tried>,
    /// The half planes that parts were cut along.
    cuts: Vec<(HalfPlane, FacetSide)>,
    /// The sides whose shadows bound what is seen from any of the points, ascending, while they are noted.
    pub(super) bounds: Option<Vec<FacetSide>>,
}

/// A blocker, and which of its lines has last had all of the element outside: that is tried first.
#[derive(Clone, Copy)]
struct Tried {
    screen: u32,
    line: u32,
}

impl<'a> Target<'a> {
    /// With the facets that may be between. Forgets what was seen of another element.
    pub(super) fn new(
        facets: &Facets,
        elements: &'a Elements,
        [from, to]: [&Element; 2],
        between: &[u32],
        space: &mut HiddenSpace,
    ) -> Self {
        space.screens.set(facets, elements, from, to, between);
        space.order.clear();
        space.order.extend((0..space.screens.all.len() as u32).map(|screen| Tried { screen, line: 0 }));
        let [own, frame] = [from, to].map(|element| &elements.frames[element.facet as usize]);
        let normal = frame.turned(own.normal);
        // What is behind the plane of what it is seen from is not seen.
        if facets.lies(to.facet, from.facet) == Lies::Across {
            let above = HalfPlane::above(normal, own.height(frame.origin));
            clip(&to.flat, |p| above.height(p), &mut space.whole);
        } else {
            space.whole.clone_from(&to.flat);
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
    let HiddenSpace { screens, whole, parts, next, free, lines, heights, order, cuts, bounds, .. } = space;
    let mut first = free.pop().unwrap_or_default();
    first.clone_from(whole);
    parts.push(first);
    cuts.clear();
    for k in 0..order.len() {
        let Tried { screen, line } = &mut order[k];
        if !screens.shadow(*screen, at, line, parts, lines) {
            continue;
        }
        // Of one part it is known already that no line has all of it outside.
        let is_one = parts.len() == 1;
        for part in parts.drain(..) {
            if !is_one && lines.iter().any(|(line, _)| part.iter().all(|&p| line.height(p) <= 0.0)) {
                next.push(part);
                continue;
            }
            cut_off(part, lines, next, free, heights, |cut| {
                if bounds.is_some() {
                    cuts.push(cut);
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
        for &(line, side) in &*cuts {
            if let Err(place) = bounds.binary_search(&side)
                && parts.iter().any(|part| line.bounds(part))
            {
                bounds.insert(place, side);
            }
        }
    }
    true
}

/// Puts what of a convex part is outside of some half plane into `next`, as convex parts; `cut` gets those along which something is cut off.
fn cut_off(
    mut part: Vec<DVec2>,
    lines: &[(HalfPlane, FacetSide)],
    next: &mut Vec<Vec<DVec2>>,
    free: &mut Vec<Vec<DVec2>>,
    heights: &mut Vec<f64>,
    mut cut: impl FnMut((HalfPlane, FacetSide)),
) {
    for (line, side) in lines {
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
            cut((*line, *side));
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
