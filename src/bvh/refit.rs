//! Boxes of pieces that have moved: the tree stays, and what it holds is fitted anew.

use super::panels::Panels;
use super::{BvhNode, Content};
use crate::bsp::Bounds;
use crate::scene::{PieceId, Scene};
use std::ops::Range;

/// For each piece of a scene before a move the pieces after it that take its place in the boxes: together they are all, in order.
///
/// The pieces of a polygon follow each other, and the last one before takes all that are left. Those of a polygon that had none go
/// with the polygon before it.
pub(super) fn places(before: &Scene, after: &Scene) -> Vec<Range<u32>> {
    let mut places: Vec<Range<u32>> = Vec::with_capacity(before.piece_count());
    let mut next = 0;
    for (old, new) in before.polygons().zip(after.polygons()) {
        let end = next + new.pieces().len() as u32;
        for _ in old.pieces() {
            places.push(next..(next + 1).min(end));
            next = (next + 1).min(end);
        }
        if let Some(last) = places.last_mut() {
            last.end = end;
        }
        next = end;
    }
    if let Some(first) = places.first_mut() {
        first.start = 0;
    }
    places
}

/// The boxes, their bounds not known yet, with the pieces that take the places of those before, which panels held: for each box that holds some its content is a
/// range of groups, which is the one group of its own. Boxes that nothing is left of are left out.
pub(super) fn refit(
    nodes: &[BvhNode],
    order: &[u32],
    held: impl Fn(u32, &mut Vec<PieceId>),
    places: &[Range<u32>],
) -> (Vec<BvhNode>, Vec<Vec<PieceId>>) {
    let pieces = |range: &Range<u32>| {
        let mut before = Vec::new();
        for &panel in &order[range.start as usize..range.end as usize] {
            held(panel, &mut before);
        }
        before.into_iter().flat_map(|piece| places[piece.index()].clone().map(PieceId)).collect::<Vec<_>>()
    };
    // Boxes within a box come after it.
    let mut is_empty = vec![true; nodes.len()];
    for (k, node) in nodes.iter().enumerate().rev() {
        is_empty[k] = match &node.content {
            Content::Boxes(boxes) => boxes.iter().all(|&k| is_empty[k as usize]),
            Content::Panels(range) => pieces(range).is_empty(),
        };
    }
    // The outermost box around the same pieces as box `k` that holds pieces or two boxes with some.
    let essential = |mut k: u32| loop {
        match nodes[k as usize].content {
            Content::Boxes([a, b]) if is_empty[a as usize] => k = b,
            Content::Boxes([a, b]) if is_empty[b as usize] => k = a,
            _ => return k,
        }
    };
    let mut from = if is_empty.first() == Some(&false) { vec![essential(0)] } else { Vec::new() };
    let mut new_nodes = Vec::with_capacity(nodes.len());
    let mut groups = Vec::new();
    while let Some(&k) = from.get(new_nodes.len()) {
        let content = match &nodes[k as usize].content {
            Content::Panels(range) => {
                groups.push(pieces(range));
                Content::Panels(groups.len() as u32 - 1..groups.len() as u32)
            }
            Content::Boxes(boxes) => {
                let first = from.len() as u32;
                from.extend(boxes.map(essential));
                Content::Boxes([first, first + 1])
            }
        };
        new_nodes.push(BvhNode { bounds: Bounds::EMPTY, content });
    }
    (new_nodes, groups)
}

/// Gives boxes that hold groups of panels their bounds, and the panels an order.
pub(super) fn fit(nodes: &mut [BvhNode], groups: &[Vec<u32>], bounds: impl Fn(u32) -> Bounds) -> Vec<u32> {
    let mut order = Vec::new();
    for k in (0..nodes.len()).rev() {
        nodes[k].bounds = match nodes[k].content.clone() {
            Content::Boxes([a, b]) => nodes[a as usize].bounds.union(nodes[b as usize].bounds),
            Content::Panels(group) => {
                let group = &groups[group.start as usize];
                let start = order.len() as u32;
                order.extend(group);
                nodes[k].content = Content::Panels(start..order.len() as u32);
                group.iter().fold(Bounds::EMPTY, |all, &panel| all.union(bounds(panel)))
            }
        };
    }
    order
}

/// What a tree of boxes costs by the surface-area heuristic: the surface of all boxes, those of pieces once for each piece, over that of the
/// pieces' own boxes. Not finite where surfaces overflow or vanish.
pub(super) fn cost(panels: &Panels, nodes: &[BvhNode], order: &[u32], piece_count: usize) -> f64 {
    let unit = nodes.first().map_or(0.0, |root| root.bounds.extent());
    let weighed = nodes.iter().map(|node| {
        let times = match &node.content {
            Content::Boxes(_) => 1,
            Content::Panels(range) => {
                let held = &order[range.start as usize..range.end as usize];
                held.iter().map(|&panel| panels.panel(panel).piece_count()).sum()
            }
        };
        node.bounds.half_area(unit) * f64::from(times)
    });
    let own = (0..piece_count as u32).map(|piece| panels.panel(piece).bounds.half_area(unit));
    weighed.sum::<f64>() / own.sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::super::build::boxes;
    use super::*;
    use glam::DVec3;
    use proptest::prelude::*;

    fn unit_box(x: f64) -> Bounds {
        Bounds { low: DVec3::new(x, 0.0, 0.0), high: DVec3::new(x + 1.0, 1.0, 1.0) }
    }

    proptest! {
        #[test]
        fn every_piece_is_in_one_tight_box_whatever_is_left(
            counts in prop::collection::vec(0u32..4, 1..40), shuffle in any::<u64>(),
        ) {
            let place = |k: usize| ((k as u64).wrapping_mul(shuffle | 1) % 101) as f64;
            let before: Vec<_> = (0..counts.len()).map(|k| unit_box(place(k))).collect();
            let (nodes, order) = boxes((0..counts.len() as u32).collect(), |k| before[k as usize]);
            let mut next = 0;
            let places: Vec<_> = counts.iter().map(|&n| { next += n; next - n..next }).collect();
            let bounds: Vec<_> = (0..next as usize).map(|k| unit_box(place(k + 7))).collect();
            let (mut nodes, groups) = refit(&nodes, &order, |panel, found| found.push(PieceId(panel)), &places);
            let groups: Vec<Vec<u32>> = groups.iter().map(|pieces| pieces.iter().map(|piece| piece.0).collect()).collect();
            let order = fit(&mut nodes, &groups, |piece| bounds[piece as usize]);
            let mut sorted = order.clone();
            sorted.sort_unstable();
            prop_assert_eq!(sorted, (0..next).collect::<Vec<_>>());
            let mut seen = vec![0; nodes.len()];
            let mut held = 0;
            for node in &nodes {
                let inside = match &node.content {
                    Content::Boxes(within) => {
                        for &k in within {
                            seen[k as usize] += 1;
                        }
                        within.map(|k| nodes[k as usize].bounds).to_vec()
                    }
                    Content::Panels(range) => {
                        prop_assert!(!range.is_empty());
                        held += range.len();
                        order[range.start as usize..range.end as usize].iter().map(|&p| bounds[p as usize]).collect()
                    }
                };
                prop_assert_eq!(node.bounds, inside.into_iter().fold(Bounds::EMPTY, Bounds::union));
            }
            prop_assert_eq!(held, bounds.len());
            prop_assert!(seen.iter().skip(1).all(|&n| n == 1) && seen.first().is_none_or(|&n| n == 0));
        }
    }
}
