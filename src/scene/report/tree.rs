//! A balanced tree of boxes in an array: the children of node k are 2 k + 1 and 2 k + 2.

use glam::DVec3;
use std::ops::Range;

/// A box by its least and its greatest corner.
pub(super) type Aabb = (DVec3, DVec3);

/// Items, by the boxes around them.
pub(super) struct BoxTree {
    /// The items in order of the leaves.
    order: Vec<u32>,
    /// The boxes of the nodes.
    boxes: Vec<Aabb>,
}

const LEAF: usize = 8;
const EMPTY: Aabb = (DVec3::INFINITY, DVec3::NEG_INFINITY);

/// The box around two.
pub(super) fn around((low, high): Aabb, (l, h): Aabb) -> Aabb {
    (low.min(l), high.max(h))
}

/// The box around points.
pub(super) fn bounds(points: impl Iterator<Item = DVec3>) -> Aabb {
    points.fold(EMPTY, |bounds, p| around(bounds, (p, p)))
}

impl BoxTree {
    /// Halves the items at the median of their middles, along the longest side of the box around them: n log n.
    pub(super) fn new(items: &[Aabb]) -> Self {
        let middle = |item: u32, axis: usize| {
            let (low, high) = items[item as usize];
            low[axis] * 0.5 + high[axis] * 0.5
        };
        let mut tree = Self { order: (0..items.len() as u32).collect(), boxes: Vec::new() };
        let mut jobs = vec![(0, 0..items.len())];
        while let Some((node, range)) = jobs.pop() {
            let order = &mut tree.order[range.clone()];
            let (low, high) = order.iter().fold(EMPTY, |bounds, &item| around(bounds, items[item as usize]));
            if tree.boxes.len() <= node {
                tree.boxes.resize(node + 1, EMPTY);
            }
            tree.boxes[node] = (low, high);
            if range.len() > LEAF {
                let axis = (high * 0.5 - low * 0.5).max_position();
                let half = range.len() / 2;
                order.select_nth_unstable_by(half, |&a, &b| middle(a, axis).total_cmp(&middle(b, axis)));
                jobs.extend(children(node, range));
            }
        }
        tree
    }

    /// Visits the items of all leaves whose boxes, and those of all nodes above, are let in.
    pub(super) fn visit(&self, lets_in: impl Fn(Aabb) -> bool, mut visit: impl FnMut(u32)) {
        let mut jobs = vec![(0, 0..self.order.len())];
        while let Some((node, range)) = jobs.pop() {
            if range.is_empty() || !lets_in(self.boxes[node]) {
                continue;
            }
            if range.len() > LEAF {
                jobs.extend(children(node, range));
            } else {
                self.order[range].iter().copied().for_each(&mut visit);
            }
        }
    }
}

fn children(node: usize, range: Range<usize>) -> [(usize, Range<usize>); 2] {
    let half = range.start + range.len() / 2;
    [(2 * node + 1, range.start..half), (2 * node + 2, half..range.end)]
}
