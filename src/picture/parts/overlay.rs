//! What is seen in a mirror, laid over the mirror.

use super::PixelParts;
use glam::DVec2;
use std::ops::Range;

/// Squares about as many as the facets of a picture, and which facets may reach into each: they tile the picture, so that these are few.
pub(super) struct Squares {
    /// How many there are either way.
    count: usize,
    /// Of a picture, in pixels.
    size: DVec2,
    facets: Vec<Vec<u32>>,
}

impl Squares {
    /// Not more either way.
    const MOST: usize = 1024;

    pub(super) fn of(parts: &PixelParts<'_>) -> Self {
        let count = parts.facets.len().isqrt().clamp(1, Self::MOST);
        let mut found = Self { count, size: parts.size.as_dvec2(), facets: vec![Vec::new(); count * count] };
        for facet in 0..parts.facets.len() as u32 {
            let [columns, rows] = found.reached(parts.ring(facet));
            for row in rows {
                for square in columns.clone() {
                    found.facets[row * count + square].push(facet);
                }
            }
        }
        found
    }

    /// The facets that may meet a ring, ascending.
    fn meeting(&self, ring: &[DVec2]) -> Vec<u32> {
        let [columns, rows] = self.reached(ring);
        let squares =
            rows.map(|row| row * self.count).flat_map(|row| &self.facets[row + columns.start..row + columns.end]);
        let mut facets: Vec<u32> = squares.flatten().copied().collect();
        facets.sort_unstable();
        facets.dedup();
        facets
    }

    /// The columns and the rows that a ring may reach into; beyond the picture, the nearest.
    fn reached(&self, ring: &[DVec2]) -> [Range<usize>; 2] {
        let (low, high) = extent(ring);
        // What is not a number is 0.
        let place = |at: f64, size: f64| ((at / size * self.count as f64) as usize).min(self.count - 1);
        let range = |low: f64, high: f64, size: f64| place(low, size)..place(high, size) + 1;
        [range(low.x, high.x, self.size.x), range(low.y, high.y, self.size.y)]
    }
}

/// The parts of a convex part of the picture in which cells of what a mirror shows are seen, with those cells. They tile it, but for rounding. `squares` are those of what it shows.
pub(super) fn overlay(ring: &[DVec2], mirrored: &PixelParts<'_>, squares: &Squares) -> Vec<(u32, Vec<DVec2>)> {
    let (low, high) = extent(ring);
    let mut parts = Vec::new();
    let mut rest = Vec::new();
    for facet in squares.meeting(ring) {
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
