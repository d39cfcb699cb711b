//! The elements of a facet, halved again and again in its plane.

use super::blocker::Corner;
use super::element::Element;
use super::shape::Frame;
use glam::DVec2;
use std::ops::Range;

pub(super) struct ElementTree {
    nodes: Vec<Node>,
    /// The elements, in the order of the nodes that hold them.
    order: Vec<u32>,
}

#[derive(Clone)]
pub(super) struct Node {
    low: DVec2,
    high: DVec2,
    /// Places in the order.
    range: Range<u32>,
    /// The first of two nodes next to each other; none if it holds one element.
    halves: Option<u32>,
}

impl ElementTree {
    /// The root is node 0; there is none without elements.
    pub(super) fn of(elements: &[Element], facet: &[u32]) -> Self {
        let mut tree = Self { nodes: Vec::new(), order: facet.to_vec() };
        let node = |order: &[u32], range: Range<usize>| {
            let part = || order[range.clone()].iter().map(|&k| &elements[k as usize]);
            let low = part().fold(DVec2::INFINITY, |low, element| low.min(element.low));
            let high = part().fold(DVec2::NEG_INFINITY, |high, element| high.max(element.high));
            Node { low, high, range: range.start as u32..range.end as u32, halves: None }
        };
        if !facet.is_empty() {
            tree.nodes.push(node(&tree.order, 0..facet.len()));
        }
        let mut next = 0;
        while next < tree.nodes.len() {
            let Node { low, high, ref range, .. } = tree.nodes[next];
            let range = range.start as usize..range.end as usize;
            if range.len() > 1 {
                let size = high - low;
                let middle = |&k: &u32| {
                    let element = &elements[k as usize];
                    let middle = element.low + element.high;
                    if size.x >= size.y { middle.x } else { middle.y }
                };
                let half = range.len() / 2;
                tree.order[range.clone()]
                    .select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)).then(a.cmp(b)));
                tree.nodes[next].halves = Some(tree.nodes.len() as u32);
                let middle = range.start + half;
                for part in [range.start..middle, middle..range.end] {
                    tree.nodes.push(node(&tree.order, part));
                }
            }
            next += 1;
        }
        tree
    }

    pub(super) fn root(&self) -> Option<u32> {
        (!self.nodes.is_empty()).then_some(0)
    }

    pub(super) fn halves(&self, node: u32) -> Option<[u32; 2]> {
        self.nodes[node as usize].halves.map(|first| [first, first + 1])
    }

    pub(super) fn elements(&self, node: u32) -> &[u32] {
        let Range { start, end } = self.nodes[node as usize].range;
        &self.order[start as usize..end as usize]
    }

    /// The corners of the rectangle around a node, or of its one element.
    pub(super) fn corners(&self, node: u32, frame: &Frame, elements: &[Element], corners: &mut Vec<Corner>) {
        corners.clear();
        if let [element] = self.elements(node) {
            let Element { ring, flat, .. } = &elements[*element as usize];
            corners.extend(ring.iter().zip(flat).map(|(&at, &flat)| Corner { at, flat }));
            return;
        }
        let Node { low, high, .. } = self.nodes[node as usize];
        let rectangle = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
        corners.extend(rectangle.map(|flat| Corner { at: frame.lift(flat), flat }));
    }

    /// Calls `found` with all elements whose rectangles meet the given one.
    pub(super) fn meeting(&self, low: DVec2, high: DVec2, stack: &mut Vec<u32>, mut found: impl FnMut(u32)) {
        stack.clear();
        stack.extend(self.root());
        while let Some(number) = stack.pop() {
            let node = &self.nodes[number as usize];
            if node.low.cmple(high).all() && node.high.cmpge(low).all() {
                match node.halves {
                    Some(first) => stack.extend([first + 1, first]),
                    None => found(self.order[node.range.start as usize]),
                }
            }
        }
    }
}
