//! Where others stand on facets, pass through them or lie on them: a mesh has edges there, so that each of its parts is covered as a whole or not at all.
//!
//! This decides where parts end, and nothing about what is seen from them.

use super::contacts::{TOUCHES, contacts};
use super::facets::{Facet, Facets};
use super::lies::Lies;
use super::shape::{Frame, sides};
use glam::{DVec2, DVec3};

/// What is nearer to a facet than this part of the longest edge covers it: between the two there is no room for light that a mesh of such edges could show.
const REACH: f64 = 0.01;

/// The segments in each facet's plane along which others stand on its front, or nearly so, or lie on it.
pub(super) fn footprints(facets: &Facets, frames: &[Frame], longest: f64) -> Vec<Vec<[DVec2; 2]>> {
    let boxes: Vec<[DVec3; 2]> = facets.all.iter().map(|facet| bounds(&facet.ring)).collect();
    let size = |[low, high]: [DVec3; 2]| low.distance(high);
    let reach = |facet: usize| REACH * longest.min(size(boxes[facet]));
    let mut found = vec![Vec::new(); boxes.len()];
    near_pairs(&boxes, TOUCHES.max(REACH * longest), |a, b| {
        for [facet, other] in [[a, b], [b, a]] {
            add(&mut found[facet], facet as u32, other as u32, facets, &frames[facet], reach(facet));
        }
    });
    found
}

fn add(found: &mut Vec<[DVec2; 2]>, facet: u32, other: u32, facets: &Facets, frame: &Frame, reach: f64) {
    let Facet { ring, is_covered, .. } = &facets.all[other as usize];
    match facets.lies(other, facet) {
        Lies::Behind => {}
        Lies::On => {
            if *is_covered && facets.all[facet as usize].is_covered {
                found.extend(sides(ring).map(|side| side.map(|p| frame.flat(p))));
            }
        }
        Lies::Front | Lies::Across => {
            // What is in front of it by rounding only may hang below it.
            let heights = ring.iter().map(|&p| frame.height(p));
            let [low, high] = heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], x| [l.min(x), h.max(x)]);
            if low < -TOUCHES && high <= TOUCHES {
                return;
            }
            found.extend(contacts(facet, facets, frame, &[other]));
            let is_near = |p: DVec3| (-TOUCHES..=reach.max(TOUCHES)).contains(&frame.height(p));
            let near = sides(ring).filter(|side| side.iter().all(|&p| is_near(p)));
            found.extend(near.map(|side| side.map(|p| frame.flat(p))));
        }
    }
}

pub(super) fn bounds(ring: &[DVec3]) -> [DVec3; 2] {
    ring.iter().fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], &p| [low.min(p), high.max(p)])
}

/// Calls `found` with all pairs of boxes that are not farther apart than `reach`, in an order that depends on nothing else: swept along the axis on which their lengths
/// are the smallest part of the whole.
pub(super) fn near_pairs(boxes: &[[DVec3; 2]], reach: f64, mut found: impl FnMut(usize, usize)) {
    let whole = boxes.iter().fold(DVec3::NEG_INFINITY, |m, b| m.max(b[1]))
        - boxes.iter().fold(DVec3::INFINITY, |m, b| m.min(b[0]));
    let lengths: DVec3 = boxes.iter().map(|[low, high]| *high - *low).sum();
    let part = |axis: usize| if whole[axis] > 0.0 { lengths[axis] / whole[axis] } else { f64::INFINITY };
    let axis = (0..3).min_by(|&a, &b| part(a).total_cmp(&part(b))).unwrap_or(0);
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    order.sort_by(|&a, &b| boxes[a][0][axis].total_cmp(&boxes[b][0][axis]));
    let mut open: Vec<usize> = Vec::new();
    for next in order {
        let [low, high] = boxes[next];
        open.retain(|&other| boxes[other][1][axis] + reach >= low[axis]);
        for &other in &open {
            let [from, to] = boxes[other];
            if (from - reach).cmple(high).all() && (to + reach).cmpge(low).all() {
                found(other, next);
            }
        }
        open.push(next);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_near_pairs_are_found_once() {
        // A small generator (Knuth's MMIX) of places and sizes.
        let mut state = 7_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut point = || DVec3::new(random(), random(), random());
        let boxes: Vec<[DVec3; 2]> =
            (0..200).map(|_| (point(), 0.2 * point())).map(|(p, size)| [p, p + size]).collect();
        let reach = 0.01;
        let mut found = Vec::new();
        near_pairs(&boxes, reach, |a, b| found.push([a.min(b), a.max(b)]));
        found.sort_unstable();
        let is_near = |a: usize, b: usize| {
            let gap = (boxes[a][0] - boxes[b][1]).max(boxes[b][0] - boxes[a][1]);
            gap.max_element() <= reach
        };
        let all = (0..boxes.len()).flat_map(|a| (a + 1..boxes.len()).map(move |b| [a, b]));
        let expected: Vec<[usize; 2]> = all.filter(|&[a, b]| is_near(a, b)).collect();
        assert!(expected.len() > 100);
        assert_eq!(found, expected);
    }
}
