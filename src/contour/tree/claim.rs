//! Cutting a domain out of the sphere: convex polygons claim their inside, and what none has claimed is left outside.
//!
//! A polygon that comes later claims only what is still free: the domain is the union, in convex leaves that do not overlap.

use super::{ContourTree, Filler, Leaf, LeafState, Verdict, Workspace};
use crate::bsp::Skeleton;
use crate::contour::polygon::PolygonArc;
use crate::exact::SeenBox;
use crate::scene::PieceId;

/// What claimed leaves are filled with until [`ContourTree::keep_claimed`].
const CLAIMED: PieceId = PieceId(u32::MAX);

impl ContourTree {
    /// Claims what is free of the inside of a convex spherical polygon. All of it is within the projection of `seen`.
    pub(crate) fn claim(&mut self, skeleton: &Skeleton, polygon: &[PolygonArc], seen: &SeenBox, work: &mut Workspace) {
        let filler = Filler { piece: CLAIMED, near: 0.0, far: 0.0, plane: None };
        self.insert(skeleton, self.root, polygon, seen, &filler, |_, _, _, _| Verdict::Behind, work);
    }

    /// Leaves what was claimed open and everything else outside.
    pub(crate) fn keep_claimed(&mut self) {
        for leaf in &mut self.leaves {
            let (state, far) = match leaf.state {
                LeafState::Filled(_) => (LeafState::Open, f64::INFINITY),
                LeafState::Open | LeafState::Outside => (LeafState::Outside, 0.0),
            };
            *leaf = Leaf { state, far, ..*leaf };
        }
        // Children have higher numbers than their parents.
        for k in (0..self.nodes.len()).rev() {
            let (negative, positive) = (self.nodes[k].negative(), self.nodes[k].positive());
            self.nodes[k].far = self.link_far(negative).max(self.link_far(positive));
        }
    }
}
