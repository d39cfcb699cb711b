//! Joining convex parts of one piece to larger convex parts.

use crate::contour::directions::CircleId;
use crate::contour::regions::circles::GreatCircles;
use crate::contour::regions::mosaic::Mosaic;
use crate::contour::regions::places::{FaceSide, Places};
use crate::exact::Sign;
use crate::scene::PieceId;
use rustc_hash::FxHashMap;

/// A part of a piece, with its sides as its boundary runs.
#[derive(Clone, Debug)]
pub(super) struct Merged {
    pub(super) piece: PieceId,
    pub(super) is_lit: bool,
    pub(super) sides: Vec<FaceSide>,
}

/// Joins parts that have a whole side in common, in the order of their numbers, as long as they are alike and convex together. What cut
/// them apart without need were splitters of the contour tree that only mattered elsewhere.
pub(super) fn merge(
    mosaic: &mut Mosaic<'_>,
    circles: &GreatCircles,
    places: &Places,
    parts: &[(PieceId, bool)],
) -> Vec<Merged> {
    let mut all: Vec<Merged> = Vec::with_capacity(parts.len());
    let mut start = 0;
    for of_piece in parts.chunk_by(|a, b| a.0 == b.0) {
        let faces = (start..).take(of_piece.len());
        start += of_piece.len() as u32;
        let with_sides = of_piece.iter().zip(faces);
        let own =
            with_sides.map(|(&(piece, is_lit), face)| Merged { piece, is_lit, sides: places.of_face(face).to_vec() });
        all.extend(Merger { mosaic, circles, places }.join(own.collect()));
    }
    all
}

struct Merger<'a, 'm> {
    mosaic: &'a mut Mosaic<'m>,
    circles: &'a GreatCircles,
    places: &'a Places,
}

impl Merger<'_, '_> {
    fn join(&mut self, parts: Vec<Merged>) -> Vec<Merged> {
        let mut parts: Vec<Option<Merged>> = parts.into_iter().map(Some).collect();
        if parts.len() == 1 {
            return parts.into_iter().flatten().collect();
        }
        // The part that has a side from one vertex to another.
        let mut along: FxHashMap<[u32; 2], usize> = FxHashMap::default();
        for k in 0..parts.len() {
            let mut side = 0;
            while let Some(part) = &parts[k]
                && let Some(&FaceSide { ends, .. }) = part.sides.get(side)
            {
                let ends = ends.map(|place| self.vertex(place));
                along.insert(ends, k);
                let other = along.get(&[ends[1], ends[0]]).copied().filter(|&other| other != k);
                let joined = other.and_then(|other| Some((other, self.joined(part, parts[other].as_ref()?, ends)?)));
                side += 1;
                if let Some((other, joined)) = joined {
                    (parts[k], parts[other]) = (Some(joined), None);
                    // Its sides may fit others now.
                    side = 0;
                }
            }
        }
        parts.into_iter().flatten().collect()
    }

    fn vertex(&self, place: u32) -> u32 {
        self.places.all[place as usize].vertex
    }

    /// Two parts without the side that they have in common, if they are alike and convex together.
    fn joined(&mut self, a: &Merged, b: &Merged, [from, to]: [u32; 2]) -> Option<Merged> {
        let starts = |part: &Merged, at: [u32; 2]| {
            part.sides.iter().position(|side| side.ends.map(|place| self.vertex(place)) == at)
        };
        let (i, j) = (starts(a, [from, to])?, starts(b, [to, from])?);
        if a.is_lit != b.is_lit {
            return None;
        }
        // From the side after the one between them, around to the one before it.
        let rest = |part: &Merged, from: usize| -> Vec<FaceSide> {
            (1..part.sides.len()).map(|k| part.sides[(from + k) % part.sides.len()]).collect()
        };
        let (mut sides, second) = (rest(a, i), rest(b, j));
        let seam = sides.len();
        sides.extend(second);
        // The later corner first, so that the other keeps its place.
        for corner in [seam, 0] {
            let last = if corner == 0 { sides.len() - 1 } else { corner - 1 };
            let (before, after) = (sides[last], sides[corner]);
            if self.track(before) == self.track(after) && before.forward == after.forward {
                sides[last].ends[1] = after.ends[1];
                sides.remove(corner);
            } else if !self.turns_left(before, after) {
                return None;
            }
        }
        Some(Merged { sides, ..*a })
    }

    fn track(&self, side: FaceSide) -> u32 {
        self.places.all[side.ends[0] as usize].track
    }

    /// True if the boundary turns to the left, exactly, from one side to the next.
    fn turns_left(&mut self, before: FaceSide, after: FaceSide) -> bool {
        let ahead = self.places.all[after.ends[1] as usize].direction;
        let circle: CircleId = self.circles.name(self.places.all[before.ends[0] as usize].circle);
        let Mosaic { skeleton, directions, knife, .. } = &mut *self.mosaic;
        let side = directions.side(skeleton, ahead, circle, &mut knife.cache);
        side == if before.forward { Sign::Positive } else { Sign::Negative }
    }
}
