//! What casts shadows on an element: facets, and bodies of facets, as they are seen from another element.

use super::bodies::{Body, FacetSide, MOST_FACETS};
use super::contacts::TOUCHES;
use super::element::{Element, Elements};
use super::facets::Facets;
use super::lies::Lies;
use super::shape::{Frame, sides};
use glam::{DVec2, DVec3};
use std::ops::Range;

/// All that may be between two elements, in the frame of one of them, and memory that is used again.
#[derive(Default)]
pub(super) struct Screens {
    pub(super) all: Vec<Screen>,
    faces: Vec<Face>,
    edges: Vec<Edge>,
    corners: Vec<DVec3>,
}

/// Something convex that hides what is behind it.
pub(super) struct Screen {
    faces: Range<u32>,
    edges: Range<u32>,
    /// True if it has one face, which is seen from both sides; otherwise all faces are seen from outside.
    is_flat: bool,
}

/// A face that may be seen.
struct Face {
    normal: DVec3,
    /// How high the origin is over its plane.
    offset: f64,
    /// True if some of what it hides may be on the near side of its plane.
    cuts: bool,
    facet: u32,
    /// Where the element that is looked from is, if all of it is on one side: rounding is not asked, then.
    own: Lies,
}

impl Face {
    /// How high a point is over its plane.
    #[inline]
    fn height(&self, at: DVec3) -> f64 {
        self.normal.dot(at) + self.offset
    }

    /// True if a point of the element is in front of it.
    #[inline]
    fn is_before(&self, at: DVec3) -> bool {
        match self.own {
            Lies::Front => true,
            Lies::Behind => false,
            Lies::On | Lies::Across => self.height(at) > 0.0,
        }
    }
}

/// What is no face that may be seen: a number that no face of a body has.
const NEVER: u32 = 63;
const _: () = assert!(MOST_FACETS <= NEVER as usize);

struct Edge {
    /// Places of corners, as they follow each other around the face to the left of it.
    ends: [u32; 2],
    /// Faces beside it, by their numbers in the screen.
    left: u32,
    right: u32,
    side: FacetSide,
}

/// What places and heights may be off by, relative to their terms.
const ROUNDING: f64 = 1e-9;

/// Where `along . p + offset` is not negative.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfPlane {
    along: DVec2,
    offset: f64,
}

impl HalfPlane {
    /// What is above a plane, in another one.
    #[inline]
    pub(super) fn above(normal: DVec3, offset: f64) -> Self {
        Self { along: normal.truncate(), offset }
    }

    #[inline]
    pub(super) fn height(&self, p: DVec2) -> f64 {
        self.along.dot(p) + self.offset
    }

    /// True if none of some points is inside.
    #[inline]
    pub(super) fn has_outside(&self, points: &[DVec2]) -> bool {
        points.iter().all(|&p| self.height(p) <= 0.0)
    }

    /// The side of a ring that is on its boundary, up to rounding: none of what is no more than rounding has left.
    pub(super) fn bounds(&self, ring: &[DVec2]) -> Option<[DVec2; 2]> {
        let is_on = |p: DVec2| self.height(p).abs() <= self.rounding(p);
        let is_long = |a: DVec2, b: DVec2| (b - a).abs().max_element() > ROUNDING * a.abs().max(b.abs()).max_element();
        sides(ring).find(|&[a, b]| is_on(a) && is_on(b) && is_long(a, b)).filter(|_| self.reaches_beyond(ring))
    }

    /// True if a corner of a ring is outside by more than rounding.
    pub(super) fn reaches_beyond(&self, ring: &[DVec2]) -> bool {
        ring.iter().any(|&p| self.height(p) < -self.rounding(p))
    }

    /// What a height may be off by. It decides nothing of what is seen, only where one looks for more.
    fn rounding(&self, p: DVec2) -> f64 {
        ROUNDING * (self.along.length() * p.abs().max_element()).max(self.offset.abs())
    }
}

impl Screens {
    /// Those of facets between one element and another one, in whose frame they are.
    pub(super) fn set(&mut self, facets: &Facets, elements: &Elements, from: &Element, to: &Element, between: &[u32]) {
        self.all.clear();
        self.faces.clear();
        self.edges.clear();
        self.corners.clear();
        let body_of = |facet: u32| facets.bodies.of_facet[facet as usize];
        for (place, &facet) in between.iter().enumerate() {
            let is_of = |body: u32| move |&other: &u32| body_of(other) == Some(body);
            // One facet alone casts the same shadow as its body does in the shaft.
            let whole = body_of(facet).filter(|&body| {
                between.iter().filter(|other| is_of(body)(other)).count() > 1
                    && is_seen_from_outside(&facets.bodies.all[body as usize], facets, elements, from)
            });
            match whole {
                None => self.add_facet(facets, elements, [from, to], facet),
                Some(body) if between[..place].iter().any(is_of(body)) => {}
                Some(body) => self.add_body(&facets.bodies.all[body as usize], facets, elements, [from, to]),
            }
        }
    }

    fn add_facet(&mut self, facets: &Facets, elements: &Elements, [from, to]: [&Element; 2], facet: u32) {
        let frame = &elements.frames[to.facet as usize];
        let [faces, edges] = [self.faces.len() as u32, self.edges.len() as u32];
        let corners = self.corners.len() as u32;
        let ring = &facets.all[facet as usize].ring;
        self.corners.extend(ring.iter().map(|&p| frame.local(p)));
        let lies = (facets.lies_of(from, facet), facets.lies(to.facet, facet));
        let cuts = !matches!(lies, (Lies::Front, Lies::Behind) | (Lies::Behind, Lies::Front));
        self.add_face(frame, &elements.frames[facet as usize], facet, cuts, lies.0);
        let count = ring.len() as u32;
        let edge = |k: u32| Edge {
            ends: [corners + k, corners + if k + 1 == count { 0 } else { k + 1 }],
            left: 0,
            right: NEVER,
            side: facets.side(facet, k),
        };
        self.edges.extend((0..count).map(edge));
        let (faces, edges) = (faces..self.faces.len() as u32, edges..self.edges.len() as u32);
        self.all.push(Screen { faces, edges, is_flat: true });
    }

    fn add_body(&mut self, body: &Body, facets: &Facets, elements: &Elements, [from, to]: [&Element; 2]) {
        let frame = &elements.frames[to.facet as usize];
        let [faces, edges] = [self.faces.len() as u32, self.edges.len() as u32];
        let first = self.corners.len() as u32;
        let mut numbers = [(NEVER, Lies::Behind); MOST_FACETS];
        for (number, &facet) in numbers.iter_mut().zip(&body.facets) {
            let own = facets.lies_of(from, facet);
            if matches!(own, Lies::Behind | Lies::On) {
                continue;
            }
            let its = facets.lies(to.facet, facet);
            // All of the body is on the other side.
            if own == Lies::Front && matches!(its, Lies::Front | Lies::On) {
                self.faces.truncate(faces as usize);
                return;
            }
            *number = (self.faces.len() as u32 - faces, own);
            self.add_face(frame, &elements.frames[facet as usize], facet, its != Lies::Behind, own);
        }
        self.corners.extend(body.corners.iter().map(|&p| frame.local(p)));
        for edge in &body.edges {
            let (left, left_lies) = numbers[edge.left as usize];
            let (right, right_lies) = edge.right.map_or((NEVER, Lies::Behind), |right| numbers[right as usize]);
            let is_within = left_lies == Lies::Front && right_lies == Lies::Front;
            if (left, right) != (NEVER, NEVER) && !is_within {
                self.edges.push(Edge { ends: edge.ends.map(|end| first + end), left, right, side: edge.side });
            }
        }
        let (faces, edges) = (faces..self.faces.len() as u32, edges..self.edges.len() as u32);
        self.all.push(Screen { faces, edges, is_flat: false });
    }

    fn add_face(&mut self, frame: &Frame, plane: &Frame, facet: u32, cuts: bool, own: Lies) {
        let (normal, offset) = (frame.turned(plane.normal), plane.height(frame.origin));
        self.faces.push(Face { normal, offset, cuts, facet, own });
    }

    /// Finds the half planes that a screen's shadow is in, seen from a point, relative to whose foot they are; false if one of them has all these corners of what
    /// is left outside. That one is tried first the next time.
    pub(super) fn shadow(
        &self,
        number: u32,
        at: DVec3,
        tried: &mut u32,
        left: &[DVec2],
        lines: &mut Vec<(HalfPlane, FacetSide)>,
    ) -> bool {
        let Screen { faces, edges, is_flat } = &self.all[number as usize];
        let faces = &self.faces[faces.start as usize..faces.end as usize];
        let edges = &self.edges[edges.start as usize..edges.end as usize];
        let view = View { is_flat: *is_flat, faces, corners: &self.corners, at };
        let last = *tried as usize;
        let last = if let Some(face) = faces.get(last) {
            view.plane(face)
        } else {
            let edge = &edges[last - faces.len()];
            view.outline(edge, [edge.left, edge.right].map(|face| view.is_in_front(face)))
        };
        if last.is_some_and(|line| line.has_outside(left)) {
            return false;
        }
        // A bit for each face.
        let in_front =
            (0..faces.len() as u32).fold(0_u64, |bits, face| bits | u64::from(view.is_in_front(face)) << face);
        // From a point in its plane something flat hides nothing, nor does a body from inside.
        let hides_nothing = if *is_flat { faces[0].height(at).abs() <= 0.0 } else { in_front == 0 };
        if hides_nothing {
            return false;
        }
        lines.clear();
        let planes = faces.iter().map(|face| (view.plane(face), (face.facet, 0)));
        let sides = edges.iter().map(|edge| {
            let beside = [edge.left, edge.right].map(|face| in_front >> face & 1 == 1);
            (view.outline(edge, beside), edge.side)
        });
        for (place, (line, side)) in planes.chain(sides).enumerate() {
            let Some(line) = line else { continue };
            if line.has_outside(left) {
                *tried = place as u32;
                return false;
            }
            lines.push((line, side));
        }
        true
    }
}

/// A screen, seen from a point.
struct View<'a> {
    is_flat: bool,
    faces: &'a [Face],
    /// Of all screens.
    corners: &'a [DVec3],
    at: DVec3,
}

impl View<'_> {
    #[inline]
    fn is_in_front(&self, face: u32) -> bool {
        self.faces.get(face as usize).is_some_and(|face| face.is_before(self.at))
    }

    /// What is behind the plane of a face, if that is seen and it matters.
    #[inline]
    fn plane(&self, face: &Face) -> Option<HalfPlane> {
        if !face.cuts {
            return None;
        }
        let height = face.height(self.at);
        let is_before = face.is_before(self.at);
        let sign = if is_before { -1.0 } else { 1.0 };
        let offset = height - face.normal.z * self.at.z;
        (self.is_flat || is_before).then(|| HalfPlane { along: sign * face.normal.truncate(), offset: sign * offset })
    }

    /// What is inside of an edge, if it is part of the outline: the point is in front of one of the faces beside it.
    #[inline]
    fn outline(&self, edge: &Edge, [left, right]: [bool; 2]) -> Option<HalfPlane> {
        if !self.is_flat && left == right {
            return None;
        }
        let [a, b] = edge.ends.map(|end| self.corners[end as usize] - self.at);
        let inside = if left { b.cross(a) } else { a.cross(b) };
        Some(HalfPlane { along: inside.truncate(), offset: -inside.z * self.at.z })
    }
}

/// True if no line of sight from an element meets the inside of a body before its outside: it is outside of the body, and not in front of what that lacks. Where
/// it is outside by rounding only, points on it are not known to be.
fn is_seen_from_outside(body: &Body, facets: &Facets, elements: &Elements, from: &Element) -> bool {
    let is_clear = |facet: u32| from.ring.iter().any(|&p| elements.frames[facet as usize].height(p) > TOUCHES);
    body.lacks.is_none_or(|face| matches!(Lies::of(&from.ring, face), Lies::Behind | Lies::On))
        && body.facets.iter().any(|&facet| facets.lies_of(from, facet) == Lies::Front && is_clear(facet))
}
