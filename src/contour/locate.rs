//! Exact point location: which cell a direction lies in.

use super::directions::ExactCache;
use super::image::{CellId, ContourImage};
use super::tree::Link;
use crate::exact::Sign;
use glam::DVec3;

/// Where a direction lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Location {
    /// Inside of a cell.
    Cell(CellId),
    /// Exactly on a great circle that separates regions of the contour tree.
    Boundary,
    /// Not in the domain.
    Outside,
}

impl ContourImage {
    /// Finds the cell that a direction, taken exactly as its three numbers are, lies in. The cost is the
    /// depth of the contour tree.
    pub fn locate(&self, direction: DVec3) -> Location {
        if !direction.is_finite() || direction == DVec3::ZERO {
            return Location::Outside;
        }
        let skeleton = &self.bsp().tree.skeleton;
        let mut cache = ExactCache::default();
        let mut link = self.root();
        while let Link::Node(node) = link {
            let node = &self.tree.nodes[node as usize];
            link = match self.tree.directions.given_side(skeleton, direction, node.circle, &mut cache) {
                Sign::Negative => node.negative,
                Sign::Zero => return Location::Boundary,
                Sign::Positive => node.positive,
            };
        }
        let Link::Leaf(leaf) = link else { return Location::Outside };
        self.cell_of_leaf[leaf as usize].map_or(Location::Outside, Location::Cell)
    }
}
