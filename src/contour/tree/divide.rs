//! Cutting a polygon along the borders of what is seen before it.

use super::{ContourTree, LeafState, Link, Workspace};
use crate::bsp::Skeleton;
use crate::contour::polygon::{PolygonArc, Sides, Span};
use crate::scene::PieceId;

/// A part of a polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Part {
    /// It is what is seen there.
    pub(crate) is_seen: bool,
    /// Its sides, in what was given for them.
    pub(crate) boundary: Span,
}

/// A polygon that is cut, in memory that is used again from one to the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct Division {
    /// The sides of the whole and of all parts.
    pub(crate) arcs: Vec<PolygonArc>,
    pub(crate) parts: Vec<Part>,
    steps: Vec<Step>,
}

/// What is left to do.
#[derive(Clone, Copy, Debug)]
enum Step {
    Go(Link, Span),
    /// All parts from number `first` on make up `whole`.
    Join {
        whole: Span,
        first: usize,
    },
}

impl ContourTree {
    /// Cuts the projection of a piece that was put in before, and in front of which there may be others: into convex parts
    /// that are seen and that are not, as few as the nodes above them allow.
    pub(crate) fn divide(
        &mut self,
        skeleton: &Skeleton,
        piece: PieceId,
        polygon: &[PolygonArc],
        division: &mut Division,
        work: &mut Workspace,
    ) {
        let Division { arcs, parts, steps } = division;
        arcs.clear();
        parts.clear();
        steps.push(Step::Go(self.root, Span::keep(polygon, arcs)));
        while let Some(step) = steps.pop() {
            let (link, boundary) = match step {
                Step::Go(link, boundary) => (link, boundary),
                Step::Join { whole, first } => {
                    let is_seen = parts[first].is_seen;
                    if parts[first..].iter().all(|part| part.is_seen == is_seen) {
                        parts.truncate(first);
                        parts.push(Part { is_seen, boundary: whole });
                    }
                    continue;
                }
            };
            let node = match link {
                Link::Node(node) => self.nodes[node as usize],
                Link::Leaf(leaf) => {
                    let is_seen = self.leaves[leaf as usize].state == LeafState::Filled(piece);
                    parts.push(Part { is_seen, boundary });
                    continue;
                }
            };
            let sides = &arcs[boundary.range()];
            if let Some(side) = sides.iter().find(|arc| arc.along.circle() == node.circle) {
                let is_positive = side.along.inside().is_positive();
                steps.push(Step::Go(if is_positive { node.positive() } else { node.negative() }, boundary));
                continue;
            }
            match work.knife.classify(skeleton, &self.directions, sides, node.circle) {
                Sides { negative: false, .. } => steps.push(Step::Go(node.positive(), boundary)),
                Sides { positive: false, .. } => steps.push(Step::Go(node.negative(), boundary)),
                Sides { .. } => {
                    let directions = &mut self.directions;
                    let cut = work.knife.cut(skeleton, directions, arcs, boundary, node.circle, |_, _, _| None);
                    steps.push(Step::Join { whole: boundary, first: parts.len() });
                    steps.extend([node.negative(), node.positive()].into_iter().zip(cut).map(|(l, b)| Step::Go(l, b)));
                }
            }
        }
    }
}
