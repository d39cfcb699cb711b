//! What one convex polygon does to light between an element and a facet: it hides nothing of it, or everything, or that cannot be told.
//!
//! All decisions are exact signs of determinants of corners.

use super::lies::{Lies, Plane, exact_side};
use super::shape::{Frame, sides};
use crate::exact::{Sign, U};
use glam::{DVec2, DVec3};

/// What a polygon does to light between two others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Blocks {
    Nothing,
    Everything,
    Unknown,
}

/// A point of a plane, and where it is in a frame of that plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) at: DVec3,
    pub(super) flat: DVec2,
}

/// The sides that a plane through three points has in another plane, in a frame of that.
struct Line {
    points: [DVec3; 3],
    along: DVec2,
    offset: f64,
    /// The filter's bound is this times the sum of the lengths.
    bound: f64,
    length: f64,
}

impl Line {
    /// Where the plane through three points meets that of the frame.
    ///
    /// The normal is off by at most 3 u times the sums of its products, its components along the frame by 4 u times those sums more, the
    /// coordinates of a corner by 6 u times its distance from the origin of the frame, which may itself be off by as much; so that the sign is sure from 32 u
    /// times all that on.
    fn through(points: [DVec3; 3], frame: &Frame) -> Self {
        let Plane { normal, permanent, .. } = Plane::through(points);
        let to = frame.origin - points[0];
        let (u, v) = frame.axes();
        let along = DVec2::new(normal.dot(u), normal.dot(v));
        let bound = 32.0 * U * permanent.element_sum();
        let length = to.abs().element_sum() + frame.origin.abs().max_element() + points[0].abs().max_element();
        Self { points, along, offset: normal.dot(to), bound, length }
    }

    /// The side of a corner if the filter is sure of it, or, if the corner is itself rounded, of all that is within rounding of it.
    #[inline]
    fn sure_side(&self, corner: &Corner, is_exact: bool) -> Option<Sign> {
        let value = self.along.dot(corner.flat) + self.offset;
        // A point is off by 10 u times the coordinates at most: a third of what the bound is for.
        let bound = if is_exact { self.bound } else { 8.0 * self.bound };
        let bound = bound * (self.length + corner.flat.abs().element_sum());
        // Not below what may have underflowed.
        let is_sure = value.abs() > bound && bound > 1e-180;
        is_sure.then_some(if value > 0.0 { Sign::Positive } else { Sign::Negative })
    }

    fn side(&self, corner: &Corner) -> Sign {
        self.sure_side(corner, true).unwrap_or_else(|| exact_side(self.points, corner.at))
    }
}

/// A convex polygon that may be between an element and a facet.
pub(super) struct Blocker<'a> {
    pub(super) facet: u32,
    ring: &'a [DVec3],
    from: &'a [DVec3],
    frame: &'a Frame,
    /// Of the element to its plane, and of the facet.
    lies: [Lies; 2],
    /// Its own plane.
    spanning: [DVec3; 3],
    plane: Option<Line>,
    /// Planes through its sides and the corners of the element, side by side, as far as they have been asked for.
    lines: Vec<Option<Line>>,
}

impl<'a> Blocker<'a> {
    /// Between an element, all of which lies so to the plane of the blocker, and the facet with that frame, which lies so.
    pub(super) fn between(
        from: &'a [DVec3],
        lies: [Lies; 2],
        frame: &'a Frame,
        (facet, ring, spanning): (u32, &'a [DVec3], [DVec3; 3]),
    ) -> Self {
        Self { facet, ring, from, frame, lies, spanning, plane: None, lines: Vec::new() }
    }

    /// What it does to light from the element to a convex part of the facet: lines between corners pass its sides all inside, or one all outside, or
    /// it cannot be told. If corners are not exact nothing is told that would not be of any part within them.
    pub(super) fn blocks(&mut self, part: &[Corner], is_exact: bool) -> Blocks {
        let Self { ring, from, frame, spanning, .. } = *self;
        let [own, whole] = self.lies;
        let other = match whole {
            Lies::Across => {
                let plane = self.plane.get_or_insert_with(|| Line::through(spanning, frame));
                if !is_exact && part.iter().any(|corner| plane.sure_side(corner, false).is_none()) {
                    return Blocks::Unknown;
                }
                Lies::of_signs(part.iter().map(|corner| plane.side(corner)))
            }
            whole => whole,
        };
        if own.is_beside(other) {
            return Blocks::Nothing;
        }
        // Lines of sight are told apart only if all of them pass its plane one way.
        // Seen from its front, with the lines of sight going in, a side that runs counter-clockwise has its inside to the left.
        let inside = match (own, other) {
            (Lies::Front, Lies::Behind) => Sign::Negative,
            (Lies::Behind, Lies::Front) => Sign::Positive,
            _ => return Blocks::Unknown,
        };
        if self.lines.is_empty() {
            self.lines.resize_with(ring.len() * from.len(), || None);
        }
        let mut hides = true;
        for ([a, b], lines) in sides(ring).zip(self.lines.chunks_exact_mut(from.len())) {
            let mut passes = Passes::default();
            let mut is_sure = true;
            'lines: for (line, &p) in lines.iter_mut().zip(from) {
                let line = line.get_or_insert_with(|| Line::through([a, b, p], frame));
                for corner in part {
                    match line.sure_side(corner, is_exact) {
                        Some(side) => passes.note(side == inside),
                        None => is_sure = false,
                    }
                    if passes.are_told(hides) {
                        break 'lines;
                    }
                }
            }
            if !is_sure && !passes.are_told(hides) {
                if !is_exact {
                    hides = false;
                    continue;
                }
                // Those on the plane pass either way.
                let unsure = lines.iter().flatten().flat_map(|line| part.iter().map(move |corner| (line, corner)));
                for (line, corner) in unsure.filter(|(line, corner)| line.sure_side(corner, true).is_none()) {
                    let side = exact_side(line.points, corner.at);
                    if !side.is_zero() {
                        passes.note(side == inside);
                    }
                    if passes.are_told(hides) {
                        break;
                    }
                }
            }
            if !passes.inside {
                return Blocks::Nothing;
            }
            hides &= !passes.outside;
        }
        if hides { Blocks::Everything } else { Blocks::Unknown }
    }
}

/// Where lines between corners pass a side of a blocker.
#[derive(Default)]
struct Passes {
    inside: bool,
    outside: bool,
}

impl Passes {
    #[inline]
    fn note(&mut self, is_inside: bool) {
        self.inside |= is_inside;
        self.outside |= !is_inside;
    }

    /// True if more of them change nothing: it hides nothing only if all pass outside, and everything only if all pass all sides inside.
    #[inline]
    fn are_told(&self, may_hide_everything: bool) -> bool {
        self.inside && (self.outside || !may_hide_everything)
    }
}

#[cfg(test)]
mod tests {
    use super::super::shape::square;
    use super::*;

    #[test]
    fn lines_pass_inside_outside_or_both() {
        let (front, behind) = (square(1.0, 1.0, [0.0; 2]), square(-1.0, 1.0, [0.0; 2]));
        let blocks = |front: &[DVec3], ring: &[DVec3], behind: &[DVec3]| {
            let frame = Frame::through([behind[0], behind[1], behind[2]]);
            let spanning = [ring[0], ring[1], ring[2]];
            let lies = [Lies::of(front, spanning), Lies::of(behind, spanning)];
            let mut blocker = Blocker::between(front, lies, &frame, (0, ring, spanning));
            let corners: Vec<Corner> = behind.iter().map(|&at| Corner { at, flat: frame.flat(at) }).collect();
            blocker.blocks(&corners, true)
        };
        // From either side.
        for turned in [false, true] {
            let blocks = |ring: &[DVec3]| {
                let ring: Vec<DVec3> = if turned { ring.iter().rev().copied().collect() } else { ring.to_vec() };
                blocks(&front, &ring, &behind)
            };
            assert_eq!(blocks(&square(0.0, 1.0, [0.0; 2])), Blocks::Everything);
            assert_eq!(blocks(&square(0.0, 1.0_f64.next_down(), [0.0; 2])), Blocks::Unknown);
            assert_eq!(blocks(&square(0.0, 0.5, [1.5, 0.0])), Blocks::Nothing);
            assert_eq!(blocks(&square(0.0, 0.5, [1.5_f64.next_down(), 0.0])), Blocks::Unknown);
        }
        // A small source seen past a large receiver: the shaft is narrower in the middle.
        let point = square(1.0, 0.0, [0.0; 2]);
        assert_eq!(blocks(&point, &square(0.0, 0.5, [0.0; 2]), &behind), Blocks::Everything);
        assert_eq!(blocks(&point, &square(0.0, 0.5, [1.0, 0.0]), &behind), Blocks::Nothing);
    }
}
