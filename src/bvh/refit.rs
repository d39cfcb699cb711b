//! Boxes of pieces that have moved: the tree stays, and what it holds is fitted anew.

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

/// The boxes with the pieces that take the places of those before, which have these boxes. Boxes that nothing is left of are left out.
pub(super) fn refit(
    nodes: &[BvhNode],
    order: &[PieceId],
    places: &[Range<u32>],
    bounds: &[Bounds],
) -> (Vec<BvhNode>, Vec<PieceId>) {
    let mut new_order = Vec::with_capacity(bounds.len());
    let mut starts = vec![0];
    for piece in order {
        new_order.extend(places[piece.index()].clone().map(PieceId));
        starts.push(new_order.len() as u32);
    }
    let pieces = |range: &Range<u32>| starts[range.start as usize]..starts[range.end as usize];
    // Boxes within a box come after it.
    let mut is_empty = vec![true; nodes.len()];
    for (k, node) in nodes.iter().enumerate().rev() {
        is_empty[k] = match &node.content {
            Content::Boxes(boxes) => boxes.iter().all(|&k| is_empty[k as usize]),
            Content::Pieces(range) => pieces(range).is_empty(),
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
    while let Some(&k) = from.get(new_nodes.len()) {
        let content = match &nodes[k as usize].content {
            Content::Pieces(range) => Content::Pieces(pieces(range)),
            Content::Boxes(boxes) => {
                let first = from.len() as u32;
                from.extend(boxes.map(essential));
                Content::Boxes([first, first + 1])
            }
        };
        new_nodes.push(BvhNode { bounds: Bounds::EMPTY, content });
    }
    for k in (0..new_nodes.len()).rev() {
        new_nodes[k].bounds = match &new_nodes[k].content {
            Content::Boxes([a, b]) => new_nodes[*a as usize].bounds.union(new_nodes[*b as usize].bounds),
            Content::Pieces(range) => new_order[range.start as usize..range.end as usize]
                .iter()
                .fold(Bounds::EMPTY, |all, piece: &PieceId| all.union(bounds[piece.index()])),
        };
    }
    (new_nodes, new_order)
}

/// What a tree of boxes costs by the surface-area heuristic: the surface of all boxes, those of pieces once for each piece, over that of the
/// pieces' own boxes. Not finite where surfaces overflow or vanish.
pub(super) fn cost(nodes: &[BvhNode], bounds: &[Bounds]) -> f64 {
    let unit = nodes.first().map_or(0.0, |root| root.bounds.extent());
    let weighed = nodes.iter().map(|node| {
        let times = match &node.content {
            Content::Boxes(_) => 1.0,
            Content::Pieces(range) => range.len() as f64,
        };
        node.bounds.half_area(unit) * times
    });
    weighed.sum::<f64>() / bounds.iter().map(|bounds| bounds.half_area(unit)).sum::<f64>()
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
            let (nodes, order) = boxes(&before);
            let mut next = 0;
            let places: Vec<_> = counts.iter().map(|&n| { next += n; next - n..next }).collect();
            let bounds: Vec<_> = (0..next as usize).map(|k| unit_box(place(k + 7))).collect();
            let (nodes, order) = refit(&nodes, &order, &places, &bounds);
            let mut sorted = order.clone();
            sorted.sort_unstable();
            prop_assert_eq!(sorted, (0..next).map(PieceId).collect::<Vec<_>>());
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
                    Content::Pieces(range) => {
                        prop_assert!(!range.is_empty());
                        held += range.len();
                        order[range.start as usize..range.end as usize].iter().map(|p| bounds[p.index()]).collect()
                    }
                };
                prop_assert_eq!(node.bounds, inside.into_iter().fold(Bounds::EMPTY, Bounds::union));
            }
            prop_assert_eq!(held, bounds.len());
            prop_assert!(seen.iter().skip(1).all(|&n| n == 1) && seen.first().is_none_or(|&n| n == 0));
        }
    }
}
