//! What becomes of a face whose vertices exist: facets, or a problem, or it is dropped.

use super::ZeroAreaPolicy;
use super::corners::canonical;
use super::facets::{Facets, facets};
use super::flat::is_planar;
use super::triangulate::{Fault, RANGE};
use super::{DropCause, DuplicatePolicy, NonPlanarPolicy, OrDrop, PolygonId, Repair, SceneProblem, Shape, VertexId};
use glam::DVec3;
use std::collections::HashMap;

/// Why there are no facets of a face.
#[derive(Debug)]
pub(super) struct Broken {
    pub(super) problem: SceneProblem,
    /// The policy by which it is dropped; `None` if it is refused.
    pub(super) cause: Option<DropCause>,
}

/// Applies the policies to faces, in order.
pub(super) struct Judge<'a> {
    repair: &'a Repair,
    /// The polygons with area so far, if duplicates matter. The keys come from files, so the map is one that cannot
    /// be filled with collisions on purpose.
    known: HashMap<Vec<Vec<VertexId>>, PolygonId>,
}

impl<'a> Judge<'a> {
    pub(super) fn new(repair: &'a Repair) -> Self {
        Self { repair, known: HashMap::new() }
    }

    /// The facets of the next face. No ring may name one vertex twice in a row.
    pub(super) fn judge(
        &mut self,
        polygon: PolygonId,
        rings: &[Vec<VertexId>],
        vertices: &[DVec3],
    ) -> Result<Facets, Broken> {
        let facets = match facets(rings, vertices) {
            Ok(facets) => facets,
            Err(fault) => return Err(self.of_fault(polygon, fault, rings, vertices)),
        };
        match facets.shape {
            Shape::NonPlanar => self.check_non_planar(polygon)?,
            Shape::Degenerate => {
                return match self.repair.zero_area {
                    ZeroAreaPolicy::Keep => Ok(facets),
                    ZeroAreaPolicy::Reject => Err(Broken { problem: SceneProblem::ZeroArea { polygon }, cause: None }),
                };
            }
            Shape::Convex | Shape::Concave | Shape::Dropped => {}
        }
        self.check_duplicate(polygon, rings)?;
        Ok(facets)
    }

    fn check_non_planar(&self, polygon: PolygonId) -> Result<(), Broken> {
        let cause = match self.repair.non_planar {
            NonPlanarPolicy::Triangulate => return Ok(()),
            NonPlanarPolicy::Reject => None,
            NonPlanarPolicy::Drop => Some(DropCause::NonPlanar),
        };
        Err(Broken { problem: SceneProblem::NonPlanar { polygon }, cause })
    }

    /// Checks the next face with area against those before, if duplicates matter.
    pub(super) fn check_duplicate(&mut self, polygon: PolygonId, rings: &[Vec<VertexId>]) -> Result<(), Broken> {
        let cause = match self.repair.duplicates {
            DuplicatePolicy::Keep => return Ok(()),
            DuplicatePolicy::Reject => None,
            DuplicatePolicy::Drop => Some(DropCause::Duplicate),
        };
        let first = *self.known.entry(canonical(rings)).or_insert(polygon);
        if first == polygon {
            Ok(())
        } else {
            Err(Broken { problem: SceneProblem::Duplicate { polygon, first }, cause })
        }
    }

    fn of_fault(&self, polygon: PolygonId, fault: Fault, rings: &[Vec<VertexId>], vertices: &[DVec3]) -> Broken {
        // A face that is not planar is first of all that, for those who do not want such faces.
        if self.repair.non_planar != NonPlanarPolicy::Triangulate {
            let points: Vec<_> = rings.iter().flatten().map(|v| vertices[v.index()]).collect();
            if let (false, Err(broken)) = (is_planar(&points), self.check_non_planar(polygon)) {
                return broken;
            }
        }
        let problem = match fault {
            Fault::Crossing => SceneProblem::SelfCrossing { polygon },
            Fault::HoleOutside => SceneProblem::HoleOutside { polygon },
            Fault::HolesOverlap => SceneProblem::HolesOverlap { polygon },
            Fault::TooMuchWork => SceneProblem::TooMuchWork { polygon },
            Fault::OutOfRange => SceneProblem::OutOfRange { polygon, limit: RANGE },
        };
        Broken { problem, cause: (self.repair.self_crossing == OrDrop::Drop).then_some(DropCause::SelfCrossing) }
    }
}
