//! Proving that a contour image is right, from its evidence and the scene alone.

use super::checker::Checker;
use super::defect::Defect;
use super::evidence::{Evidence, EvidenceDomain, EvidenceHorizon, EvidencePane};
use super::kernel_signs::KernelSigns;
use super::rational_signs::RationalSigns;
use super::signs::Signs;
use crate::exact::Sign;
use crate::scene::{PieceId, Scene, Splitter, SupportingPlane};
use glam::DVec3;

/// Where the signs of a proof come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Arithmetic {
    /// The kernel of predicates that the engine uses itself.
    #[default]
    Kernel,
    /// Rational numbers alone: shares no predicate with the engine, and takes about a hundred times as long.
    Rational,
}

/// How much is proved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Extent {
    /// Rules A to C: the cells tile the domain.
    Tiling,
    /// Rules A to D: also, cells show only what lies behind all of them, and background only where there is
    /// nothing.
    Cones,
    /// Rules A to E: also, what they show is the nearest, in all directions.
    #[default]
    All,
}

/// That a proof succeeded, and what it took.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Certificate {
    /// The cells.
    pub cells: usize,
    /// The great circles on which their sides lie.
    pub great_circles: usize,
    /// The signs that were decided exactly.
    pub exact_decisions: u64,
}

impl Evidence {
    /// Proves that the cells tile the domain and show what is nearest, for all directions and with exact
    /// signs; or tells what is wrong, and where. Nothing is taken from the run that made the image: normals are
    /// made anew from the scene and the eye.
    ///
    /// The cost is a few times that of the view, with [`Arithmetic::Kernel`] and epsilon 0; slivers are excused in rational
    /// numbers, which takes longer where there are many. Evidence that no engine made, in the worst case, takes as much as sides of cells times pieces of the scene; millions of great circles that nearly
    /// coincide are refused, and slivers are no longer excused when tens of millions were looked at. What is proved, and how, is told in
    /// docs/verification.md.
    ///
    /// # Errors
    /// The first defect found.
    pub fn check(&self, scene: &Scene, arithmetic: Arithmetic) -> Result<Certificate, Defect> {
        self.check_to(scene, arithmetic, Extent::All)
    }

    /// The same for some of the rules.
    ///
    /// # Errors
    /// The first defect found.
    pub fn check_to(&self, scene: &Scene, arithmetic: Arithmetic, extent: Extent) -> Result<Certificate, Defect> {
        self.check_form(scene)?;
        match arithmetic {
            Arithmetic::Kernel => self.check_in(scene, KernelSigns::new(scene, self.eye), extent),
            Arithmetic::Rational => self.check_in(scene, RationalSigns::new(scene, self.eye), extent),
        }
    }

    fn check_in(&self, scene: &Scene, signs: impl Signs, extent: Extent) -> Result<Certificate, Defect> {
        let mut checker = Checker::new(scene, self, signs)?;
        let circles = checker.check_tiling()?;
        if extent >= Extent::Cones {
            checker.check_cones()?;
        }
        if extent >= Extent::All {
            checker.check_depth()?;
        }
        Ok(checker.certificate(circles))
    }

    /// Everything named exists, and every number is finite.
    fn check_form(&self, scene: &Scene) -> Result<(), Defect> {
        let has_piece = |piece: PieceId| piece.index() < scene.piece_count();
        let has_plane = |plane: &SupportingPlane| match plane {
            SupportingPlane::Axis { value, .. } => value.is_finite(),
            SupportingPlane::Points(points) => points.iter().all(|v| v.index() < scene.vertices().len()),
        };
        let has_splitter = |splitter: &Splitter| match splitter {
            Splitter::Edge(ends) => ends.iter().all(|v| v.index() < scene.vertices().len()),
            Splitter::Crease(planes) => planes.iter().all(has_plane),
            Splitter::Points(ends) => ends.iter().all(|p| p.is_finite()),
            Splitter::Given(normal) => normal.is_finite(),
            Splitter::Parallel(plane) => has_plane(plane),
        };
        let malformed = |place: String, what| Err(Defect::Malformed { place, what });
        if !self.eye.is_finite() || !self.epsilon.is_finite() {
            return malformed("eye and epsilon".to_owned(), "a number is not finite");
        }
        let is_normal = |normal: &DVec3| normal.is_finite() && *normal != DVec3::ZERO;
        let is_horizon = self.domain.horizon().is_none_or(|horizon| match horizon {
            EvidenceHorizon::Normal(normal) => is_normal(&normal),
            EvidenceHorizon::Above(piece, _) => has_piece(piece),
        });
        if !is_horizon {
            return malformed("domain".to_owned(), "its normal is zero or not finite, or its piece does not exist");
        }
        match &self.domain {
            EvidenceDomain::Frustum(normals) if !normals.iter().all(is_normal) => {
                return malformed("domain".to_owned(), "a normal of the frustum is zero or not finite");
            }
            EvidenceDomain::Window { panes, .. } => {
                let is_pane = |pane: &EvidencePane| match pane {
                    EvidencePane::Polygon(polygon) => polygon.index() < scene.polygon_count(),
                    EvidencePane::Ring(ring) => ring.len() >= 3 && ring.iter().all(|p| p.is_finite()),
                };
                if let Some(k) = panes.iter().position(|pane| !is_pane(pane)) {
                    let what =
                        "it has fewer than three points, or some that are not finite, or its polygon does not exist";
                    return malformed(format!("window {k}"), what);
                }
            }
            _ => {}
        }
        if let Some(k) = self.splitters.iter().position(|splitter| !has_splitter(splitter)) {
            return malformed(format!("splitter {k}"), "a vertex does not exist, or a number is not finite");
        }
        let is_sliver = |s: &super::EvidenceSliver| has_piece(s.piece) && has_plane(&s.plane);
        if let Some(k) = self.slivers.iter().position(|sliver| !is_sliver(sliver)) {
            return malformed(format!("sliver {k}"), "its piece or its plane does not exist");
        }
        for (k, cell) in self.cells.iter().enumerate() {
            let is_side =
                |side: &super::HalfSphere| (side.splitter as usize) < self.splitters.len() && side.inside != Sign::Zero;
            if !cell.piece.is_none_or(has_piece) || !cell.sides.iter().all(is_side) {
                return malformed(format!("cell {k}"), "its piece or one of its splitters does not exist");
            }
        }
        Ok(())
    }
}
