//! The corners of faces, sorted exactly along the tracks that the sides of faces lie on.
//!
//! A track is a great circle, or a straight line of the scene that is seen as a part of one: faces on surfaces that are not seen may lie
//! behind each other, and then sides on one great circle need not be on one line.

use super::circles::GreatCircles;
use super::mosaic::Mosaic;
use super::sets::Sets;
use crate::contour::directions::{CircleId, DirectionId};
use crate::contour::polygon::PolygonArc;
use crate::exact::Sign;
use std::cmp::Ordering;
use std::f64::consts::TAU;

/// Directions that are further apart than this, in radians, follow each other as their rounded angles do: both
/// directions and normals are known to 1e-13 in each component.
const TELLING: f64 = 1e-11;

pub(crate) const NONE: u32 = u32::MAX;

/// A side of a face on one track, from corner to corner.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FaceSide {
    pub(crate) face: u32,
    /// The face lies on the positive side: the boundary runs counter-clockwise about the normal.
    pub(crate) forward: bool,
    /// The places where it starts and ends.
    pub(crate) ends: [u32; 2],
}

/// A point of a track at which faces have corners. Place `k` and the next one of its track bound
/// stretch `k`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub(crate) direction: DirectionId,
    pub(crate) track: u32,
    /// The number of the great circle.
    pub(crate) circle: u32,
    /// About where on the great circle.
    pub(crate) angle: f64,
    /// The point of the sphere, or of the scene, which may be a place of other tracks too.
    pub(crate) vertex: u32,
}

/// An end of a side, as it is sorted. It is the direction `s (n x a)`, with the normals `n` of its great circle and `a` of
/// the one across.
#[derive(Clone, Copy)]
struct End {
    track: u32,
    circle: u32,
    angle: f64,
    side: u32,
    which: bool,
    direction: DirectionId,
    across: CircleId,
    across_number: u32,
    s: Sign,
}

/// All sides of faces, and the places of all tracks.
pub(crate) struct Places {
    pub(crate) sides: Vec<FaceSide>,
    /// Where the sides of each face start.
    pub(crate) face_sides: Vec<u32>,
    pub(crate) all: Vec<Place>,
    /// Where those of each track start.
    starts: Vec<u32>,
    /// One of the places of each vertex.
    pub(crate) vertices: Vec<u32>,
}

impl Places {
    /// Finds them. `track` tells which track a side of a face is on, by the face's number and that of its great circle; there
    /// are at least `tracks` of them. Sides of one track lie on one great circle.
    pub(crate) fn new(
        mosaic: &mut Mosaic<'_>,
        circles: &GreatCircles,
        tracks: u32,
        track: impl FnMut(&Mosaic<'_>, u32, PolygonArc, u32) -> u32,
    ) -> Self {
        let (mut sides, face_sides, mut ends) = sides_of(mosaic, circles, track);
        let (mut all, starts) = places_of(mosaic, circles, tracks, &mut sides, &mut ends);
        let mut same = Sets::new(all.len());
        for range in face_sides.windows(2) {
            let face = &sides[range[0] as usize..range[1] as usize];
            for (k, side) in face.iter().enumerate() {
                same.unite(side.ends[1], face[(k + 1) % face.len()].ends[0]);
            }
        }
        let mut vertices = Vec::new();
        for k in 0..all.len() as u32 {
            let first = same.find(k);
            all[k as usize].vertex = if first == k {
                vertices.push(k);
                vertices.len() as u32 - 1
            } else {
                all[first as usize].vertex
            };
        }
        Self { sides, face_sides, all, starts, vertices }
    }

    /// The sides of a face.
    pub(crate) fn of_face(&self, face: u32) -> &[FaceSide] {
        &self.sides[self.face_sides[face as usize] as usize..self.face_sides[face as usize + 1] as usize]
    }

    /// The next place on its track.
    pub(crate) fn next(&self, place: u32) -> u32 {
        let track = self.all[place as usize].track as usize;
        if place + 1 == self.starts[track + 1] { self.starts[track] } else { place + 1 }
    }

    pub(crate) fn previous(&self, place: u32) -> u32 {
        let track = self.all[place as usize].track as usize;
        if place == self.starts[track] { self.starts[track + 1] - 1 } else { place - 1 }
    }

    /// The places of a track.
    pub(crate) fn on(&self, track: u32) -> std::ops::Range<u32> {
        self.starts[track as usize]..self.starts[track as usize + 1]
    }
}

/// The sides of all faces, without places so far, where those of each face start, and their ends: two for each side.
fn sides_of(
    mosaic: &Mosaic<'_>,
    circles: &GreatCircles,
    mut track: impl FnMut(&Mosaic<'_>, u32, PolygonArc, u32) -> u32,
) -> (Vec<FaceSide>, Vec<u32>, Vec<End>) {
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
        for (i, &(&arc, (circle, inside))) in kept.iter().enumerate() {
            let track = track(mosaic, k, arc, circle);
            let (previous, next) = (kept[(i + kept.len() - 1) % kept.len()], kept[(i + 1) % kept.len()]);
            // A face with the inward normals n_k has the corners n_(k-1) x n_k.
            for (which, direction, other, s) in
                [(false, arc.from, previous, -inside), (true, next.0.from, next, inside)]
            {
                let across = other.0.along;
                ends.push(End {
                    track,
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

/// Sorts the ends along their tracks, exactly; gives the places and where those of each track start.
fn places_of(
    mosaic: &mut Mosaic<'_>,
    circles: &GreatCircles,
    tracks: u32,
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
        a.track.cmp(&b.track).then(a.angle.total_cmp(&b.angle)).then((a.side, a.which).cmp(&(b.side, b.which)))
    });
    let mut places: Vec<Place> = Vec::new();
    let mut track_places = Vec::with_capacity(tracks as usize + 1);
    for on_track in ends.chunk_by_mut(|a, b| a.track == b.track) {
        // Tracks without sides have no places.
        track_places.resize(on_track[0].track as usize + 1, places.len() as u32);
        start_after_gap(on_track);
        for near in on_track.chunk_by_mut(|a, b| b.angle - a.angle <= TELLING) {
            sort_near(mosaic, near);
            for k in 0..near.len() {
                let End { track, circle, angle, side, which, direction, .. } = near[k];
                if k == 0 || compare(mosaic, &near[k - 1], &near[k]).is_ne() {
                    places.push(Place { direction, track, circle, angle, vertex: NONE });
                }
                sides[side as usize].ends[usize::from(which)] = places.len() as u32 - 1;
            }
        }
    }
    track_places.resize(track_places.len().max(tracks as usize) + 1, places.len() as u32);
    (places, track_places)
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
