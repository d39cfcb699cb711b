//! The stretches of great circles between the corners of faces, with the faces on both sides of each.

use super::circles::GreatCircles;
use super::mosaic::{Face, Mosaic};
use super::places::{FaceSide, NONE, Place, Places};
use crate::contour::directions::DirectionId;
use std::f64::consts::TAU;

/// A stretch between two neighbouring places, run through forward or backward (as to the normal).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Half {
    pub(super) stretch: u32,
    pub(super) forward: bool,
}

impl Half {
    fn twin(self) -> Self {
        Self { forward: !self.forward, ..self }
    }
}

/// All stretches; the tracks are the great circles.
pub(crate) struct Arrangement {
    places: Places,
    /// The sides that have a stretch to their left, being on the positive side, and to their right.
    left: Vec<u32>,
    right: Vec<u32>,
}

impl Arrangement {
    pub(super) fn new(mosaic: &mut Mosaic<'_>, circles: &GreatCircles) -> Self {
        let places = Places::new(mosaic, circles, circles.count() as u32, |_, _, _, circle| circle);
        let [mut left, mut right] = [(); 2].map(|()| vec![NONE; places.all.len()]);
        for (side, k) in places.sides.iter().zip(0..) {
            let FaceSide { forward, ends: [from, to], .. } = *side;
            let [mut place, end] = if forward { [from, to] } else { [to, from] };
            while place != end {
                let cover = if forward { &mut left } else { &mut right };
                debug_assert_eq!(cover[place as usize], NONE, "faces do not overlap");
                cover[place as usize] = k;
                place = places.next(place);
            }
        }
        Self { places, left, right }
    }

    pub(super) fn place(&self, place: u32) -> Place {
        self.places.all[place as usize]
    }

    pub(super) fn place_count(&self) -> usize {
        self.places.all.len()
    }

    /// The next place on its great circle.
    pub(super) fn next(&self, place: u32) -> u32 {
        self.places.next(place)
    }

    pub(super) fn previous(&self, place: u32) -> u32 {
        self.places.previous(place)
    }

    /// The places of a great circle.
    pub(super) fn places_on(&self, circle: u32) -> std::ops::Range<u32> {
        self.places.on(circle)
    }

    pub(super) fn vertex_count(&self) -> usize {
        self.places.vertices.len()
    }

    /// The direction of a vertex.
    pub(super) fn vertex_direction(&self, vertex: u32) -> DirectionId {
        self.place(self.places.vertices[vertex as usize]).direction
    }

    pub(super) fn vertex(&self, place: u32) -> u32 {
        self.place(place).vertex
    }

    /// About how long a stretch is, in radians.
    pub(super) fn length(&self, stretch: u32) -> f64 {
        let [from, to] = [stretch, self.next(stretch)].map(|place| self.place(place).angle);
        let length = to - from;
        // Rounding can turn a very short one around; no stretch is half a turn long.
        (if length < -1.0 { length + TAU } else { length }).max(0.0)
    }

    fn side_beside(&self, half: Half) -> u32 {
        (if half.forward { &self.left } else { &self.right })[half.stretch as usize]
    }

    /// The face to the left; `None` along a stretch on which there is no side.
    pub(super) fn face_beside(&self, half: Half) -> Option<u32> {
        self.places.sides.get(self.side_beside(half) as usize).map(|side| side.face)
    }

    /// The faces on both sides of a stretch: on the positive side first.
    pub(super) fn faces_beside(&self, stretch: u32) -> Option<[u32; 2]> {
        let [left, right] = [true, false].map(|forward| self.face_beside(Half { stretch, forward }));
        debug_assert_eq!(left.is_some(), right.is_some(), "faces tile");
        Some([left?, right?])
    }

    /// True if the faces on both sides belong to different regions.
    pub(super) fn is_border(&self, faces: &[Face], stretch: u32) -> bool {
        self.faces_beside(stretch).is_some_and(|[a, b]| !faces[a as usize].joins(&faces[b as usize]))
    }

    /// The next stretch on the boundary of the face to the left.
    fn next_around_face(&self, half: Half) -> Half {
        let side = self.side_beside(half);
        let FaceSide { face, forward, ends: [_, to] } = self.places.sides[side as usize];
        let end = if forward { self.next(half.stretch) } else { half.stretch };
        if end != to {
            return Half { stretch: if forward { end } else { self.previous(end) }, forward };
        }
        let [first, last] = [0, 1].map(|k| self.places.face_sides[face as usize + k]);
        let FaceSide { forward, ends: [from, _], .. } =
            self.places.sides[(if side + 1 == last { first } else { side + 1 }) as usize];
        Half { stretch: if forward { from } else { self.previous(from) }, forward }
    }

    /// The next stretch on the boundary of the region to the left: the other end of the sector, at the vertex ahead,
    /// that the boundary arrives along.
    pub(super) fn next_around_region(&self, faces: &[Face], half: Half) -> Half {
        let mut next = self.next_around_face(half);
        while !self.is_border(faces, next.stretch) {
            next = self.next_around_face(next.twin());
        }
        next
    }
}
