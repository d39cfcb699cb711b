//! What a contour image claims, handed to the checker.

use super::domain::Domain;
use super::image::ContourImage;
use super::windows::{Horizon, Pane};
use crate::verify::{
    Arithmetic, Certificate, Defect, Evidence, EvidenceCell, EvidenceDomain, EvidenceHorizon, EvidencePane,
    EvidenceSliver, HalfSphere,
};

impl ContourImage {
    /// What the image claims, by exact definition. Its cells have the numbers that they have here.
    pub fn evidence(&self) -> Evidence {
        // Numbered in the order of their first use.
        let mut numbers = vec![None; self.tree.directions.circle_count()];
        let mut splitters = Vec::new();
        let cells = self.cells().map(|cell| {
            let sides = cell.arcs().iter().map(|arc| {
                let circle = arc.along.circle();
                let splitter = *numbers[circle.0 as usize].get_or_insert_with(|| {
                    splitters.push(self.tree.directions.splitter(self.skeleton(), circle));
                    splitters.len() as u32 - 1
                });
                HalfSphere { splitter, inside: arc.along.inside() }
            });
            EvidenceCell { piece: cell.piece(), sides: sides.collect() }
        });
        let cells = cells.collect();
        let slivers = self.uncut_slivers().iter().map(|sliver| EvidenceSliver {
            piece: sliver.piece,
            plane: sliver.plane,
            beyond: sliver.beyond,
        });
        Evidence {
            eye: self.viewpoint().eye(),
            domain: self.evidence_domain(),
            epsilon: self.epsilon(),
            slivers: slivers.collect(),
            splitters,
            cells,
        }
    }

    fn evidence_domain(&self) -> EvidenceDomain {
        let horizon = self.domain().horizon().map(|horizon| match (horizon, self.viewpoint().surface_piece()) {
            (Horizon::Normal(normal), _) => EvidenceHorizon::Normal(normal),
            (Horizon::Surface, Some((piece, side))) => EvidenceHorizon::Above(piece, side),
            (Horizon::Surface, None) => unreachable!("such a view is refused"),
        });
        match (self.domain(), horizon) {
            (Domain::Frustum(frustum), _) => EvidenceDomain::Frustum(frustum.normals()),
            (Domain::Window(windows), horizon) => {
                let panes = windows.panes().iter().map(|pane| match pane {
                    Pane::Polygon(polygon) => EvidencePane::Polygon(*polygon),
                    Pane::Ring(ring) => EvidencePane::Ring(ring.clone()),
                });
                EvidenceDomain::Window { panes: panes.collect(), horizon }
            }
            (_, None) => EvidenceDomain::Sphere,
            (_, Some(EvidenceHorizon::Normal(normal))) => EvidenceDomain::Hemisphere(normal),
            (_, Some(EvidenceHorizon::Above(piece, side))) => EvidenceDomain::Above(piece, side),
        }
    }

    /// Proves that the cells tile the domain and show what is nearest, without trusting the code that made
    /// them: see [`Evidence::check`].
    ///
    /// ```
    /// # use nusselt::bsp::{BspOptions, SceneBsp};
    /// # use nusselt::contour::{Domain, Viewpoint};
    /// let scene = nusselt::samples::cornell_box().to_builder().build()?;
    /// let bsp = SceneBsp::build(&scene, &BspOptions::default())?;
    /// let image = bsp.view(&Viewpoint::free(glam::DVec3::new(278.0, 273.0, 1.0)), &Domain::Sphere)?;
    /// let certificate = image.certify()?;
    /// assert_eq!(certificate.cells, image.cell_count());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The first defect found: there should be none, so please report it.
    pub fn certify(&self) -> Result<Certificate, Defect> {
        self.evidence().check(self.scene(), Arithmetic::Kernel)
    }
}
