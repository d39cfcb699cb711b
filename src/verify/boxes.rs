//! A hierarchy of boxes around the pieces, so that a cell is compared only with what may be in front of it.

use crate::scene::{PieceId, Scene};
use glam::DVec3;

/// A leaf holds at most so many pieces.
const LEAF: usize = 4;

/// The two extreme corners of a box; exact, as no coordinate is computed.
pub(super) type Corners = [DVec3; 2];

#[derive(Clone, Copy, Debug)]
struct Node {
    corners: Corners,
    /// The pieces below.
    first: u32,
    end: u32,
    /// Where the second child is; the first one follows its parent. 0 for a leaf.
    second: u32,
}

/// The hierarchy.
#[derive(Debug)]
pub(super) struct PieceBoxes {
    nodes: Vec<Node>,
    pieces: Vec<(PieceId, Corners)>,
}

impl PieceBoxes {
    /// A hierarchy of those pieces: halved along the longest side until few are left.
    pub(super) fn new(scene: &Scene, pieces: impl IntoIterator<Item = PieceId>) -> Self {
        let corners = |id: PieceId| {
            let points = scene.piece(id).points();
            points.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], p| [low.min(p), high.max(p)])
        };
        let mut boxes = Self { nodes: Vec::new(), pieces: pieces.into_iter().map(|id| (id, corners(id))).collect() };
        // A node is made when its job is taken, so a first child comes right after its parent.
        let mut jobs = vec![(0, boxes.pieces.len(), None::<usize>)];
        while let Some((first, end, second_of)) = jobs.pop() {
            if first == end {
                continue;
            }
            let here = boxes.nodes.len();
            if let Some(parent) = second_of {
                boxes.nodes[parent].second = here as u32;
            }
            let part = &mut boxes.pieces[first..end];
            let corners = part.iter().fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |all, (_, own)| {
                [all[0].min(own[0]), all[1].max(own[1])]
            });
            boxes.nodes.push(Node { corners, first: first as u32, end: end as u32, second: 0 });
            if part.len() <= LEAF {
                continue;
            }
            // Halved before the sum, which could overflow. Any axis would be right.
            let size = corners[1] * 0.5 - corners[0] * 0.5;
            let axis = size.max_position();
            let middle = |own: &Corners| own[0][axis] * 0.5 + own[1][axis] * 0.5;
            let half = part.len() / 2;
            part.select_nth_unstable_by(half, |a, b| middle(&a.1).total_cmp(&middle(&b.1)).then(a.0.cmp(&b.0)));
            jobs.push((first + half, end, Some(here)));
            jobs.push((first, first + half, None));
        }
        boxes
    }

    /// Calls `visit` with every piece that no box around it is `skipped` with, until it returns an error.
    pub(super) fn visit<E>(
        &self,
        mut skipped: impl FnMut(Corners) -> bool,
        mut visit: impl FnMut(PieceId) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut stack = if self.nodes.is_empty() { Vec::new() } else { vec![0] };
        while let Some(here) = stack.pop() {
            let node = &self.nodes[here];
            if skipped(node.corners) {
                continue;
            }
            if node.second != 0 {
                stack.extend([node.second as usize, here + 1]);
                continue;
            }
            for &(piece, corners) in &self.pieces[node.first as usize..node.end as usize] {
                if !skipped(corners) {
                    visit(piece)?;
                }
            }
        }
        Ok(())
    }
}
