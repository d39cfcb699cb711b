//! A hierarchy of boxes around the pieces, so that a cell is compared only with what may be in front of it.

use crate::scene::{PieceId, PieceRef};
use glam::DVec3;

/// A leaf holds at most so many pieces.
const LEAF: usize = 4;

/// The two extreme corners of a box; exact, as no coordinate is computed.
pub(super) type Corners = [DVec3; 2];

/// The box around a piece.
pub(super) fn corners_of(piece: PieceRef<'_>) -> Corners {
    piece.points().fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], p| [low.min(p), high.max(p)])
}

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
    /// A hierarchy of those pieces with boxes around them, each node cut where the areas of its parts, times what they hold, are least.
    pub(super) fn new(pieces: Vec<(PieceId, Corners)>) -> Self {
        let mut boxes = Self { nodes: Vec::new(), pieces };
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
            let corners = part
                .iter()
                .fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |all, (_, own)| [all[0].min(own[0]), all[1].max(own[1])]);
            boxes.nodes.push(Node { corners, first: first as u32, end: end as u32, second: 0 });
            if part.len() <= LEAF {
                continue;
            }
            let half = cheapest_cut(part).unwrap_or_else(|| {
                // Boxes about one point, or so large that their areas overflow.
                let half = part.len() / 2;
                part.select_nth_unstable_by_key(half, |piece| piece.0);
                half
            });
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

/// The number of places between which a cut is sought, for each axis.
const BINS: usize = 12;

/// Half the area of a box.
fn half_area([low, high]: Corners) -> f64 {
    let d = (high - low).max(DVec3::ZERO);
    d.x * d.y + d.y * d.z + d.z * d.x
}

fn union(a: Corners, b: Corners) -> Corners {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// Parts pieces in two by the middle of their boxes along the axis on which those are furthest apart, where that is cheapest
/// (Goldsmith and Salmon 1987, with bins as Wald 2007); gives the size of the first part, or `None` if no such cut leaves
/// something on both sides.
fn cheapest_cut(part: &mut [(PieceId, Corners)]) -> Option<usize> {
    const NOWHERE: Corners = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    // Halved before the sum, which could overflow.
    let middle = |own: &Corners| own[0] * 0.5 + own[1] * 0.5;
    let [low, high] = part.iter().fold(NOWHERE, |all, (_, own)| union(all, [middle(own); 2]));
    let size = high - low;
    let axis = size.max_position();
    if !(size[axis] > 0.0 && size[axis].is_finite()) {
        return None;
    }
    let bin = |own: &Corners| (((middle(own)[axis] - low[axis]) / size[axis] * BINS as f64) as usize).min(BINS - 1);
    let mut bins = [(0, NOWHERE); BINS];
    for (_, own) in &*part {
        let bin = &mut bins[bin(own)];
        *bin = (bin.0 + 1, union(bin.1, *own));
    }
    let mut behind = [0.0; BINS];
    let mut all = (0, NOWHERE);
    for k in (1..BINS).rev() {
        all = (all.0 + bins[k].0, union(all.1, bins[k].1));
        behind[k] = if all.0 == 0 { f64::INFINITY } else { f64::from(all.0) * half_area(all.1) };
    }
    let mut before = (0, NOWHERE);
    let mut best = (f64::INFINITY, 0);
    for k in 1..BINS {
        before = (before.0 + bins[k - 1].0, union(before.1, bins[k - 1].1));
        let cost = f64::from(before.0) * half_area(before.1) + behind[k];
        if before.0 > 0 && cost < best.0 {
            best = (cost, k);
        }
    }
    let (_, cut) = best;
    if cut == 0 {
        return None;
    }
    let mut first = 0;
    for k in 0..part.len() {
        if bin(&part[k].1) < cut {
            part.swap(first, k);
            first += 1;
        }
    }
    Some(first)
}
