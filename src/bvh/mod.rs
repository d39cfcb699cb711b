//! A hierarchy of boxes around the pieces of a scene: the second way to a contour image, without cutting polygons.
//!
//! The report (Jacob 1995) takes exact front-to-back order from a 3D BSP, at the price of polygons that it cuts. Here
//! whole pieces come roughly from near to far, and exact depth is decided where two of them meet in the image: see
//! [`SceneBvh::view`]. Both ways give the same labelled subdivision of the directions.

mod build;
mod moved;
mod refit;
mod solids;

use crate::bsp::{Bounds, FragmentSide, Skeleton, bounds_of, whole_piece};
use crate::scene::{PieceId, Scene, Side};
use glam::DVec3;
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
    Pieces(Range<u32>),
}

#[derive(Clone, Debug)]
pub(crate) struct Hierarchy {
    pub(crate) scene: Scene,
    pub(crate) skeleton: Skeleton,
    /// The root is the first.
    pub(crate) nodes: Vec<BvhNode>,
    /// The pieces in the order of the boxes that hold them.
    pub(crate) order: Vec<PieceId>,
    pub(crate) bounds: Vec<Bounds>,
    sides: Vec<FragmentSide>,
    sides_start: Vec<u32>,
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
        let Boundaries { sides, sides_start, bounds } = Boundaries::of(scene, &skeleton);
        let (nodes, order) = build::boxes(&bounds);
        let solids = Solids::of(scene, &skeleton, &bounds);
        let built_cost = refit::cost(&nodes, &bounds);
        let scene = scene.clone();
        let hierarchy = Hierarchy { scene, skeleton, nodes, order, bounds, sides, sides_start, solids, built_cost };
        Self { hierarchy: Arc::new(hierarchy) }
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

/// The boundaries of all pieces, one after the other, where each begins, and the boxes around them.
struct Boundaries {
    sides: Vec<FragmentSide>,
    sides_start: Vec<u32>,
    bounds: Vec<Bounds>,
}

impl Boundaries {
    fn of(scene: &Scene, skeleton: &Skeleton) -> Self {
        let bounds = Vec::with_capacity(scene.piece_count());
        let mut all = Self { sides: Vec::new(), sides_start: vec![0], bounds };
        for piece in scene.pieces() {
            let start = all.sides.len();
            all.sides.extend(whole_piece(scene, piece.id()));
            all.bounds.push(bounds_of(skeleton, &all.sides[start..]));
            all.sides_start.push(all.sides.len() as u32);
        }
        all
    }
}

impl Hierarchy {
    /// The boundary of a piece.
    pub(crate) fn sides(&self, piece: PieceId) -> &[FragmentSide] {
        let [start, end] = [0, 1].map(|k| self.sides_start[piece.index() + k] as usize);
        &self.sides[start..end]
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
