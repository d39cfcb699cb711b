//! The shell of a room: floor, walls, ceiling and recessed lamps as one closed surface.

use super::mesh::{Look, Mesh};
use super::paint::Paint;
use super::surface::{Sheet, Surface};
use super::ticks::{Frame, cells, finest, lines, mm};
use std::ops::Range;

/// How deep lamps are recessed into the ceiling.
const RECESS: i64 = mm(120);

/// A plan of a shell.
#[derive(Clone, Debug)]
pub(super) struct Shell {
    /// Its extent in ticks, from 0.
    size: [i64; 3],
    /// Cells along each axis.
    cells: [usize; 3],
    /// Rows of lamps along x and y.
    lamps: [usize; 2],
    /// The length of a lamp along x and y.
    lamp_size: [i64; 2],
}

impl Shell {
    /// The finest shell within the budget, or the coarsest there is.
    pub(super) fn within(budget: usize, size: [i64; 3], lamps: [usize; 2], lamp_size: [i64; 2]) -> Self {
        let with_cells = |h| {
            let mut cells = size.map(|length| cells(length, h));
            // Every lamp is at least a cell, with at least a cell of ceiling on each side.
            cells[0] = cells[0].max(3 * lamps[0]);
            cells[1] = cells[1].max(3 * lamps[1]);
            Self { size, cells, lamps, lamp_size }
        };
        with_cells(finest(|h| with_cells(h).polygon_count() <= budget))
    }

    /// The number of polygons it will have.
    pub(super) fn polygon_count(&self) -> usize {
        let [x, y, z] = self.cells;
        let recesses: usize = self.lamp_cells().map(|[a, b]| 2 * (a.len() + b.len())).sum();
        2 * (x * y + y * z + z * x) + recesses
    }

    /// Adds it, fronts inward: object `shell`, and an object for every lamp's panel.
    pub(super) fn add_to(&self, mesh: &mut Mesh) {
        let shell = mesh.add_object("shell".to_owned());
        let [wall, ceiling, floor, lamp] =
            [Paint::Wall, Paint::Ceiling, Paint::Floor, Paint::Lamp].map(|paint| mesh.add_material(paint.material()));
        let [xs, ys, zs] = [0, 1, 2].map(|axis| lines(0, self.size[axis], self.cells[axis]));
        let mut surface = Surface::new(mesh, Frame::WORLD);
        surface
            .sheet(Sheet { axis: 2, at: 0, us: &xs, vs: &ys, faces_up: true }, Look { object: shell, material: floor });
        let walls = Look { object: shell, material: wall };
        surface.sheet(Sheet { axis: 0, at: 0, us: &ys, vs: &zs, faces_up: true }, walls);
        surface.sheet(Sheet { axis: 0, at: self.size[0], us: &ys, vs: &zs, faces_up: false }, walls);
        surface.sheet(Sheet { axis: 1, at: 0, us: &zs, vs: &xs, faces_up: true }, walls);
        surface.sheet(Sheet { axis: 1, at: self.size[1], us: &zs, vs: &xs, faces_up: false }, walls);
        let holes = [0, 1].map(|axis| self.lamp_mask(axis));
        let above = Sheet { axis: 2, at: self.size[2], us: &xs, vs: &ys, faces_up: false };
        let look = Look { object: shell, material: ceiling };
        surface.sheet_except(above, look, |i, j| holes[0][i] && holes[1][j]);
        for (k, [a, b]) in self.lamp_cells().enumerate() {
            let (us, vs) = (&xs[a.start..=a.end], &ys[b.start..=b.end]);
            self.add_recess(&mut surface, us, vs, look);
            let object = surface.mesh().add_object(format!("lamp_{}", k + 1));
            let panel = Sheet { axis: 2, at: self.size[2] + RECESS, us, vs, faces_up: false };
            surface.sheet(panel, Look { object, material: lamp });
        }
    }

    fn add_recess(&self, surface: &mut Surface<'_>, us: &[i64], vs: &[i64], look: Look) {
        let zs = [self.size[2], self.size[2] + RECESS];
        for (at, faces_up) in [(us[0], true), (us[us.len() - 1], false)] {
            surface.sheet(Sheet { axis: 0, at, us: vs, vs: &zs, faces_up }, look);
        }
        for (at, faces_up) in [(vs[0], true), (vs[vs.len() - 1], false)] {
            surface.sheet(Sheet { axis: 1, at, us: &zs, vs: us, faces_up }, look);
        }
    }

    /// The ceiling cells of every lamp along x and y, row by row.
    fn lamp_cells(&self) -> impl Iterator<Item = [Range<usize>; 2]> + '_ {
        (0..self.lamps[1])
            .flat_map(move |j| (0..self.lamps[0]).map(move |i| [self.lamp_range(0, i), self.lamp_range(1, j)]))
    }

    /// The cells of the `k`-th row of lamps along an axis: in the middle of its share of the ceiling.
    fn lamp_range(&self, axis: usize, k: usize) -> Range<usize> {
        let (cells, rows) = (self.cells[axis], self.lamps[axis]);
        let (start, end) = (k * cells / rows, (k + 1) * cells / rows);
        let wanted = (self.lamp_size[axis] as usize * cells).div_ceil(self.size[axis] as usize);
        let length = wanted.clamp(1, end - start - 2);
        let first = start + (end - start - length) / 2;
        first..first + length
    }

    /// For every column of ceiling cells along an axis, whether it meets a row of lamps.
    fn lamp_mask(&self, axis: usize) -> Vec<bool> {
        let mut mask = vec![false; self.cells[axis]];
        for k in 0..self.lamps[axis] {
            mask[self.lamp_range(axis, k)].fill(true);
        }
        mask
    }
}
