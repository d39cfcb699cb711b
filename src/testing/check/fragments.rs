//! The fragments of a piece tile it: proved, whatever epsilon was.
//!
//! Each fragment is shown to be a convex polygon in the piece's plane, counter-clockwise like the piece. So the
//! sum of the fragments' winding numbers around a point is the number of fragments over that point; it is
//! the piece's, 1 inside and 0 outside, if the boundaries are the same as chains: if on every line the
//! fragments' boundaries less the piece's cover every stretch as often forward as backward. Along a line that
//! difference changes by 1 where a segment starts and by -1 where one ends, whichever way it runs; so it is
//! 0 everywhere if at every point of the line as many segments start as end.

use super::{Defect, FragmentFault};
use crate::bsp::{FragmentRef, SceneBsp};
use crate::exact::Point;
use crate::scene::{PieceRef, Side};
use crate::testing::integers::{Spot, Unit, Vector, cross, dot, resolved, sign};
use num_traits::Zero;
use std::collections::BTreeMap;

/// Checks exactly that the fragments of every piece tile it: no gap, no overlap. Cost: for each piece the square
/// of the number of its fragments' corners, in integers of any length.
///
/// # Errors
/// The first piece whose fragments do not.
pub fn check_fragments(bsp: &SceneBsp) -> Result<(), Defect> {
    let scene = bsp.scene();
    let unit = Unit::of(scene.vertices().iter().copied());
    let mut fragments: Vec<Vec<FragmentRef<'_>>> = vec![Vec::new(); scene.piece_count()];
    for fragment in bsp.fragments() {
        fragments[fragment.piece().index()].push(fragment);
    }
    for (piece, fragments) in scene.pieces().zip(fragments) {
        tiles(unit, piece, &fragments).map_err(|what| Defect::Fragments { piece: piece.id(), what })?;
    }
    Ok(())
}

fn tiles(unit: Unit, piece: PieceRef<'_>, fragments: &[FragmentRef<'_>]) -> Result<(), FragmentFault> {
    let plane = unit.plane(&resolved(piece.scene(), piece.plane()));
    let view = Along::new(&plane.0, piece.facing());
    let mut corners = Corners::default();
    let mut chain = Chain::default();
    for fragment in fragments {
        let mut around = Vec::new();
        for point in fragment.exact_corners() {
            let corner = corners.known(&point).or_else(|| {
                let spot = unit.spot(&point);
                let in_plane = !spot.w.is_zero() && spot.height(&plane).is_zero();
                in_plane.then(|| corners.add(point, view.flat(spot)))
            });
            around.push(corner.ok_or(FragmentFault::OffPlane(fragment.id()))?);
        }
        if !corners.are_convex(&around) {
            return Err(FragmentFault::NotConvex(fragment.id()));
        }
        chain.add(&around);
    }
    let mut whole: Vec<usize> = piece
        .points()
        .map(|p| {
            let point = Point::Given(p);
            corners.known(&point).unwrap_or_else(|| corners.add(point, view.flat(unit.spot(&point))))
        })
        .collect();
    whole.reverse();
    chain.add(&whole);
    if chain.cancels(&corners) { Ok(()) } else { Err(FragmentFault::Boundary) }
}

/// A view along an axis that is not in the plane, from the side from which the piece runs counter-clockwise.
struct Along {
    axes: [usize; 2],
}

impl Along {
    fn new(normal: &Vector, facing: Side) -> Self {
        let axis = (0..3).find(|&k| !normal[k].is_zero()).unwrap_or(2);
        let (x, y) = ((axis + 1) % 3, (axis + 2) % 3);
        let towards = (sign(&normal[axis]) > 0) == (facing == Side::Front);
        Self { axes: if towards { [x, y] } else { [y, x] } }
    }

    /// The two coordinates that are left and the denominator.
    fn flat(&self, Spot { x, w }: Spot) -> Vector {
        let [u, v] = self.axes.map(|k| x[k].clone());
        [u, v, w]
    }
}

/// The corners of one piece's fragments, each once, wherever its definitions come from.
#[derive(Default)]
struct Corners {
    definitions: Vec<(Point, usize)>,
    /// Two coordinates and their positive denominator.
    places: Vec<Vector>,
}

impl Corners {
    fn known(&self, point: &Point) -> Option<usize> {
        self.definitions.iter().find(|(known, _)| known == point).map(|&(_, place)| place)
    }

    /// Adds a definition, which may be of a place that is known.
    fn add(&mut self, point: Point, place: Vector) -> usize {
        let same = |other: &Vector| (0..2).all(|k| &place[k] * &other[2] == &other[k] * &place[2]);
        let found = self.places.iter().position(same).unwrap_or(self.places.len());
        if found == self.places.len() {
            self.places.push(place);
        }
        self.definitions.push((point, found));
        found
    }

    /// A multiple of the normal of the line from one to the other, and of its offset.
    fn line(&self, [from, to]: [usize; 2]) -> Vector {
        cross(&self.places[from], &self.places[to])
    }

    /// Every corner is on the left of every side or on it, some strictly so, and no two coincide: then
    /// the boundary is convex and runs around once.
    fn are_convex(&self, around: &[usize]) -> bool {
        let mut any_area = false;
        for (k, &from) in around.iter().enumerate() {
            let side = self.line([from, around[(k + 1) % around.len()]]);
            for &corner in around {
                match sign(&dot(&side, &self.places[corner])) {
                    -1 => return false,
                    1 => any_area = true,
                    _ => {}
                }
            }
        }
        let mut distinct = around.to_vec();
        distinct.sort_unstable();
        distinct.dedup();
        any_area && distinct.len() == around.len()
    }
}

/// A sum of directed segments.
#[derive(Default)]
struct Chain {
    /// How often each is run forward, less how often backward, by its ends in ascending order.
    segments: BTreeMap<[usize; 2], i32>,
}

impl Chain {
    fn add(&mut self, around: &[usize]) {
        for (k, &from) in around.iter().enumerate() {
            let to = around[(k + 1) % around.len()];
            *self.segments.entry([from.min(to), from.max(to)]).or_default() += if from < to { 1 } else { -1 };
        }
    }

    /// True if the sum is zero on every line: as many segments start as end, at each of its points.
    fn cancels(&self, corners: &Corners) -> bool {
        let mut lines: Vec<Vector> = Vec::new();
        let mut ends: BTreeMap<[usize; 2], i32> = BTreeMap::new();
        for (&segment, &count) in self.segments.iter().filter(|&(_, &count)| count != 0) {
            let on = |line: &Vector| segment.iter().all(|&corner| dot(line, &corners.places[corner]).is_zero());
            let line = lines.iter().position(on).unwrap_or(lines.len());
            if line == lines.len() {
                lines.push(corners.line(segment));
            }
            for (corner, change) in segment.into_iter().zip([count, -count]) {
                *ends.entry([line, corner]).or_default() += change;
            }
        }
        ends.values().all(|&count| count == 0)
    }
}
