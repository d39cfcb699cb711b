//! The boxes: halved at the best of a few places, by the surface-area heuristic.

use super::{BvhNode, Content};
use crate::bsp::Bounds;
use glam::DVec3;

/// Boxes of this many panels are not halved.
const LEAF: usize = 4;
/// Places that are tried along the longest axis.
const BINS: usize = 16;

/// The boxes around panels, and the order of the panels in them. None without panels.
pub(crate) fn boxes(mut order: Vec<u32>, bounds: impl Fn(u32) -> Bounds) -> (Vec<BvhNode>, Vec<u32>) {
    let mut nodes = Vec::new();
    if !order.is_empty() {
        nodes.push(BvhNode { bounds: Bounds::EMPTY, content: Content::Panels(0..order.len() as u32) });
    }
    let mut next = 0;
    while next < nodes.len() {
        let Content::Panels(range) = nodes[next].content.clone() else { unreachable!("not halved yet") };
        let part = &mut order[range.start as usize..range.end as usize];
        nodes[next].bounds = union(&bounds, part);
        if part.len() > LEAF {
            let middle = range.start + halve(&bounds, part) as u32;
            let first = nodes.len() as u32;
            nodes[next].content = Content::Boxes([first, first + 1]);
            for content in [range.start..middle, middle..range.end] {
                nodes.push(BvhNode { bounds: Bounds::EMPTY, content: Content::Panels(content) });
            }
        }
        next += 1;
    }
    (nodes, order)
}

fn union(bounds: impl Fn(u32) -> Bounds, part: &[u32]) -> Bounds {
    part.iter().fold(Bounds::EMPTY, |all, &k| all.union(bounds(k)))
}

fn middle(bounds: &Bounds) -> DVec3 {
    bounds.low * 0.5 + bounds.high * 0.5
}

/// Puts the panels of the one half first; gives how many they are. Neither half is empty.
fn halve(bounds: impl Fn(u32) -> Bounds, part: &mut [u32]) -> usize {
    let (low, high) = part
        .iter()
        .map(|&k| middle(&bounds(k)))
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    let size = high - low;
    let axis = if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    let bin = |k: u32| {
        let place = (middle(&bounds(k))[axis] - low[axis]) / size[axis] * BINS as f64;
        (place as usize).min(BINS - 1)
    };
    let mut counts = [0usize; BINS];
    let mut around = [Bounds::EMPTY; BINS];
    for &k in &*part {
        counts[bin(k)] += 1;
        around[bin(k)] = around[bin(k)].union(bounds(k));
    }
    let unit = union(&bounds, part).extent();
    let mut after = [(0usize, Bounds::EMPTY); BINS + 1];
    for k in (0..BINS).rev() {
        after[k] = (after[k + 1].0 + counts[k], after[k + 1].1.union(around[k]));
    }
    let (mut count, mut so_far) = (0, Bounds::EMPTY);
    let mut best = (f64::INFINITY, 0);
    for k in 1..BINS {
        count += counts[k - 1];
        so_far = so_far.union(around[k - 1]);
        let (rest, behind) = after[k];
        let cost = so_far.half_area(unit) * count as f64 + behind.half_area(unit) * rest as f64;
        if count > 0 && rest > 0 && cost < best.0 {
            best = (cost, k);
        }
    }
    // Middles in one place, or sizes that overflow.
    if best.1 == 0 {
        return part.len() / 2;
    }
    part.sort_by_key(|&k| bin(k) >= best.1);
    part.partition_point(|&k| bin(k) < best.1)
}
