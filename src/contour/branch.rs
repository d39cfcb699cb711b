//! The contour tree, part by part.

use super::image::{Cell, ContourImage};
use super::tree::Link;
use crate::scene::Splitter;
use glam::DVec3;

/// A part of the contour tree, the 2D BSP on the sphere of directions: a convex region and how it is divided.
#[derive(Clone, Copy, Debug)]
pub struct Branch<'a> {
    image: &'a ContourImage,
    link: Link,
}

/// What a [`Branch`] consists of.
#[derive(Clone, Copy, Debug)]
pub enum BranchKind<'a> {
    /// Nothing but a cell.
    Cell(Cell<'a>),
    /// Nothing: it is not part of the domain.
    Outside,
    /// Two parts on the sides of a great circle.
    Node {
        /// The exact definition of the circle.
        splitter: Splitter,
        /// The normal of its plane as a unit vector, rounded.
        normal: DVec3,
        /// What is where `normal . d < 0`.
        negative: Branch<'a>,
        /// What is where `normal . d > 0`.
        positive: Branch<'a>,
    },
}

impl ContourImage {
    /// The contour tree. Point location ([`ContourImage::locate`]) goes down it exactly; this shows how it is built.
    pub fn tree(&self) -> Branch<'_> {
        Branch { image: self, link: self.root() }
    }
}

impl<'a> Branch<'a> {
    /// The image whose tree it is a part of.
    pub fn image(self) -> &'a ContourImage {
        self.image
    }

    /// How it is divided.
    pub fn kind(self) -> BranchKind<'a> {
        let Self { image, link } = self;
        match link {
            Link::Leaf(leaf) => {
                image.cell_of_leaf[leaf as usize].map_or(BranchKind::Outside, |id| BranchKind::Cell(image.cell(id)))
            }
            Link::Node(node) => {
                let node = &image.tree.nodes[node as usize];
                let directions = &image.tree.directions;
                let [negative, positive] = [node.negative(), node.positive()].map(|link| Self { image, link });
                BranchKind::Node {
                    splitter: directions.splitter(image.skeleton(), node.circle),
                    normal: directions.normal(node.circle).v.normalize_or_zero(),
                    negative,
                    positive,
                }
            }
        }
    }
}
