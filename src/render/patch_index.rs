//! Finding the patch that a point of a polygon is on.

use crate::radiosity::{normal, off};
use crate::scene::{PieceRef, PolygonId, Scene};
use glam::{DVec2, DVec3, UVec2};

/// The patches of each polygon, in the cells of a grid over it.
#[derive(Clone, Debug, Default)]
pub(super) struct PatchIndex {
    grids: Vec<Grid>,
}

/// Over the polygon as it is seen along the axis of the world that is nearest to its normal.
#[derive(Clone, Debug, Default)]
struct Grid {
    axes: [usize; 2],
    low: DVec2,
    step: DVec2,
    size: UVec2,
    /// Where the patches of each cell begin in `patches`, and where the last ones end.
    starts: Vec<u32>,
    patches: Vec<PolygonId>,
}

impl PatchIndex {
    /// Patch k is part of polygon `of[k]` of so many.
    pub(super) fn new(patches: &Scene, of: &[PolygonId], polygons: usize) -> Self {
        let mut by_polygon: Vec<Vec<PolygonId>> = vec![Vec::new(); polygons];
        for (patch, polygon) in patches.polygons().zip(of) {
            if patch.pieces().len() > 0 {
                by_polygon[polygon.index()].push(patch.id());
            }
        }
        Self { grids: by_polygon.iter().map(|list| Grid::new(patches, list)).collect() }
    }

    /// The patch of a polygon that is nearest to a point of it; `None` if it has none there.
    pub(super) fn patch_at(&self, patches: &Scene, polygon: PolygonId, point: DVec3) -> Option<PolygonId> {
        let grid = &self.grids[polygon.index()];
        let near = grid.near(point);
        if let [only] = near {
            return Some(*only);
        }
        let mut ring = Vec::new();
        let distance = |patch: PolygonId, ring: &mut Vec<DVec3>| {
            let pieces = patches.polygon(patch).pieces();
            let of_piece = pieces.map(|piece| {
                ring.clear();
                ring.extend(piece.points());
                off(ring, point)
            });
            of_piece.fold(f64::INFINITY, f64::min)
        };
        let found = near.iter().map(|&patch| (distance(patch, &mut ring), patch));
        found.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))).map(|(_, patch)| patch)
    }

    /// All patches of a polygon that are near a part of it with these corners: at least those that it meets.
    pub(super) fn patches_near(
        &self,
        polygon: PolygonId,
        corners: impl Iterator<Item = Option<DVec3>>,
    ) -> Vec<PolygonId> {
        let grid = &self.grids[polygon.index()];
        if grid.starts.is_empty() {
            return Vec::new();
        }
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for corner in corners {
            // One that is nowhere, as the polygon is seen edge-on there, may be anywhere.
            let Some(corner) = corner.filter(|corner| corner.is_finite()) else { return grid.patches.clone() };
            let flat = DVec2::from(grid.axes.map(|axis| corner[axis]));
            (low, high) = (low.min(flat), high.max(flat));
        }
        // A little more, as points are rounded.
        let margin = 1e-6 * grid.step;
        let [from, to] = [grid.cell(low - margin), grid.cell(high + margin)];
        let cells = (from.y..=to.y).flat_map(|y| (from.x..=to.x).map(move |x| UVec2::new(x, y)));
        cells.flat_map(|cell| grid.of_cell(cell)).copied().collect()
    }
}

impl Grid {
    fn new(patches: &Scene, list: &[PolygonId]) -> Self {
        let points = |patch: PolygonId| patches.polygon(patch).pieces().flat_map(PieceRef::points);
        let Some(piece) = list.first().and_then(|&patch| patches.polygon(patch).pieces().next()) else {
            return Self::default();
        };
        let ring: Vec<DVec3> = piece.points().collect();
        let across = normal(&ring).abs().max_position();
        let axes = [(across + 1) % 3, (across + 2) % 3];
        let flat = |p: DVec3| DVec2::from(axes.map(|axis| p[axis]));
        let bounds = |points: &mut dyn Iterator<Item = DVec3>| {
            points.map(flat).fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)))
        };
        let (low, high) = bounds(&mut list.iter().flat_map(|&patch| points(patch)));
        // About as many cells as patches, about as wide as high.
        let extent = (high - low).max(DVec2::splat(f64::MIN_POSITIVE));
        let side = (extent.x / list.len() as f64 * extent.y).sqrt().max(extent.max_element() / 4096.0);
        let size = (extent / side).ceil().clamp(DVec2::ONE, DVec2::splat(4096.0)).as_uvec2();
        let step = extent / size.as_dvec2();
        let mut grid = Self { axes, low, step, size, starts: Vec::new(), patches: Vec::new() };
        let mut cells: Vec<Vec<PolygonId>> = vec![Vec::new(); (size.x * size.y) as usize];
        for &patch in list {
            let (from, to) = bounds(&mut points(patch));
            // A little more, as points of a patch are rounded.
            let margin = 1e-6 * step;
            let [from, to] = [grid.cell(from - margin), grid.cell(to + margin)];
            for y in from.y..=to.y {
                for x in from.x..=to.x {
                    cells[(y * size.x + x) as usize].push(patch);
                }
            }
        }
        grid.starts.push(0);
        for cell in cells {
            grid.patches.extend(cell);
            grid.starts.push(grid.patches.len() as u32);
        }
        grid
    }

    /// The cell of a point, or the nearest one.
    fn cell(&self, p: DVec2) -> UVec2 {
        let last = (self.size - UVec2::ONE).as_dvec2();
        ((p - self.low) / self.step).clamp(DVec2::ZERO, last).as_uvec2()
    }

    fn near(&self, point: DVec3) -> &[PolygonId] {
        if self.starts.is_empty() {
            return &[];
        }
        self.of_cell(self.cell(DVec2::from(self.axes.map(|axis| point[axis]))))
    }

    fn of_cell(&self, cell: UVec2) -> &[PolygonId] {
        let k = (cell.y * self.size.x + cell.x) as usize;
        &self.patches[self.starts[k] as usize..self.starts[k + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::factors::mesh_scene;
    use crate::scene::Material;

    #[test]
    fn every_point_of_a_polygon_is_on_its_patch() {
        // Slanted, and one that is not convex.
        let vertices = [
            [0.0, 0.0, 0.0],
            [4.0, 0.0, 1.0],
            [4.0, 3.0, 1.0],
            [0.0, 3.0, 0.0],
            [0.0, 0.0, 5.0],
            [3.0, 0.0, 5.0],
            [3.0, 1.0, 5.0],
            [1.0, 1.0, 5.0],
            [1.0, 4.0, 5.0],
            [0.0, 4.0, 5.0],
        ];
        let faces = [vec![0, 1, 2, 3], vec![4, 5, 6, 7, 8, 9]];
        let scene = Scene::builder().mesh(&vertices, &faces, Material::new("grey")).build().unwrap();
        let (patches, of) = mesh_scene(&scene, 0.37).unwrap();
        let index = PatchIndex::new(&patches, &of, scene.polygon_count());
        for patch in patches.polygons() {
            for piece in patch.pieces() {
                let ring: Vec<DVec3> = piece.points().collect();
                let middle = ring.iter().sum::<DVec3>() / ring.len() as f64;
                assert!(off(&ring, middle) < 0.0);
                for &corner in &ring {
                    let inside = corner.lerp(middle, 0.01);
                    let found = index.patch_at(&patches, of[patch.id().index()], inside);
                    assert_eq!(found, Some(patch.id()), "{inside}");
                }
            }
        }
    }
}
