//! Cells merged to larger convex ones, where that takes no more than a walk through the contour tree.
//!
//! Where all leaves below a node have one label, the node's own region, which is convex, stands for them. Its boundary is that of its two
//! halves without the stretch that they share, and so is put together without arithmetic. Regions across nodes stay apart: what merges
//! all cells is [`ContourImage::regions`], whose regions are not convex, and which takes longer than a view.

use super::directions::CircleId;
use super::image::{Cell, CellId, ContourImage};
use super::polygon::PolygonArc;
use super::tree::Link;
use glam::DVec3;

#[cfg(test)]
mod tests;

/// A convex union of cells with one label.
pub(crate) struct Merged<L> {
    /// Their label.
    pub(crate) label: L,
    /// One of them.
    pub(crate) cell: CellId,
    /// Its corners as unit directions, as [`Cell::boundary`].
    pub(crate) boundary: Vec<DVec3>,
}

/// A subtree with one label.
struct Whole<L> {
    label: L,
    cell: CellId,
    arcs: Vec<PolygonArc>,
}

impl ContourImage {
    /// The cells that have a label, merged where all of a subtree has the same one. The same for the same image. O(nodes) and the corners of labelled cells
    /// times the depth that they rise.
    ///
    /// # Errors
    /// The first one of `label`.
    pub(crate) fn merged<L: PartialEq, E>(
        &self,
        mut label: impl FnMut(Cell<'_>) -> Result<Option<L>, E>,
    ) -> Result<Vec<Merged<L>>, E> {
        let mut merged = Vec::new();
        // What is below each node is finished before the node: a link goes on the stack again, to be closed, before what is below it.
        let mut stack = vec![(self.root(), false)];
        let mut results: Vec<Option<Whole<L>>> = Vec::new();
        while let Some((link, is_open)) = stack.pop() {
            match link {
                Link::Leaf(leaf) => {
                    let whole = match self.cell_of_leaf[leaf as usize] {
                        None => None,
                        Some(cell) => label(self.cell(cell))?.map(|label| {
                            let arcs = self.tree.boundary(leaf).to_vec();
                            Whole { label, cell, arcs }
                        }),
                    };
                    results.push(whole);
                }
                Link::Node(number) if !is_open => {
                    let node = &self.tree.nodes[number as usize];
                    stack.extend([(link, true), (node.positive(), false), (node.negative(), false)]);
                }
                Link::Node(number) => {
                    let circle = self.tree.nodes[number as usize].circle;
                    let positive = results.pop().flatten();
                    let negative = results.pop().flatten();
                    let joined = match (&negative, &positive) {
                        (Some(one), Some(other)) if one.label == other.label => {
                            self.joined(&one.arcs, &other.arcs, circle)
                        }
                        _ => None,
                    };
                    match joined {
                        Some(arcs) => results.push(negative.map(|whole| Whole { arcs, ..whole })),
                        None => {
                            merged.extend([negative, positive].into_iter().flatten().map(|whole| self.finished(whole)));
                            results.push(None);
                        }
                    }
                }
            }
        }
        merged.extend(results.into_iter().flatten().map(|whole| self.finished(whole)));
        Ok(merged)
    }

    fn finished<L>(&self, Whole { label, cell, arcs }: Whole<L>) -> Merged<L> {
        let boundary = arcs.iter().map(|arc| self.tree.directions.unit(arc.from)).collect();
        Merged { label, cell, boundary }
    }

    /// The boundary of two polygons together that share all that they have on a great circle; `None` if that cannot be told by its name.
    fn joined(&self, one: &[PolygonArc], other: &[PolygonArc], circle: CircleId) -> Option<Vec<PolygonArc>> {
        let [first, second] = [without(one, circle)?, without(other, circle)?];
        let mut arcs: Vec<PolygonArc> = Vec::with_capacity(one.len() + other.len());
        arcs.extend(first);
        let seam = arcs.len();
        arcs.extend(second);
        // Corners at which the boundary goes straight on are left out, unless arcs would get long.
        for at in [seam, 0] {
            let count = arcs.len();
            let before = (at + count - 1) % count;
            let ends = [before, (at + 1) % count].map(|k| self.tree.directions.unit(arcs[k].from));
            if count > 3 && arcs[at].along == arcs[before].along && ends[0].dot(ends[1]) > 0.0 {
                arcs.remove(at);
            }
        }
        Some(arcs)
    }
}

/// The sides of a polygon in their order, from where those along a great circle end to where they begin; `None` if there are none.
fn without(arcs: &[PolygonArc], circle: CircleId) -> Option<impl Iterator<Item = PolygonArc>> {
    let count = arcs.len();
    let is_along = |k: usize| arcs[k % count].along.circle() == circle;
    let start = (0..count).find(|&k| is_along(k + count - 1) && !is_along(k))?;
    let length = (0..count).take_while(|&k| !is_along(start + k)).count();
    // They are one stretch, as a convex polygon meets a great circle on its boundary in one.
    Some((0..length).map(move |k| arcs[(start + k) % count]))
}
