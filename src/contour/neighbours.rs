//! Which cells lie across the sides of a cell.

use super::directions::{Directions, ExactCache, LooseDirection};
use super::image::{Cell, CellId};
use super::polygon::HalfSphere;
use super::tree::{Link, TreeNode};
use crate::bsp::Skeleton;
use crate::exact::Sign;

/// A cell across a side of another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Neighbour {
    /// The number of the side: it leads from corner `side` to the next one.
    pub side: usize,
    /// The cell across; `None` where the domain ends.
    pub cell: Option<CellId>,
}

impl Cell<'_> {
    /// The cells that share a stretch, not just a point, with each of its sides; ascending by side and
    /// number. The cost is that of sending each side down the contour tree.
    pub fn neighbours(self) -> Vec<Neighbour> {
        let image = self.image();
        let skeleton = image.skeleton();
        let directions = &image.tree.directions;
        let mut across = Across { skeleton, directions, cache: ExactCache::default() };
        let arcs = self.arcs();
        let corners: Vec<LooseDirection> = arcs.iter().map(|arc| directions.direction(arc.from)).collect();
        let mut found = Vec::new();
        for (side, arc) in arcs.iter().enumerate() {
            let mut stack = vec![(image.root(), [corners[side], corners[(side + 1) % arcs.len()]])];
            while let Some((link, ends)) = stack.pop() {
                match link {
                    Link::Leaf(leaf) => {
                        found.push(Neighbour { side, cell: image.cell_of_leaf[leaf as usize] });
                    }
                    Link::Node(node) => {
                        let node = &image.tree.nodes[node as usize];
                        across.descend(node, arc.along, ends, &corners, &mut stack);
                    }
                }
            }
        }
        found.sort_unstable();
        found.dedup();
        found
    }
}

struct Across<'a> {
    skeleton: &'a Skeleton,
    directions: &'a Directions,
    cache: ExactCache,
}

impl Across<'_> {
    fn descend(
        &mut self,
        node: &TreeNode,
        along: HalfSphere,
        [from, to]: [LooseDirection; 2],
        corners: &[LooseDirection],
        stack: &mut Vec<(Link, [LooseDirection; 2])>,
    ) {
        let mut side = |d| self.directions.side_of(self.skeleton, d, node.circle, &mut self.cache);
        let (here, there) = (side(&from), side(&to));
        match (here, there) {
            (Sign::Zero, Sign::Zero) => {
                // The side runs along the node's circle: on across it. A corner off the circle tells
                // on which side of it the cell is.
                let own = corners.iter().map(side).find(|s| !s.is_zero());
                match own {
                    Some(Sign::Positive) => stack.push((node.negative(), [from, to])),
                    Some(_) => stack.push((node.positive(), [from, to])),
                    None => {}
                }
            }
            (Sign::Positive | Sign::Zero, Sign::Positive | Sign::Zero) => stack.push((node.positive(), [from, to])),
            (Sign::Negative | Sign::Zero, Sign::Negative | Sign::Zero) => stack.push((node.negative(), [from, to])),
            _ => {
                let reversed = along.inside() * here == Sign::Negative;
                let circles = [along.circle(), node.circle];
                let middle = self.directions.crossing(self.skeleton, circles, reversed, &mut self.cache);
                let (first, second) = if here.is_positive() {
                    (node.positive(), node.negative())
                } else {
                    (node.negative(), node.positive())
                };
                stack.push((first, [from, middle]));
                stack.push((second, [middle, to]));
            }
        }
    }
}
