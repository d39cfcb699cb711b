//! A hierarchy for a scene with objects moved, without building it anew.

use super::panels::{MOST_PIECES, Panels};
use super::{Hierarchy, SceneBvh, bounds_of_pieces, refit};
use crate::scene::{MoveError, ObjectId, PieceId};
use glam::DAffine3;
use std::sync::Arc;

impl SceneBvh {
    /// The hierarchy of the scene with objects moved, each by a transform: [`Scene::with_moved`](crate::scene::Scene::with_moved) says what
    /// scene that is. This hierarchy stays as it is.
    ///
    /// Views are exactly those of the scene built anew. The tree of boxes is kept and fitted to what is in the boxes now, and only solids
    /// with pieces that moved, come to or left them are proved again: time in proportion to what moves, and for going
    /// through what there is. The farther objects move from what they share boxes with, the looser the boxes are, and the longer a
    /// view takes: [`SceneBvh::looseness`] tells how loose.
    ///
    /// ```
    /// use glam::{DAffine3, DVec3};
    /// use nusselt::bvh::SceneBvh;
    /// use nusselt::contour::{Domain, Viewpoint};
    /// use nusselt::samples::{Kind, generate};
    ///
    /// let room = SceneBvh::build(&generate(Kind::Room, 300, 1)?.to_builder().build()?);
    /// let scene = room.scene();
    /// let table = scene.polygons().find(|polygon| polygon.object_name() == "table_1").ok_or("a room has tables")?.object();
    ///
    /// let pushed = room.moved(&[(table, DAffine3::from_translation(DVec3::new(0.25, 0.0, 0.0)))])?;
    /// let image = pushed.view(&Viewpoint::free(DVec3::new(0.5, 0.5, 2.0)), &Domain::Sphere)?;
    /// assert_eq!(image.scene().polygon_count(), scene.polygon_count());
    /// assert!(pushed.looseness() < 1.5, "boxes are about as tight as before");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`Scene::with_moved`](crate::scene::Scene::with_moved).
    pub fn moved(&self, moves: &[(ObjectId, DAffine3)]) -> Result<Self, MoveError> {
        let old = &*self.hierarchy;
        let (scene, carried) = old.scene.carried_over(moves)?;
        if old.order.is_empty() {
            return Ok(Self::build(&scene));
        }
        let skeleton = old.skeleton.moved(&scene, &carried);
        let bounds = bounds_of_pieces(&scene, &skeleton);
        let solids = old.solids.moved(&scene, &skeleton, &bounds, &carried.pieces);
        let places = refit::places(&old.scene, &scene);
        let held = |panel: u32, found: &mut Vec<PieceId>| {
            old.panels.pieces(panel, &mut Vec::new(), |piece| found.push(piece));
        };
        let (mut nodes, groups) = refit::refit(&old.nodes, &old.order, held, &places);
        let groups: Vec<&[PieceId]> = groups.iter().map(Vec::as_slice).collect();
        let (panels, groups) =
            Panels::of(&scene, &skeleton, &groups, MOST_PIECES, |a, b| solids.are_hidden_together(a, b));
        let order = refit::fit(&mut nodes, &groups, |panel| panels.panel(panel).bounds);
        let hierarchy = Hierarchy { scene, skeleton, nodes, panels, order, solids, built_cost: old.built_cost };
        Ok(Self { hierarchy: Arc::new(hierarchy) })
    }

    /// How much looser the boxes are than when they were built, by the surface-area heuristic: 1 then, 2 if the boxes have about twice the
    /// surface that they had, for what is in them. [`SceneBvh::tightened`] makes them tight again.
    ///
    /// It is an estimate of what views cost, of the whole scene whatever is seen. 1 also where there is nothing, and where surfaces overflow.
    pub fn looseness(&self) -> f64 {
        let Hierarchy { scene, nodes, panels, order, built_cost, .. } = &*self.hierarchy;
        let ratio = refit::cost(panels, nodes, order, scene.piece_count()) / built_cost;
        if ratio.is_finite() { ratio } else { 1.0 }
    }

    /// The same hierarchy with the panels and boxes built anew: `n log n` time, but less than [`SceneBvh::build`] takes, as planes, lines and solids
    /// are known.
    #[must_use]
    pub fn tightened(self) -> Self {
        let Hierarchy { scene, skeleton, solids, .. } = Arc::unwrap_or_clone(self.hierarchy);
        Self { hierarchy: Arc::new(Hierarchy::new(scene, skeleton, solids)) }
    }
}
