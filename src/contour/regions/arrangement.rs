//! The stretches of great circles between the corners of faces, with the faces on both sides of each.

use super::circles::GreatCircles;
use super::mosaic::{Face, Mosaic};
use super::sets::Sets;
use crate::contour::directions::{CircleId, DirectionId};
use crate::exact::Sign;
use std::cmp::Ordering;
use std::f64::consts::TAU;

/// Directions that are further apart than this, in radians, follow each other as their rounded angles do: both
/// directions and normals are known to 1e-13 in each component.
const TELLING: f64 = 1e-11;

const NONE: u32 = u32::MAX;

/// A side of a face on one great circle, from corner to corner.
#[derive(Clone, Copy, Debug)]
struct FaceSide {
    face: u32,
    /// The face lies on the positive side: the boundary runs counter-clockwise about the normal.
    forward: bool,
    /// The places where it starts and ends.
    ends: [u32; 2],
}

/// A point of a great circle at which faces have corners. Place `k` and the next one of its great circle bound
/// stretch `k`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) direction: DirectionId,
    pub(super) circle: u32,
    /// About where on the circle.
    angle: f64,
    /// The point of the sphere, which may be a place of other circles too.
    pub(super) vertex: u32,
}

/// An end of a side, as it is sorted. It is the direction `s (n x a)`, with the normals `n` of its great circle and `a` of
/// the one across.
#[derive(Clone, Copy)]
struct End {
    circle: u32,
    angle: f64,
    side: u32,
    which: bool,
    direction: DirectionId,
    across: CircleId,
    across_number: u32,
    s: Sign,
}

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

/// All stretches.
pub(crate) struct Arrangement {
    sides: Vec<FaceSide>,
    /// Where the sides of each face start.
    face_sides: Vec<u32>,
    pub(super) places: Vec<Place>,
    /// Where the places of each great circle start.
    circle_places: Vec<u32>,
    /// The sides that have a stretch to their left, being on the positive side, and to their right.
    left: Vec<u32>,
    right: Vec<u32>,
    /// One of the places of each vertex.
    vertices: Vec<u32>,
}

impl Arrangement {
    pub(super) fn new(mosaic: &mut Mosaic<'_>, circles: &GreatCircles) -> Self {
        let (mut sides, face_sides, mut ends) = sides_of(mosaic, circles);
        let (mut places, circle_places) = places_of(mosaic, circles, &mut sides, &mut ends);
        let mut same = Sets::new(places.len());
        for range in face_sides.windows(2) {
            let face = &sides[range[0] as usize..range[1] as usize];
            for (k, side) in face.iter().enumerate() {
                same.unite(side.ends[1], face[(k + 1) % face.len()].ends[0]);
            }
        }
        let mut vertices = Vec::new();
        for k in 0..places.len() as u32 {
            let first = same.find(k);
            places[k as usize].vertex = if first == k {
                vertices.push(k);
                vertices.len() as u32 - 1
            } else {
                places[first as usize].vertex
            };
        }
        let [left, right] = [(); 2].map(|()| vec![NONE; places.len()]);
        let mut arrangement = Self { sides, face_sides, places, circle_places, left, right, vertices };
        for side in 0..arrangement.sides.len() as u32 {
            let FaceSide { forward, ends: [from, to], .. } = arrangement.sides[side as usize];
            let [mut place, end] = if forward { [from, to] } else { [to, from] };
            while place != end {
                let cover = if forward { &mut arrangement.left } else { &mut arrangement.right };
                debug_assert_eq!(cover[place as usize], NONE, "faces do not overlap");
                cover[place as usize] = side;
                place = arrangement.next(place);
            }
        }
        arrangement
    }

    /// The next place on its great circle.
    pub(super) fn next(&self, place: u32) -> u32 {
        let circle = self.places[place as usize].circle as usize;
        if place + 1 == self.circle_places[circle + 1] { self.circle_places[circle] } else { place + 1 }
    }

    pub(super) fn previous(&self, place: u32) -> u32 {
        let circle = self.places[place as usize].circle as usize;
        if place == self.circle_places[circle] { self.circle_places[circle + 1] - 1 } else { place - 1 }
    }

    /// The places of a great circle.
    pub(super) fn places_on(&self, circle: u32) -> std::ops::Range<u32> {
        self.circle_places[circle as usize]..self.circle_places[circle as usize + 1]
    }

    pub(super) fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    /// The direction of a vertex.
    pub(super) fn vertex_direction(&self, vertex: u32) -> DirectionId {
        self.places[self.vertices[vertex as usize] as usize].direction
    }

    pub(super) fn vertex(&self, place: u32) -> u32 {
        self.places[place as usize].vertex
    }

    /// About how long a stretch is, in radians.
    pub(super) fn length(&self, stretch: u32) -> f64 {
        let [from, to] = [stretch, self.next(stretch)].map(|place| self.places[place as usize].angle);
        let length = to - from;
        // Rounding can turn a very short one around; no stretch is half a turn long.
        (if length < -1.0 { length + TAU } else { length }).max(0.0)
    }

    fn side_beside(&self, half: Half) -> u32 {
        (if half.forward { &self.left } else { &self.right })[half.stretch as usize]
    }

    /// The face to the left; `None` along a stretch on which there is no side.
    pub(super) fn face_beside(&self, half: Half) -> Option<u32> {
        self.sides.get(self.side_beside(half) as usize).map(|side| side.face)
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
        let FaceSide { face, forward, ends: [_, to] } = self.sides[side as usize];
        let end = if forward { self.next(half.stretch) } else { half.stretch };
        if end != to {
            return Half { stretch: if forward { end } else { self.previous(end) }, forward };
        }
        let [first, last] = [0, 1].map(|k| self.face_sides[face as usize + k]);
        let FaceSide { forward, ends: [from, _], .. } =
            self.sides[(if side + 1 == last { first } else { side + 1 }) as usize];
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

/// The sides of all faces, without places so far, where those of each face start, and their ends: two for each side.
fn sides_of(mosaic: &Mosaic<'_>, circles: &GreatCircles) -> (Vec<FaceSide>, Vec<u32>, Vec<End>) {
    let (mut sides, mut face_sides, mut ends) = (Vec::new(), vec![0], Vec::new());
    let mut kept = Vec::new();
    for (face, k) in mosaic.faces.iter().zip(0..) {
        let arcs = mosaic.boundary(face);
        let halves = arcs.iter().map(|arc| circles.of(arc.along));
        kept.clear();
        kept.extend(arcs.iter().zip(halves));
        // Sides that continue each other are one.
        let last = kept[kept.len() - 1].1;
        let mut before = last;
        kept.retain(|&(_, half)| std::mem::replace(&mut before, half) != half);
        for (i, &(arc, (circle, inside))) in kept.iter().enumerate() {
            let (previous, next) = (kept[(i + kept.len() - 1) % kept.len()], kept[(i + 1) % kept.len()]);
            // A face with the inward normals n_k has the corners n_(k-1) x n_k.
            for (which, direction, other, s) in
                [(false, arc.from, previous, -inside), (true, next.0.from, next, inside)]
            {
                let across = other.0.along;
                ends.push(End {
                    circle,
                    angle: 0.0,
                    side: sides.len() as u32,
                    which,
                    direction,
                    across: across.circle(),
                    across_number: other.1.0,
                    s: s * across.inside(),
                });
            }
            sides.push(FaceSide { face: k, forward: inside.is_positive(), ends: [NONE; 2] });
        }
        face_sides.push(sides.len() as u32);
    }
    (sides, face_sides, ends)
}

/// Sorts the ends around their great circles, exactly; gives the places and where those of each great circle start.
fn places_of(
    mosaic: &mut Mosaic<'_>,
    circles: &GreatCircles,
    sides: &mut [FaceSide],
    ends: &mut [End],
) -> (Vec<Place>, Vec<u32>) {
    let axes: Vec<_> = (0..circles.count() as u32)
        .map(|circle| {
            let normal = mosaic.directions.normal(circles.name(circle)).v.normalize_or_zero();
            let first = normal.any_orthonormal_vector();
            (first, normal.cross(first))
        })
        .collect();
    for end in &mut *ends {
        let direction = mosaic.directions.unit(end.direction);
        let (x, y) = axes[end.circle as usize];
        end.angle = direction.dot(y).atan2(direction.dot(x));
    }
    ends.sort_unstable_by(|a, b| {
        a.circle.cmp(&b.circle).then(a.angle.total_cmp(&b.angle)).then((a.side, a.which).cmp(&(b.side, b.which)))
    });
    let mut places: Vec<Place> = Vec::new();
    let mut circle_places = Vec::with_capacity(circles.count() + 1);
    for on_circle in ends.chunk_by_mut(|a, b| a.circle == b.circle) {
        // Great circles without sides have no places.
        circle_places.resize(on_circle[0].circle as usize + 1, places.len() as u32);
        start_after_gap(on_circle);
        for near in on_circle.chunk_by_mut(|a, b| b.angle - a.angle <= TELLING) {
            sort_near(mosaic, near);
            for k in 0..near.len() {
                let End { circle, angle, side, which, direction, .. } = near[k];
                if k == 0 || compare(mosaic, &near[k - 1], &near[k]).is_ne() {
                    places.push(Place { direction, circle, angle, vertex: NONE });
                }
                sides[side as usize].ends[usize::from(which)] = places.len() as u32 - 1;
            }
        }
    }
    circle_places.resize(circles.count() + 1, places.len() as u32);
    (places, circle_places)
}

/// Turns the sorted ends so that they start after the largest gap: what is near each other is then side by side.
fn start_after_gap(ends: &mut [End]) {
    let mut largest = (ends[0].angle + TAU - ends[ends.len() - 1].angle, 0);
    for k in 1..ends.len() {
        let gap = ends[k].angle - ends[k - 1].angle;
        if gap > largest.0 {
            largest = (gap, k);
        }
    }
    for end in &mut ends[..largest.1] {
        end.angle += TAU;
    }
    ends.rotate_left(largest.1);
}

/// Puts ends that are near each other in their exact order.
fn sort_near(mosaic: &mut Mosaic<'_>, near: &mut [End]) {
    if (1..near.len()).any(|k| compare(mosaic, &near[k - 1], &near[k]).is_gt()) {
        near.sort_by(|a, b| compare(mosaic, a, b));
    }
}

/// The order of two ends that are near each other on one great circle: `n . (p x q)` with `p = s (n x a)` has the sign of
/// `-s a . q`.
fn compare(mosaic: &mut Mosaic<'_>, p: &End, q: &End) -> Ordering {
    if p.direction == q.direction || p.across_number == q.across_number {
        return Ordering::Equal;
    }
    let Mosaic { skeleton, directions, knife, .. } = mosaic;
    match directions.side(skeleton, q.direction, p.across, &mut knife.cache) * p.s {
        Sign::Negative => Ordering::Less,
        Sign::Zero => Ordering::Equal,
        Sign::Positive => Ordering::Greater,
    }
}
