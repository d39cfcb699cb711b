//! What is seen in a mirror, laid over the mirror.

use super::PixelParts;
use glam::DVec2;

/// The parts of a convex part of the picture in which cells of what a mirror shows are seen, with those cells. They tile it, but for rounding.
pub(super) fn overlay(ring: &[DVec2], mirrored: &PixelParts<'_>) -> Vec<(u32, Vec<DVec2>)> {
    let bands = mirrored.bands_of(ring);
    let mut candidates: Vec<u32> = mirrored.bands[bands].iter().flatten().copied().collect();
    candidates.sort_unstable();
    candidates.dedup();
    let (low, high) = extent(ring);
    let mut parts = Vec::new();
    let mut rest = Vec::new();
    for facet in candidates {
        let other = mirrored.ring(facet);
        let (its_low, its_high) = extent(other);
        if its_low.cmpge(high).any() || its_high.cmple(low).any() {
            continue;
        }
        let mut part = other.to_vec();
        for (k, &p) in ring.iter().enumerate() {
            let q = ring[if k + 1 == ring.len() { 0 } else { k + 1 }];
            cut(&part, p, q, &mut rest);
            std::mem::swap(&mut part, &mut rest);
        }
        if part.len() >= 3 {
            parts.push((mirrored.facets[facet as usize].cell, part));
        }
    }
    parts
}

fn extent(ring: &[DVec2]) -> (DVec2, DVec2) {
    ring.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), &p| (low.min(p), high.max(p)))
}

/// What a convex polygon has to the right of a line, seen with y down to the side on which cells have their inside.
fn cut(ring: &[DVec2], from: DVec2, to: DVec2, inside: &mut Vec<DVec2>) {
    inside.clear();
    let off = |p: DVec2| (to - from).perp_dot(p - from);
    for (k, &p) in ring.iter().enumerate() {
        let q = ring[if k + 1 == ring.len() { 0 } else { k + 1 }];
        let (a, b) = (off(p), off(q));
        if a >= 0.0 {
            inside.push(p);
        }
        if (a < 0.0 && b > 0.0) || (a > 0.0 && b < 0.0) {
            inside.push(p + (q - p) * (a / (a - b)));
        }
    }
}
