//! Cutting pieces into what is seen and what is not.

use crate::bsp::{LineId, PointId};
use crate::bvh::Hierarchy;
use crate::contour::ViewError;
use crate::contour::polygon::Span;
use crate::contour::regions::mosaic::Mosaic;
use crate::contour::tree::divide::Division;
use crate::contour::view::Sight;
use crate::scene::PieceId;
use glam::DVec3;

/// What became of all pieces.
pub(super) struct Cast<'a> {
    pub(super) light: DVec3,
    /// A face for every part.
    pub(super) mosaic: Mosaic<'a>,
    /// The piece of every part, ascending, and if that is seen.
    pub(super) parts: Vec<(PieceId, bool)>,
    /// Pieces whose planes hold the light.
    pub(super) edge_on: Vec<PieceId>,
}

impl<'a> Cast<'a> {
    pub(super) fn new(hierarchy: &'a Hierarchy, mut sight: Sight<'a>, most_parts: usize) -> Result<Self, ViewError> {
        let skeleton = sight.skeleton;
        let (mut arcs, mut faces) = (Vec::new(), Vec::new());
        let (mut parts, mut edge_on) = (Vec::new(), Vec::new());
        let mut division = Division::default();
        for piece in hierarchy.scene.pieces() {
            let Some(shown) = skeleton.shown_side(piece, sight.eye) else {
                edge_on.push(piece.id());
                continue;
            };
            sight.look_at(piece, hierarchy.panels.sides(piece.id().0), shown);
            let Sight { contour, buffers, .. } = &mut sight;
            contour.divide(skeleton, piece.id(), &buffers.polygon, &mut division, &mut buffers.work);
            for part in &division.parts {
                parts.push((piece.id(), part.is_seen));
                faces.push(Span::keep(&division.arcs[part.boundary.range()], &mut arcs));
            }
            if parts.len() > most_parts {
                return Err(ViewError::TooManyCells { limit: most_parts });
            }
        }
        let light = sight.eye;
        let mosaic = Mosaic::of_polygons(skeleton, sight.contour.directions, arcs, &faces);
        Ok(Self { light, mosaic, parts, edge_on })
    }
}

/// The boundary of a piece.
#[derive(Default)]
pub(super) struct Boundary {
    piece: Option<PieceId>,
    pub(super) sides: Vec<BoundarySide>,
}

/// A side of a piece, by the line that stands for all that are the same.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoundarySide {
    /// Where it starts.
    pub(super) point: PointId,
    pub(super) line: LineId,
    /// It runs as that line does.
    pub(super) forward: bool,
}

impl Boundary {
    /// Becomes that of a piece.
    pub(super) fn turn_to(&mut self, hierarchy: &Hierarchy, piece: PieceId) {
        if self.piece.replace(piece) == Some(piece) {
            return;
        }
        self.sides.clear();
        self.sides.extend(hierarchy.panels.sides(piece.0).iter().map(|side| {
            let (line, same_way) = hierarchy.skeleton.representative(side.line);
            BoundarySide { point: side.point, line, forward: side.forward == same_way }
        }));
    }
}
