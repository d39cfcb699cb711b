//! Closed surfaces laid out in ticks: vertices at equal places are one vertex.

use super::mesh::{Look, Mesh};
use super::ticks::Frame;
use rustc_hash::FxHashMap;

/// A rectangle across an axis, in cells.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sheet<'a> {
    /// The axis it is perpendicular to.
    pub(super) axis: usize,
    /// Where on that axis it lies.
    pub(super) at: i64,
    /// Its grid lines across the next axis in cyclic order, ascending.
    pub(super) us: &'a [i64],
    /// Its grid lines across the one after, ascending.
    pub(super) vs: &'a [i64],
    /// Whether its front is on the side of greater coordinates.
    pub(super) faces_up: bool,
}

impl Sheet<'_> {
    fn point(&self, u: i64, v: i64) -> [i64; 3] {
        let mut point = [self.at; 3];
        point[(self.axis + 1) % 3] = u;
        point[(self.axis + 2) % 3] = v;
        point
    }
}

/// One surface under construction.
#[derive(Debug)]
pub(super) struct Surface<'a> {
    mesh: &'a mut Mesh,
    frame: Frame,
    known: FxHashMap<[i64; 3], u32>,
}

impl<'a> Surface<'a> {
    /// Starts a surface in that frame.
    pub(super) fn new(mesh: &'a mut Mesh, frame: Frame) -> Self {
        Self { mesh, frame, known: FxHashMap::default() }
    }

    /// The mesh it becomes part of.
    pub(super) fn mesh(&mut self) -> &mut Mesh {
        self.mesh
    }

    /// Adds a triangle.
    pub(super) fn triangle(&mut self, corners: [[i64; 3]; 3], look: Look) {
        let corners = corners.map(|corner| self.vertex(corner));
        self.mesh.add_triangle(corners, look);
    }

    /// Adds a quad.
    pub(super) fn quad(&mut self, corners: [[i64; 3]; 4], look: Look) {
        let corners = corners.map(|corner| self.vertex(corner));
        self.mesh.add_quad(corners, look);
    }

    /// Adds the cells of a sheet.
    pub(super) fn sheet(&mut self, sheet: Sheet<'_>, look: Look) {
        self.sheet_except(sheet, look, |_, _| false);
    }

    /// Adds the cells of a sheet but those for which `left_out` holds.
    pub(super) fn sheet_except(&mut self, sheet: Sheet<'_>, look: Look, left_out: impl Fn(usize, usize) -> bool) {
        for (j, v) in sheet.vs.windows(2).enumerate() {
            for (i, u) in sheet.us.windows(2).enumerate() {
                if left_out(i, j) {
                    continue;
                }
                let mut corners = [(u[0], v[0]), (u[1], v[0]), (u[1], v[1]), (u[0], v[1])];
                if !sheet.faces_up {
                    corners.reverse();
                }
                self.quad(corners.map(|(u, v)| sheet.point(u, v)), look);
            }
        }
    }

    /// Adds the six sides of a box with these grid lines, fronts outward.
    pub(super) fn block(&mut self, lines: &[Vec<i64>; 3], look: Look) {
        for axis in 0..3 {
            let (us, vs) = (&lines[(axis + 1) % 3], &lines[(axis + 2) % 3]);
            let along = &lines[axis];
            for (at, faces_up) in [(along[0], false), (along[along.len() - 1], true)] {
                self.sheet(Sheet { axis, at, us, vs, faces_up }, look);
            }
        }
    }

    fn vertex(&mut self, ticks: [i64; 3]) -> u32 {
        let (mesh, frame) = (&mut *self.mesh, &self.frame);
        *self.known.entry(ticks).or_insert_with(|| mesh.add_vertex(frame.world(ticks)))
    }
}
