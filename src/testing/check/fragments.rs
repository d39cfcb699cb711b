//! The fragments of a piece tile it: proved, whatever epsilon was.
//!
//! Each fragment is shown to be a convex polygon in the piece's plane, counter-clockwise like the piece. So the sum
//! of the fragments' winding numbers around a point is the number of fragments over that point; it is
//! the piece's, 1 inside and 0 outside, if the boundaries are the same as chains: if on every line the fragments'
//! boundaries less the piece's cover every stretch as often forward as backward. Along a line that difference changes by 1 where a
//! segment starts and by -1 where one ends, whichever way it runs; so it is 0 everywhere if at every
//! point of the line as many segments start as end.

use super::{Defect, FragmentFault};
use crate::bsp::{FragmentRef, SceneBsp};
use crate::exact::Point;
use crate::scene::{PieceRef, Side};
use crate::testing::integers::{Spot, Unit, Vector, cross, dot, resolved, sign};
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::Zero;
use std::collections::BTreeMap;

/// Checks exactly that the fragments of every piece tile it: no gap, no overlap. O(corners) a piece, in
/// rational numbers.
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
    let mut ends = Ends::default();
    for fragment in fragments {
        let corners: Vec<Spot> = fragment.exact_corners().map(|corner| unit.spot(&corner)).collect();
        if corners.iter().any(|corner| corner.w.is_zero() || !corner.height(&plane).is_zero()) {
            return Err(FragmentFault::OffPlane(fragment.id()));
        }
        let corners: Vec<Vector> = corners.into_iter().map(|corner| view.flat(corner)).collect();
        if !is_convex(&corners) {
            return Err(FragmentFault::NotConvex(fragment.id()));
        }
        ends.add(corners.iter().map(places));
    }
    let mut whole: Vec<Vector> = piece.points().map(|p| view.flat(unit.spot(&Point::Given(p)))).collect();
    whole.reverse();
    ends.add(whole.iter().map(places));
    if ends.cancel() { Ok(()) } else { Err(FragmentFault::Boundary) }
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

/// Every corner is on the left of every side or on it, some strictly so, and no two coincide: then
/// the boundary is convex and runs around once.
fn is_convex(corners: &[Vector]) -> bool {
    let mut any_area = false;
    for (k, p) in corners.iter().enumerate() {
        let side = cross(p, &corners[(k + 1) % corners.len()]);
        // A side without length has no line.
        if side.iter().all(BigInt::is_zero) {
            return false;
        }
        for corner in corners {
            match sign(&dot(&side, corner)) {
                -1 => return false,
                1 => any_area = true,
                _ => {}
            }
        }
    }
    let mut distinct: Vec<Place> = corners.iter().map(places).collect();
    distinct.sort();
    distinct.dedup();
    any_area && distinct.len() == corners.len()
}

type Place = [BigRational; 2];

fn places([u, v, w]: &Vector) -> Place {
    [u, v].map(|x| BigRational::new(x.clone(), w.clone()))
}

/// A line by its slope and its height at 0, or an upright one by its place.
type Line = (Option<BigRational>, BigRational);

/// How many more segments start than end, by line and point.
#[derive(Default)]
struct Ends {
    counts: BTreeMap<(Line, Place), i32>,
}

impl Ends {
    fn add(&mut self, corners: impl Iterator<Item = Place>) {
        let corners: Vec<Place> = corners.collect();
        for (k, from) in corners.iter().enumerate() {
            let to = &corners[(k + 1) % corners.len()];
            let line = line(from, to);
            *self.counts.entry((line.clone(), from.clone())).or_default() += 1;
            *self.counts.entry((line, to.clone())).or_default() -= 1;
        }
    }

    fn cancel(&self) -> bool {
        self.counts.values().all(|&count| count == 0)
    }
}

fn line([x, y]: &Place, [other_x, other_y]: &Place) -> Line {
    let run = other_x - x;
    if run.is_zero() {
        return (None, x.clone());
    }
    let slope = (other_y - y) / run;
    let height = y - &slope * x;
    (Some(slope), height)
}
