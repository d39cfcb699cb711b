//! Polygons that lie on each other in one plane.

use super::super::flat::{axes_by_size, orientation, project, triangle_normal, unit_scale, unscaled};
use super::super::{Axis, PieceId, PieceRef, Scene, Side, SupportingPlane};
use super::CoplanarOverlap;
use super::clip::shared_area;
use super::halves::Halving;
use super::planes;
use super::tree::{Aabb, bounds};
use crate::exact::{Sign, orient3d};
use glam::{DVec2, DVec3};
use std::collections::BTreeSet;

/// So many overlapping pairs of pieces are kept.
const MAX_FOUND: usize = 100_000;
/// So much work is done, and so much more for each piece: pairs of pieces and of their vertices that are compared, and
/// corners and boxes that are put on sides of lines.
const MAX_WORK: usize = 50_000_000;
const MAX_WORK_PER_PIECE: usize = 200;
/// So many pieces are not halved any more.
const FEW: usize = 8;

/// The pairs of polygons whose insides share area in one plane, by polygons; false if the search was given up.
pub(super) fn overlaps(scene: &Scene) -> (Vec<CoplanarOverlap>, bool) {
    let boxes: Vec<Aabb> = scene.pieces().map(|piece| bounds(piece.points())).collect();
    let scale = unit_scale(scene.vertices().iter().copied());
    let mut search = Search { scene, boxes, found: BTreeSet::new(), work: 0 };
    let complete = planes::groups(scene).into_iter().all(|group| search.visit_group(group));
    let parts = search.found.iter().map(|&pair| {
        let pair = pair.map(|id| scene.piece(id));
        let view = View::new(scene, pair[0].plane());
        let opposed = view.turn(pair[0]) != view.turn(pair[1]);
        CoplanarOverlap { polygons: pair.map(PieceRef::polygon), opposed, area: view.area(pair, scale) }
    });
    (merged(parts.collect()), complete)
}

struct Search<'a> {
    scene: &'a Scene,
    /// Around each piece.
    boxes: Vec<Aabb>,
    /// The pairs of pieces that share area, lower numbers first.
    found: BTreeSet<[PieceId; 2]>,
    work: usize,
}

impl Search<'_> {
    /// Finds the pairs in a group of pieces, which ascend; false if the search was given up.
    fn visit_group(&mut self, group: Vec<PieceId>) -> bool {
        let Some(&first) = group.first() else { return true };
        let axis = View::new(self.scene, self.scene.piece(first).plane()).axis;
        let polygon = |piece: &PieceId| self.scene.piece(*piece).polygon();
        let mut jobs = vec![group];
        while let Some(pieces) = jobs.pop() {
            // They ascend by polygons, too; those of one polygon do not overlap.
            if pieces.first().map(polygon) == pieces.last().map(polygon) {
                continue;
            }
            let halving = Halving { scene: self.scene, boxes: &self.boxes, axis };
            let halves = (pieces.len() > FEW).then(|| halving.halves(&pieces, &mut self.work)).flatten();
            match halves {
                Some(halves) => jobs.extend(halves),
                None => self.compare_all(&pieces),
            }
            if self.is_given_up() {
                return false;
            }
        }
        true
    }

    fn compare_all(&mut self, pieces: &[PieceId]) {
        for (k, &piece) in pieces.iter().enumerate() {
            for &other in &pieces[k + 1..] {
                if self.is_given_up() {
                    return;
                }
                self.compare([piece, other]);
            }
        }
    }

    fn compare(&mut self, ids: [PieceId; 2]) {
        self.work += 1;
        let pair = ids.map(|id| self.scene.piece(id));
        let [own, other] = ids.map(|id| self.boxes[id.index()]);
        if pair[0].polygon() == pair[1].polygon() || !may_share_area(own, other) || !is_coplanar(self.scene, pair) {
            return;
        }
        self.work += pair[0].vertices().len() * pair[1].vertices().len();
        if insides_meet(&View::new(self.scene, pair[0].plane()), pair) {
            self.found.insert(ids);
        }
    }

    fn is_given_up(&self) -> bool {
        let most = MAX_WORK.saturating_add(MAX_WORK_PER_PIECE.saturating_mul(self.boxes.len()));
        self.work > most || self.found.len() >= MAX_FOUND
    }
}

/// One entry for each pair of polygons, with the area of all.
fn merged(mut parts: Vec<CoplanarOverlap>) -> Vec<CoplanarOverlap> {
    // Pieces come in order of polygons, so the lower one is first. The larger areas first.
    parts.sort_by(|a, b| a.polygons.cmp(&b.polygons).then(b.area.total_cmp(&a.area)).then(a.opposed.cmp(&b.opposed)));
    parts.dedup_by(|part, whole| {
        let same = part.polygons == whole.polygons;
        if same {
            whole.area = (whole.area + part.area).min(f64::MAX);
        }
        same
    });
    parts
}

/// What is shared by two boxes must be longer than nothing along two axes to hold an area.
fn may_share_area((low, high): Aabb, (l, h): Aabb) -> bool {
    let (from, to) = (low.max(l), high.min(h));
    from.cmple(to).all() && from.cmplt(to).bitmask().count_ones() >= 2
}

/// Whether two pieces lie in one plane.
fn is_coplanar(scene: &Scene, [piece, other]: [PieceRef<'_>; 2]) -> bool {
    if piece.plane_id() == other.plane_id() {
        return true;
    }
    // Axis-aligned planes are shared, so different ones are different.
    let (Some(plane), Some(points)) = (piece.plane().points(), other.plane().points()) else { return false };
    let [a, b, c] = plane.map(|v| scene.vertex(v));
    points.iter().all(|v| plane.contains(v) || orient3d(a, b, c, scene.vertex(*v)).is_zero())
}

/// How a plane is seen flat: along an axis that is not in it.
struct View {
    axis: Axis,
    /// Whether what runs counter-clockwise seen from the plane's front does so along the axis.
    sign: Sign,
    /// The size of the component of the plane's unit normal on the axis, rounded.
    slant: f64,
}

impl View {
    fn new(scene: &Scene, plane: SupportingPlane) -> Self {
        match plane {
            SupportingPlane::Axis { axis, .. } => Self { axis, sign: Sign::Positive, slant: 1.0 },
            SupportingPlane::Points(points) => {
                let triangle = points.map(|v| scene.vertex(v));
                let normal = triangle_normal(triangle);
                let signs = axes_by_size(normal).map(|axis| (axis, orientation(triangle, axis)));
                let (axis, sign) = signs.into_iter().find(|(_, sign)| !sign.is_zero()).unwrap_or(signs[0]);
                Self { axis, sign, slant: normal.normalize_or(DVec3::ONE)[axis as usize].abs() }
            }
        }
    }

    /// Positive if the piece, which is in that plane, runs counter-clockwise along the axis.
    fn turn(&self, piece: PieceRef<'_>) -> Sign {
        let plane = piece.plane();
        // The planes are one, but their fronts may be on different sides.
        let sign = match plane.points() {
            None => self.sign,
            Some(points) => orientation(points.map(|v| piece.scene.vertex(v)), self.axis),
        };
        if piece.facing() == Side::Front { sign } else { -sign }
    }

    fn flat(&self, piece: PieceRef<'_>) -> Vec<DVec2> {
        piece.points().map(|p| project(p, self.axis)).collect()
    }

    fn area(&self, pair: [PieceRef<'_>; 2], scale: f64) -> f64 {
        let rings = pair.map(|piece| {
            let mut ring: Vec<_> = self.flat(piece).into_iter().map(|p| p * scale).collect();
            if self.turn(piece).is_negative() {
                ring.reverse();
            }
            ring
        });
        // Lengths are scaled once for each dimension.
        unscaled(unscaled(shared_area(&rings[0], &rings[1]) / self.slant, scale), scale)
    }
}

/// Whether the insides of two convex pieces in one plane meet: no side of one has all of the other on its outer
/// side or on its line (of two convex polygons that do not overlap, a side of one always separates them). Exact.
fn insides_meet(view: &View, [piece, other]: [PieceRef<'_>; 2]) -> bool {
    let (first, second) = (view.flat(piece), view.flat(other));
    !separates([piece, other], [&first, &second], view.turn(piece))
        && !separates([other, piece], [&second, &first], view.turn(other))
}

/// Whether a side of the first, which turns to `turn`, separates it from the second.
fn separates([piece, other]: [PieceRef<'_>; 2], [first, second]: [&[DVec2]; 2], turn: Sign) -> bool {
    let (names, others) = (piece.vertices(), other.vertices());
    (0..first.len()).any(|k| {
        let next = (k + 1) % first.len();
        // The vertices of the side itself are on its line.
        let is_end = |vertex| vertex == names[k] || vertex == names[next];
        others
            .iter()
            .zip(second)
            .all(|(&vertex, &p)| is_end(vertex) || super::super::flat::orient2d(first[k], first[next], p) != turn)
    })
}
