//! Cells that show the same, joined to larger convex polygons.
//!
//! Two convex polygons that share a whole side are a convex one if that is convex, or straight, at both ends of the side. Corners and
//! great circles have names and signs are exact, so no rounded coordinate decides anything. What merges *all* cells of a region is
//! [`ContourImage::regions`], whose regions are not convex, and which takes longer than a view.

use super::directions::ExactCache;
use super::image::{Cell, ContourImage};
use super::polygon::PolygonArc;
use glam::DVec3;

#[cfg(test)]
mod tests;

/// A cell is compared with so many of those before it: its neighbours in the contour tree come shortly before or after it.
const BACK: usize = 16;

/// Convex unions of cells with one label each.
pub(crate) struct Joiner<'a, L> {
    image: &'a ContourImage,
    cache: ExactCache,
    polygons: Vec<Joined<'a, L>>,
}

/// A convex union of cells.
pub(crate) struct Joined<'a, L> {
    /// One of the cells.
    pub(crate) cell: Cell<'a>,
    /// What they have in common.
    pub(crate) label: L,
    arcs: Vec<PolygonArc>,
}

impl<L> Joined<'_, L> {
    /// Its corners as unit directions, as [`Cell::boundary`].
    pub(crate) fn boundary(&self) -> impl ExactSizeIterator<Item = DVec3> {
        self.arcs.iter().map(|arc| self.cell.image().tree.directions.unit(arc.from))
    }
}

impl<'a, L: PartialEq> Joiner<'a, L> {
    pub(crate) fn new(image: &'a ContourImage) -> Self {
        Self { image, cache: ExactCache::default(), polygons: Vec::new() }
    }

    /// Adds a cell of the image, and joins it to earlier ones that it makes a convex polygon with.
    pub(crate) fn add(&mut self, cell: Cell<'a>, label: L) {
        let mut new = Joined { cell, label, arcs: cell.arcs().to_vec() };
        let mut at = self.polygons.len();
        let mut end = at.saturating_sub(BACK);
        while at > end {
            at -= 1;
            let other = &self.polygons[at];
            if other.label != new.label {
                continue;
            }
            if let Some(arcs) = join(self.image, &mut self.cache, &other.arcs, &new.arcs) {
                new.arcs = arcs;
                self.polygons.remove(at);
                // What did not fit the parts may fit the whole.
                at = self.polygons.len();
                end = at.saturating_sub(BACK);
            }
        }
        self.polygons.push(new);
    }

    pub(crate) fn into_polygons(self) -> Vec<Joined<'a, L>> {
        self.polygons
    }
}

/// The boundary of two polygons that share a side, if it is convex.
fn join(
    image: &ContourImage,
    cache: &mut ExactCache,
    one: &[PolygonArc],
    other: &[PolygonArc],
) -> Option<Vec<PolygonArc>> {
    let [i, j] = shared_side(one, other)?;
    let rest = |arcs: &[PolygonArc], side: usize| [&arcs[side + 1..], &arcs[..side]].concat();
    let mut arcs = rest(one, i);
    let seam = arcs.len();
    arcs.extend(rest(other, j));
    let directions = &image.tree.directions;
    for at in [seam, 0] {
        let count = arcs.len();
        let (before, next) = ((at + count - 1) % count, (at + 1) % count);
        if arcs[before].along == arcs[at].along {
            // Straight on: no corner, unless the arc would get long.
            let ends = [before, next].map(|k| directions.unit(arcs[k].from));
            if count > 3 && ends[0].dot(ends[1]) > 0.0 {
                arcs.remove(at);
            }
            continue;
        }
        let side = directions.side(image.skeleton(), arcs[next].from, arcs[before].along.circle(), cache);
        if side != arcs[before].along.inside() {
            // It turns to the right, or goes straight on along a great circle of another name: rare.
            return None;
        }
    }
    Some(arcs)
}

/// The numbers of a side of each that has the same ends.
fn shared_side(one: &[PolygonArc], other: &[PolygonArc]) -> Option<[usize; 2]> {
    let end = |arcs: &[PolygonArc], k: usize| arcs[if k + 1 == arcs.len() { 0 } else { k + 1 }].from;
    for (i, side) in one.iter().enumerate() {
        for j in 0..other.len() {
            if end(other, j) == side.from && end(one, i) == other[j].from {
                return Some([i, j]);
            }
        }
    }
    None
}
