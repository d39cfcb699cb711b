//! Cells that show the same, joined to larger convex polygons.
//!
//! Two convex polygons that share a whole side are a convex one if that is convex, or straight, at both ends of the side. Corners and
//! great circles have names and signs are exact, so no rounded coordinate decides anything. What merges *all* cells of a region is
//! [`ContourImage::regions`], whose regions are not convex, and which takes longer than a view.

use super::directions::ExactCache;
use super::image::{Cell, ContourImage};
use super::polygon::PolygonArc;
use glam::DVec3;

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

#[cfg(test)]
mod tests {
    use super::Joiner;
    use crate::contour::{Cell, ContourImage, Domain, SceneOrder, Viewpoint};
    use crate::integral::solid_angle;
    use crate::samples::{Kind, generate};
    use crate::scene::{PolygonId, Side};
    use glam::DVec3;
    use std::collections::BTreeMap;

    fn images() -> impl Iterator<Item = ContourImage> {
        Kind::ALL.into_iter().flat_map(|kind| (1..4).map(move |seed| (kind, seed))).map(|(kind, seed)| {
            let scene = generate(kind, 1_000, seed).unwrap().to_builder().build().unwrap();
            let eye = Viewpoint::on_surface(&scene, PolygonId(0), Side::Front, DVec3::new(0.3, 0.2, 0.0)).unwrap();
            SceneOrder::new(&scene).view(&eye, &Domain::Above).unwrap()
        })
    }

    /// What cells are joined by.
    type By = fn(Cell<'_>) -> Option<u32>;

    fn by_polygon(cell: Cell<'_>) -> Option<u32> {
        cell.polygon().map(|polygon| polygon.0)
    }

    /// Three labels, to test what does not hang on polygons.
    fn by_thirds(cell: Cell<'_>) -> Option<u32> {
        by_polygon(cell).map(|polygon| polygon % 3)
    }

    fn by_lamp(cell: Cell<'_>) -> Option<u32> {
        let is_lit = crate::brdf::emitted_by_both_sides(cell).max_element() > 0.0;
        by_polygon(cell).filter(|_| is_lit)
    }

    #[test]
    fn joined_cells_are_convex_and_cover_what_the_cells_do() {
        for (by, most) in [(by_polygon as By, 0.9), (by_thirds, 0.9), (by_lamp, 0.99)] {
            let (mut cells, mut joined) = (0, 0);
            for image in images() {
                let mut joiner = Joiner::new(&image);
                let [mut before, mut after] = [BTreeMap::<u32, f64>::new(), BTreeMap::new()];
                for cell in image.cells() {
                    let Some(label) = by(cell) else { continue };
                    *before.entry(label).or_default() += cell.solid_angle();
                    joiner.add(cell, label);
                    cells += 1;
                }
                let polygons = joiner.into_polygons();
                for polygon in &polygons {
                    let corners: Vec<DVec3> = polygon.boundary().collect();
                    for k in 0..corners.len() {
                        let normal = corners[k].cross(corners[(k + 1) % corners.len()]);
                        // Corners are rounded by 1e-16 or so, each.
                        assert!(corners.iter().all(|c| c.dot(normal) > -4e-16), "{corners:?}");
                    }
                    *after.entry(polygon.label).or_default() += solid_angle(&corners);
                }
                for (label, area) in &before {
                    // Of up to a thousand cells, each rounded.
                    assert!((area - after[label]).abs() < 1e-13, "{label}: {area} {}", after[label]);
                }
                joined += polygons.len();
            }
            println!("{joined} of {cells} cells");
            assert!(joined as f64 <= most * cells as f64, "{joined} of {cells}");
        }
    }

    #[test]
    fn whole_hemispheres_are_one() {
        let scene = crate::scene::Scene::builder().build().unwrap();
        let eye = Viewpoint::free(DVec3::ZERO);
        let image = SceneOrder::new(&scene).view(&eye, &Domain::Hemisphere(DVec3::new(0.1, 0.2, 0.9))).unwrap();
        let mut joiner = Joiner::new(&image);
        image.cells().for_each(|cell| joiner.add(cell, ()));
        let polygons = joiner.into_polygons();
        let area: f64 = polygons.iter().map(|polygon| solid_angle(&polygon.boundary().collect::<Vec<_>>())).sum();
        assert!(polygons.len() < image.cell_count() && (area - std::f64::consts::TAU).abs() < 1e-14);
    }
}
