//! Halving pieces in one plane by lines, so that only neighbours stay together.
//!
//! A piece goes to each side of a line where it has a corner; one that is all on the line goes to both. Two convex pieces that
//! share area share some of it beside the line, and so are together on that side: whatever the lines are, no such pair is lost.
//! The lines are chosen by counting: across boxes first (a floor of tiles), then along sides of pieces (a fan around
//! a hub, whose boxes all meet). Nothing is cut.

use super::super::flat::{orient2d, project};
use super::super::{Axis, PieceId, PieceRef, Scene, VertexId};
use super::tree::Aabb;
use crate::exact::Sign;
use glam::DVec2;

/// Lines are judged by so many pieces, evenly spaced, and so many are tried along sides.
const SAMPLES: usize = 256;
const TRIED: usize = 8;

/// A line in the plane, as seen along an axis that is not in it.
#[derive(Clone, Copy, Debug)]
enum Line {
    /// Where a coordinate has a value.
    Across(usize, f64),
    /// Through two vertices.
    Through([VertexId; 2]),
}

/// What to halve pieces by.
pub(super) struct Halving<'a> {
    pub(super) scene: &'a Scene,
    /// The boxes of all pieces of the scene.
    pub(super) boxes: &'a [Aabb],
    /// An axis that is not in the plane.
    pub(super) axis: Axis,
}

impl Halving<'_> {
    /// The pieces on either side of a line, in their order, if that leaves four fifths of the pairs or less; adds what it took,
    /// in corners and boxes, to `work`.
    pub(super) fn halves(&self, pieces: &[PieceId], work: &mut usize) -> Option<[Vec<PieceId>; 2]> {
        let line = self.choose(pieces, work)?;
        let mut halves = [Vec::new(), Vec::new()];
        for &piece in pieces {
            for (half, is_in) in halves.iter_mut().zip(self.sides(line, piece, work)) {
                if is_in {
                    half.push(piece);
                }
            }
        }
        (pairs_left(halves.each_ref().map(Vec::len), pieces.len()) <= 0.8).then_some(halves)
    }

    /// The line that leaves the fewest pairs, by a sample; not along sides if one across boxes does well.
    fn choose(&self, pieces: &[PieceId], work: &mut usize) -> Option<Line> {
        let few: Vec<PieceId> = spaced(pieces, SAMPLES).collect();
        let across = [0, 1].map(|coordinate| {
            let mut lows: Vec<f64> = few.iter().map(|&piece| self.extent(piece, coordinate)[0]).collect();
            lows.sort_by(f64::total_cmp);
            Line::Across(coordinate, lows[lows.len() / 2])
        });
        let along = spaced(pieces, TRIED).map(|piece| self.longest_side(self.scene.piece(piece)));
        let mut best = None;
        for line in across.into_iter().chain(along) {
            if let (Line::Through(_), Some((..=0.6, _))) = (line, best) {
                break;
            }
            let mut counts = [0; 2];
            for &piece in &few {
                let sides = self.sides(line, piece, work);
                counts = [0, 1].map(|side| counts[side] + usize::from(sides[side]));
            }
            let left = pairs_left(counts, few.len());
            if best.is_none_or(|(least, _)| left < least) {
                best = Some((left, line));
            }
        }
        best.map(|(_, line)| line)
    }

    /// The least and the greatest of a piece's coordinates, seen flat.
    fn extent(&self, piece: PieceId, coordinate: usize) -> [f64; 2] {
        let (low, high) = self.boxes[piece.index()];
        [low, high].map(|p| project(p, self.axis)[coordinate])
    }

    /// Whether a piece has a corner on the one and on the other side of a line; both, if it has none.
    fn sides(&self, line: Line, piece: PieceId, work: &mut usize) -> [bool; 2] {
        let sides = match line {
            Line::Across(coordinate, value) => {
                *work += 1;
                let [low, high] = self.extent(piece, coordinate);
                [low < value, high > value]
            }
            Line::Through(ends) => {
                let [from, to] = ends.map(|v| self.flat(v));
                let mut sides = [false; 2];
                for &vertex in self.scene.piece(piece).vertices().iter().filter(|v| !ends.contains(v)) {
                    *work += 1;
                    let sign = orient2d(from, to, self.flat(vertex));
                    sides[0] |= sign == Sign::Positive;
                    sides[1] |= sign == Sign::Negative;
                    if sides == [true; 2] {
                        break;
                    }
                }
                sides
            }
        };
        if sides == [false; 2] { [true; 2] } else { sides }
    }

    fn flat(&self, vertex: VertexId) -> DVec2 {
        project(self.scene.vertex(vertex), self.axis)
    }

    /// The side of a piece that is longest as it is seen, by rounding.
    fn longest_side(&self, piece: PieceRef<'_>) -> Line {
        let ring = piece.vertices();
        let side = |k: usize| [ring[k], ring[(k + 1) % ring.len()]];
        // Halves, so that differences are finite.
        let length = |k: usize| {
            let [a, b] = side(k).map(|v| self.flat(v) * 0.5);
            (a - b).abs().max_element()
        };
        let longest = (0..ring.len()).max_by(|&j, &k| length(j).total_cmp(&length(k)));
        Line::Through(side(longest.unwrap_or(0)))
    }
}

/// At most so many of the pieces, evenly spaced.
fn spaced(pieces: &[PieceId], most: usize) -> impl Iterator<Item = PieceId> {
    let count = pieces.len().min(most);
    (0..count).map(move |k| pieces[k * pieces.len() / count])
}

/// The share of pairs that are left to compare, with so many of so many pieces on each side.
fn pairs_left(counts: [usize; 2], pieces: usize) -> f64 {
    counts.map(|count| (count as f64 / pieces as f64).powi(2)).iter().sum()
}
