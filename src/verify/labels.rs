//! Rules D and E: every cell shows what is nearest in all of its directions.

use super::boxes::{PieceBoxes, corners_of};
use super::checker::Checker;
use super::defect::Defect;
use super::domain::DomainCones;
use super::evidence::HalfSphere;
use super::signs::Signs;
use super::slivers::Disorder;
use crate::exact::{Sign, Splitter};
use crate::scene::{PieceId, Side};
use glam::DVec3;

/// So many pieces in front of another are tested against each of its cells.
const FEW: usize = 16;

/// Buffers.
#[derive(Default)]
struct Work {
    cone: Vec<HalfSphere>,
    part: Vec<HalfSphere>,
}

impl<S: Signs> Checker<'_, S> {
    /// A hierarchy of the pieces that can be seen at all: those whose plane does not hold the eye, and that are not all below the
    /// horizon or outside of frustum and windows, where no cell is once they are known to tile the domain.
    fn boxes(&mut self) -> PieceBoxes {
        let mut seen = Vec::new();
        for piece in self.scene.pieces().filter(|piece| !self.heights[piece.plane_id().index()].is_zero()) {
            let corners = corners_of(piece);
            let signs = &mut self.signs;
            let is_below = self.horizon.is_some_and(|horizon| signs.box_outside(&[horizon], corners));
            let mut is_beside = |cones: &DomainCones| cones.parts.iter().all(|part| signs.box_outside(part, corners));
            if !is_below && !self.cones.as_ref().is_some_and(&mut is_beside) {
                seen.push((piece.id(), corners));
            }
        }
        PieceBoxes::new(seen)
    }

    /// D: every cell lies in the cone of the piece that it shows, and background meets no cone.
    pub(super) fn check_cones(&mut self) -> Result<(), Defect> {
        let mut work = Work::default();
        let has_background = self.evidence.cells.iter().any(|cell| cell.piece.is_none());
        let boxes = has_background.then(|| self.boxes());
        for cell in 0..self.cell_count() {
            match (self.evidence.cells[cell as usize].piece, &boxes) {
                (Some(piece), _) => self.check_cone(cell, piece, &mut work)?,
                (None, Some(boxes)) => self.check_background(cell, boxes, &mut work)?,
                (None, None) => {}
            }
        }
        Ok(())
    }

    fn check_cone(&mut self, cell: u32, piece: PieceId, work: &mut Work) -> Result<(), Defect> {
        if self.height(piece).is_zero() {
            return Err(Defect::EdgeOn { cell, piece });
        }
        self.cone(piece, &mut work.cone);
        work.part.clear();
        work.part.extend_from_slice(self.cell(cell));
        for (k, &after) in work.part.iter().enumerate() {
            let before = work.part[k.checked_sub(1).unwrap_or(work.part.len() - 1)];
            for &edge in &work.cone {
                if self.orientation([before, after, edge]) == Sign::Negative {
                    return Err(Defect::OutsideCone { cell, piece, towards: self.rounded([before, after]) });
                }
            }
        }
        Ok(())
    }

    fn check_background(&mut self, cell: u32, boxes: &PieceBoxes, work: &mut Work) -> Result<(), Defect> {
        let sides = self.cell(cell).to_vec();
        let mut candidates = Vec::new();
        let Ok(()) = boxes.visit(
            |corners| self.signs.box_outside(&sides, corners),
            |piece| {
                candidates.push(piece);
                Ok::<(), std::convert::Infallible>(())
            },
        );
        for piece in candidates {
            if self.meets_cone(&sides, piece, work) {
                return Err(Defect::NotBackground { cell, piece, towards: self.middle(&work.part) });
            }
        }
        Ok(())
    }

    /// True if a cell meets the interior of a piece's cone; leaves what they share in `work.part`.
    fn meets_cone(&mut self, sides: &[HalfSphere], piece: PieceId, work: &mut Work) -> bool {
        work.part.clear();
        work.part.extend_from_slice(sides);
        self.cone(piece, &mut work.cone);
        work.cone.iter().all(|&edge| self.clip(&mut work.part, edge))
    }

    /// E: no other piece is in front of the one that a cell shows, in any of the cell's directions.
    pub(super) fn check_depth(&mut self) -> Result<(), Defect> {
        let boxes = &self.boxes();
        let mut cells: Vec<(PieceId, u32)> = (0..self.cell_count())
            .filter_map(|cell| self.evidence.cells[cell as usize].piece.map(|piece| (piece, cell)))
            .collect();
        cells.sort_unstable();
        let mut work = Work::default();
        for showing in cells.chunk_by(|a, b| a.0 == b.0) {
            let piece = showing[0].0;
            // What may be in front of the piece at all; if that is a lot, each cell looks for itself.
            let mut cone = std::mem::take(&mut work.cone);
            self.cone(piece, &mut cone);
            let common = self.candidates(piece, &cone, boxes, FEW);
            work.cone = cone;
            for &(_, cell) in showing {
                let sides = self.cell(cell).to_vec();
                let own = if common.is_none() { self.candidates(piece, &sides, boxes, usize::MAX) } else { None };
                for &other in common.iter().chain(&own).flatten() {
                    if self.is_in_front(other, piece, &sides, &mut work) {
                        let towards = self.middle(&work.part);
                        return Err(Defect::Hidden { cell, piece, by: other, towards });
                    }
                }
            }
        }
        Ok(())
    }

    /// The other pieces of which something may be between the eye and a piece, inside of a cone in which all of the cone is
    /// filled by that piece; `None` if there are more than `most`.
    ///
    /// Whatever is there, or coplanar with the piece, meets the box around the eye and the piece.
    fn candidates(
        &mut self,
        piece: PieceId,
        cone: &[HalfSphere],
        boxes: &PieceBoxes,
        most: usize,
    ) -> Option<Vec<PieceId>> {
        let eye = self.evidence.eye;
        let corners = self.scene.piece(piece).points();
        let [low, high] = corners.fold([eye, eye], |[low, high], p| [low.min(p), high.max(p)]);
        let plane = self.scene.piece(piece).plane_id().0;
        let away = -self.height(piece);
        let signs = &mut self.signs;
        let mut found = Vec::new();
        let visited = boxes.visit(
            |corners| {
                corners[0].cmpgt(high).any()
                    || corners[1].cmplt(low).any()
                    || signs.box_outside(cone, corners)
                    || signs.box_beyond(plane, away, corners)
            },
            |other| {
                if other != piece {
                    found.push(other);
                }
                if found.len() > most { Err(()) } else { Ok(()) }
            },
        );
        visited.ok().map(|()| found)
    }

    /// True if `other` is in front of the piece that a cell shows, somewhere in that cell and without an
    /// excuse; leaves in `work.part` where.
    fn is_in_front(&mut self, other: PieceId, piece: PieceId, sides: &[HalfSphere], work: &mut Work) -> bool {
        let is_coplanar = match self.places(other, piece) {
            // Seen from the near side of a plane, what is nowhere nearer than the plane is not in front of it.
            Places { nearer: false, beyond: true } => return false,
            Places { nearer: false, beyond: false } if !self.wins(other, piece) => return false,
            Places { nearer: false, beyond: false } => true,
            // Nor is something in front if all of the piece is nearer than its plane.
            Places { nearer: true, .. } if !self.places(piece, other).beyond => return false,
            Places { nearer: true, .. } => false,
        };
        if !self.meets_cone(sides, other, work) {
            return false;
        }
        if !is_coplanar {
            let nearer = self.nearer(other, piece);
            if !self.clip(&mut work.part, nearer) {
                return false;
            }
        }
        !self.is_excused([piece, other], &work.part)
    }

    /// Where the corners of one piece are against the plane of another, seen from the eye.
    fn places(&mut self, of: PieceId, against: PieceId) -> Places {
        let near = self.height(against);
        let (piece, plane) = (self.scene.piece(of), self.scene.piece(against).plane_id());
        let mut places = Places { nearer: false, beyond: false };
        if piece.plane_id() == plane {
            return places;
        }
        for corner in piece.points() {
            let sign = self.signs.height(corner, plane.0) * near;
            places.nearer |= sign.is_positive();
            places.beyond |= sign.is_negative();
        }
        places
    }

    /// Of two coplanar pieces, the one that shows its front is seen, then the one of the lowest number.
    fn wins(&self, other: PieceId, piece: PieceId) -> bool {
        (self.shown(other) == Side::Back, other) < (self.shown(piece) == Side::Back, piece)
    }

    /// The directions in which the plane of `other` is nearer than that of `piece`: for heights above 0,
    /// `-h / (N . d)` is the distance along d, and `h_other N_piece - h_piece N_other` is positive there.
    fn nearer(&mut self, other: PieceId, piece: PieceId) -> HalfSphere {
        let planes = [piece, other].map(|id| self.scene.resolve_plane(self.scene.piece(id).plane()));
        let inside = self.height(piece) * self.height(other);
        HalfSphere { splitter: self.signs.add(&Splitter::Crease(planes)), inside }
    }

    /// True if the slivers recorded of two pieces excuse that they are in wrong order in all of `part`.
    fn is_excused(&mut self, pieces: [PieceId; 2], part: &[HalfSphere]) -> bool {
        let epsilon = self.evidence.epsilon;
        let slivers = pieces.map(|piece| self.slivers_of(piece));
        if epsilon <= 0.0 || slivers.iter().all(Vec::is_empty) {
            return false;
        }
        // The splitter measures in floating point, on corners that are rounded: so up to 1e-9 of the scene's size, or of
        // epsilon, is allowed on top.
        let limit = (epsilon * (1.0 + 1e-9) + 1e-9 * self.scene.diagonal()).min(f64::MAX);
        let planes = pieces.map(|piece| self.scene.resolve_plane(self.scene.piece(piece).plane()));
        let disorder = Disorder::new(self.evidence.eye, planes.each_ref(), limit);
        let inwards = |side: &HalfSphere| disorder.inward_normal(self.signs.definition(side.splitter), side.inside);
        let mut parts = vec![part.iter().map(inwards).collect()];
        for (whose, slivers) in slivers.iter().enumerate() {
            for sliver in slivers {
                disorder.excuse(&mut parts, whose, sliver, &self.scene.resolve_plane(sliver.plane));
                if parts.is_empty() {
                    return true;
                }
            }
        }
        false
    }

    /// A direction inside of a polygon, rounded.
    fn middle(&self, part: &[HalfSphere]) -> DVec3 {
        let corner = |k: usize| self.rounded([part[k.checked_sub(1).unwrap_or(part.len() - 1)], part[k]]);
        (0..part.len()).map(corner).sum::<DVec3>().normalize_or_zero()
    }
}

/// Whether some corner of a piece is nearer than a plane, or beyond it; neither if it lies in the plane.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Places {
    nearer: bool,
    beyond: bool,
}
