//! A hierarchy of boxes around the pieces of a scene: the second way to a contour image, without cutting polygons.
//!
//! The report (Jacob 1995) takes exact front-to-back order from a 3D BSP, at the price of polygons that it cuts. Here
//! whole pieces come roughly from near to far, neighbours in one plane together, and exact depth is decided where two of them meet in the image: see
//! [`SceneBvh::view`]. Both ways give the same labelled subdivision of the directions.

mod build;
mod moved;
mod panels;
mod refit;
mod solids;

use crate::bsp::{Bounds, PointId, Skeleton};
use crate::scene::{PieceId, PieceRef, Scene, Side, VertexId};
use glam::DVec3;
use panels::Panels;
pub(crate) use panels::{Panel, Parts, vertex};
use solids::Solids;
use std::ops::Range;
use std::sync::Arc;

/// A box around pieces.
#[derive(Clone, Debug)]
pub(crate) struct BvhNode {
    pub(crate) bounds: Bounds,
    pub(crate) content: Content,
}

#[derive(Clone, Debug)]
pub(crate) enum Content {
    /// The numbers of two boxes.
    Boxes([u32; 2]),
    /// Places in [`Hierarchy::order`].
    Panels(Range<u32>),
}

#[derive(Clone, Debug)]
pub(crate) struct Hierarchy {
    pub(crate) scene: Scene,
    pub(crate) skeleton: Skeleton,
    /// The root is the first.
    pub(crate) nodes: Vec<BvhNode>,
    pub(crate) panels: Panels,
    /// The panels that are no half of another one, in the order of the boxes that hold them.
    pub(crate) order: Vec<u32>,
    solids: Solids,
    /// What the boxes cost when they were made: see [`refit::cost`].
    built_cost: f64,
}

/// The hierarchy of boxes of a scene. Cloning it is cheap: clones share their data.
#[derive(Clone, Debug)]
pub struct SceneBvh {
    pub(crate) hierarchy: Arc<Hierarchy>,
}

impl SceneBvh {
    /// Builds the hierarchy of a scene: about `n log n` time for `n` polygons, by the surface-area heuristic
    /// (Goldsmith and Salmon 1987) in bins (Wald 2007).
    #[must_use]
    pub fn build(scene: &Scene) -> Self {
        let skeleton = Skeleton::new(scene);
        let bounds = bounds_of_pieces(scene, &skeleton);
        let solids = Solids::of(scene, &skeleton, &bounds);
        Self { hierarchy: Arc::new(Hierarchy::new(scene.clone(), skeleton, solids)) }
    }

    /// The scene it was built for.
    pub fn scene(&self) -> &Scene {
        &self.hierarchy.scene
    }

    /// The number of boxes.
    pub fn node_count(&self) -> usize {
        self.hierarchy.nodes.len()
    }

    /// The number of polygons that are proved to be part of the surface of a solid: of these, a view leaves out the sides that face the
    /// inside when the eye is certainly outside.
    pub fn solid_pieces(&self) -> usize {
        self.hierarchy.solids.piece_count()
    }
}

/// The boxes around all pieces.
fn bounds_of_pieces(scene: &Scene, skeleton: &Skeleton) -> Vec<Bounds> {
    let vertex = |&vertex: &VertexId| skeleton.approx_point(PointId(vertex.0));
    scene.pieces().map(|piece| Bounds::around(piece.vertices().iter().map(vertex))).collect()
}

impl Hierarchy {
    /// Panels and boxes for all pieces.
    fn new(scene: Scene, skeleton: Skeleton, solids: Solids) -> Self {
        let pieces: Vec<PieceId> = scene.pieces().map(PieceRef::id).collect();
        let (panels, roots) = Panels::of(&scene, &skeleton, &[&pieces], |a, b| solids.are_hidden_together(a, b));
        let roots = roots.into_iter().flatten().collect();
        let (nodes, order) = build::boxes(roots, |panel| panels.panel(panel).bounds);
        let built_cost = refit::cost(&panels, &nodes, &order, scene.piece_count());
        Self { scene, skeleton, nodes, panels, order, solids, built_cost }
    }

    /// For each solid, whether the eye is certainly outside of it.
    pub(crate) fn solids_seen_from_outside(&self, eye: DVec3) -> Vec<bool> {
        self.solids.seen_from_outside(eye)
    }

    /// True if that side of the piece is the inside of a solid that is seen from outside.
    pub(crate) fn is_inside(&self, piece: PieceId, shown: Side, from_outside: &[bool]) -> bool {
        self.solids.is_inside(piece, shown, from_outside)
    }
}
