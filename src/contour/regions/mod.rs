//! Visible regions: the cells of a contour image, merged where they show the same.
//!
//! Merging is exact and combinatorial. The sides of all cells are sorted around their great circles with exact signs;
//! what cells of one label have on both sides of a stretch cancels, and the rest is linked to loops by walking around
//! the cells at each corner. Rounded coordinates decide nothing, and so another contour tree of the same view gives the same regions.

mod arrangement;
pub(crate) mod circles;
mod crossings;
pub(crate) mod mosaic;
pub(crate) mod outlines;
pub(crate) mod places;
pub(crate) mod sets;

use super::image::{CellId, ContourImage};
use crate::exact::Sign;
use crate::scene::{PolygonId, Side, Splitter};
use glam::DVec3;
use mosaic::Mosaic;
use outlines::{Outlines, Run, inside};

/// A connected part of what is seen of one side of a polygon, or of the background.
///
/// Connected means by stretches of great circles: parts that touch each other in points are regions of their own.
#[derive(Clone, Debug, PartialEq)]
pub struct VisibleRegion {
    polygon: Option<PolygonId>,
    side: Option<Side>,
    cells: Vec<CellId>,
    loops: Vec<RegionLoop>,
}

impl VisibleRegion {
    /// The polygon seen in it; `None` for background.
    pub fn polygon(&self) -> Option<PolygonId> {
        self.polygon
    }

    /// The side of the polygon seen in it.
    pub fn side(&self) -> Option<Side> {
        self.side
    }

    /// The cells that it consists of, ascending.
    pub fn cells(&self) -> &[CellId] {
        &self.cells
    }

    /// Its boundary. One loop bounds a region without holes; a region with k holes has k + 1, none of which is the
    /// outer one, as on a sphere there is no outside. Without a loop the region is the whole sphere.
    pub fn loops(&self) -> &[RegionLoop] {
        &self.loops
    }
}

/// A closed curve of arcs of great circles that bounds a region. The region lies to the left, seen from outside
/// of the sphere.
///
/// It is simple: where a region touches itself in a point, the boundary is divided into loops that each pass the
/// point once. Two loops of one region may share points, but never cross.
#[derive(Clone, Debug, PartialEq)]
pub struct RegionLoop {
    sides: Vec<RegionSide>,
}

impl RegionLoop {
    /// Its sides in their order. Neighbouring sides lie on different great circles, so that there is a corner between
    /// them, unless the loop is a whole great circle: that is one side, and no corner.
    pub fn sides(&self) -> &[RegionSide] {
        &self.sides
    }
}

/// A side of a region: a stretch of a great circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegionSide {
    /// The great circle.
    pub splitter: Splitter,
    /// The sign that directions to the left have for its normal `n`: the inward normal is `n` or `-n`.
    pub inside: Sign,
    /// To which side the boundary turns where the side starts: `Positive` to the left, at `m x n` with the
    /// inward normals `m` of the side before and `n` of this one, that is exactly; `Negative` to the right, at `n x m`. `Zero` for a
    /// whole great circle.
    pub turn: Sign,
    /// Where it starts, as a unit direction, rounded. Some point of a whole great circle.
    pub from: DVec3,
    /// Its length in radians, rounded: less than 2 pi but for a whole great circle.
    pub length: f64,
    /// True if the polygons seen to both sides of it pass through each other here.
    pub is_crossing: bool,
}

impl ContourImage {
    /// The visible regions: by polygon and side, background last, then by their lowest cells. Every cell is in one.
    ///
    /// The cost is about n log n in the number of cells; docs/performance.md has it beside that of the view.
    ///
    /// ```
    /// # use nusselt::bsp::{BspOptions, SceneBsp};
    /// # use nusselt::contour::{Domain, Viewpoint};
    /// # use nusselt::scene::{Material, PolygonId, Scene};
    /// // A square floating before a wall: the wall's region has a hole.
    /// let vertices = [
    ///     [-9.0, -9.0, 2.0], [9.0, -9.0, 2.0], [9.0, 9.0, 2.0], [-9.0, 9.0, 2.0],
    ///     [-1.0, -1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, 1.0], [-1.0, 1.0, 1.0],
    /// ];
    /// let faces = [vec![0, 1, 2, 3], vec![4, 5, 6, 7]];
    /// let scene = Scene::builder().mesh(&vertices, &faces, Material::new("grey")).build()?;
    /// let bsp = SceneBsp::build(&scene, &BspOptions::default())?;
    /// let image = bsp.view(&Viewpoint::free(glam::DVec3::ZERO), &Domain::Sphere)?;
    /// let regions = image.regions();
    /// let counts: Vec<_> = regions.iter().map(|region| (region.polygon(), region.loops().len())).collect();
    /// assert_eq!(counts, [(Some(PolygonId(0)), 2), (Some(PolygonId(1)), 1), (None, 1)]);
    /// assert!(regions[1].loops()[0].sides().len() == 4);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn regions(&self) -> Vec<VisibleRegion> {
        let mut outlines = Outlines::new(Mosaic::new(self), None);
        let components = std::mem::take(&mut outlines.components);
        let regions = components.into_iter().map(|component| {
            let faces = component.faces.iter().map(|&face| &outlines.mosaic.faces[face as usize]);
            let mut cells: Vec<CellId> = faces.filter_map(|face| face.cell).collect();
            cells.sort_unstable();
            let loops = component.loops.iter().map(|runs| self.region_loop(&mut outlines, runs));
            let loops = loops.collect();
            VisibleRegion { polygon: component.label.polygon, side: component.label.side, cells, loops }
        });
        regions.collect()
    }

    /// A loop without the vertices that the boundary goes straight through.
    fn region_loop(&self, outlines: &mut Outlines<'_>, runs: &[Run]) -> RegionLoop {
        let skeleton = self.skeleton();
        let before = |k: usize| runs[if k == 0 { runs.len() - 1 } else { k - 1 }];
        // A whole great circle has no corner to start at.
        let first = (0..runs.len()).find(|&k| !outlines.go_on(before(k), runs[k])).unwrap_or(0);
        let mut sides: Vec<RegionSide> = Vec::new();
        for k in (first..runs.len()).chain(0..first) {
            let run = runs[k];
            let length = outlines.chains[run.chain as usize].length;
            match sides.last_mut() {
                Some(side) if outlines.go_on(before(k), run) => side.length += length,
                _ => {
                    let circle = outlines.circles.name(outlines.circle(run.chain));
                    let splitter = outlines.mosaic.directions.splitter(skeleton, circle);
                    sides.push(RegionSide {
                        splitter,
                        inside: inside(run),
                        turn: outlines.turn(before(k), run),
                        from: outlines.unit(outlines.start(run)),
                        length,
                        is_crossing: matches!(splitter, Splitter::Crease(_))
                            || crossings::is_crossing(self, outlines, run, circle),
                    });
                }
            }
        }
        RegionLoop { sides }
    }
}
