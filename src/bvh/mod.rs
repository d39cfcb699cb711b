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

pub(crate) use build::boxes;

use crate::bsp::{Bounds, PointId, Skeleton};
use crate::scene::{PieceId, PieceRef, Scene, Side, VertexId};
use glam::DVec3;
use panels::{MOST_PIECES, Panels};
pub(crate) use panels::{Panel, Parts, vertex};
pub(crate) use solids::Solid;
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

/// A convex polygon that pieces of one plane make up together, turned one way.
pub(crate) struct Facet {
    /// The pieces, ascending.
    pub(crate) pieces: Vec<PieceId>,
    /// Its corners, counter-clockwise seen from its front.
    pub(crate) ring: Vec<VertexId>,
    /// The solid that all of it is part of.
    pub(crate) solid: Option<Solid>,
}

/// The pieces of a scene joined to facets as large as that goes, of pieces that may be joined; ascending by their first pieces.
pub(crate) fn facets(scene: &Scene, may_join: impl Fn(PieceId, PieceId) -> bool) -> Vec<Facet> {
    let skeleton = Skeleton::new(scene);
    let solids = Solids::of(scene, &skeleton, &bounds_of_pieces(scene, &skeleton));
    let all: Vec<PieceId> = scene.pieces().map(PieceRef::id).collect();
    let may_join = |a, b| may_join(a, b) && solids.are_hidden_together(a, b);
    let (panels, roots) = Panels::of(scene, &skeleton, &[&all], u32::MAX, may_join);
    let facet = |&panel: &u32| {
        let mut pieces = Vec::new();
        panels.pieces(panel, &mut Vec::new(), |piece| pieces.push(piece));
        pieces.sort_unstable();
        let ring = panels.sides(panel).iter().map(|side| vertex(side.point)).collect();
        Facet { solid: solids.solid_of(pieces[0]), pieces, ring }
    };
    let mut facets: Vec<Facet> = roots.iter().flatten().map(facet).collect();
    facets.sort_unstable_by_key(|facet| facet.pieces[0]);
    facets
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
        let (panels, roots) =
            Panels::of(&scene, &skeleton, &[&pieces], MOST_PIECES, |a, b| solids.are_hidden_together(a, b));
        let roots = roots.into_iter().flatten().collect();
        let (nodes, order) = boxes(roots, |panel| panels.panel(panel).bounds);
        let built_cost = refit::cost(&panels, &nodes, &order, scene.piece_count());
        Self { scene, skeleton, nodes, panels, order, solids, built_cost }
    }

    /// True if that side of the piece is the inside of a solid that the eye is certainly outside of.
    pub(crate) fn is_inside(&self, piece: PieceId, shown: Side, eye: DVec3) -> bool {
        self.solids.is_inside(piece, shown, eye)
    }
}
