//! Solid angles and form factors of what a contour image shows.

use super::receiver::Receiver;
use super::solid_angle;
use super::visible::Visible;
use crate::contour::{Cell, ContourImage, VisibleRegion};
use crate::scene::{ObjectId, PlaneId, PolygonId, Scene, Side};
use glam::DVec3;
use std::collections::BTreeMap;

/// A quantity of a [`ContourImage`] summed over the cells of each polygon.
#[derive(Clone, Debug, PartialEq)]
pub struct Sums {
    /// The visible polygons, by ascending number.
    pub polygons: Vec<PolygonSum>,
    /// Over directions in which nothing is seen.
    pub background: f64,
}

/// A quantity of one polygon, apart for its two sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PolygonSum {
    /// The polygon.
    pub polygon: PolygonId,
    /// Where its front is seen.
    pub front: f64,
    /// Where its back is seen.
    pub back: f64,
}

impl PolygonSum {
    /// Whichever side is seen.
    pub fn both(self) -> f64 {
        self.front + self.back
    }
}

impl Sums {
    /// The quantity of one polygon, whichever side is seen; 0 if it is not visible.
    pub fn of(&self, polygon: PolygonId) -> f64 {
        let found = self.polygons.binary_search_by_key(&polygon, |sum| sum.polygon);
        found.map_or(0.0, |k| self.polygons[k].both())
    }

    /// The quantity of every visible object, in the order of the scene's objects.
    pub fn by_object(&self, scene: &Scene) -> Vec<(ObjectId, f64)> {
        let mut sums = BTreeMap::new();
        for sum in &self.polygons {
            *sums.entry(scene.polygon(sum.polygon).object()).or_insert(0.0) += sum.both();
        }
        sums.into_iter().collect()
    }

    /// Over all polygons and the background.
    pub fn total(&self) -> f64 {
        self.polygons.iter().map(|sum| sum.both()).sum::<f64>() + self.background
    }
}

impl ContourImage {
    /// The solid angle in which each polygon is seen, in steradians; they sum to that of the domain.
    pub fn solid_angles(&self) -> Sums {
        let mut corners = Vec::new();
        self.sums(|cell| {
            corners.clear();
            corners.extend(cell.boundary());
            solid_angle(&corners)
        })
    }

    /// The form factor from the viewpoint (a differential element with the domain's normal) to each
    /// polygon: the share of diffusely emitted energy that arrives there. They sum to 1 with the
    /// background. `None` if the domain has no normal.
    pub fn form_factors(&self) -> Option<Sums> {
        let receiver = Receiver::new(self.normal()?);
        // Each direction is a corner of several cells.
        let turned: Vec<DVec3> = self.directions().map(|direction| receiver.turned(direction)).collect();
        let mut corners = Vec::new();
        Some(self.sums(|cell| {
            corners.clear();
            corners.extend(cell.corners().map(|corner| turned[corner]));
            corners.push(corners[0]);
            Receiver::factor(&corners)
        }))
    }

    fn sums(&self, mut measure: impl FnMut(Cell<'_>) -> f64) -> Sums {
        let mut visible = Visible::none(self.scene().polygon_count());
        let mut seen = Vec::with_capacity(self.cell_count());
        let mut background = 0.0;
        // Cells that follow each other are mostly of one plane.
        let mut last: Option<(PlaneId, bool)> = None;
        for cell in self.cells() {
            let value = measure(cell);
            let Some(piece) = cell.piece() else {
                background += value;
                continue;
            };
            let piece = self.scene().piece(piece);
            let plane = piece.plane_id();
            let is_above = match last {
                Some((known, is_above)) if known == plane => is_above,
                _ => cell.side() == Some(piece.facing()),
            };
            last = Some((plane, is_above));
            visible.insert(piece.polygon());
            let side = if is_above { piece.facing() } else { piece.facing().opposite() };
            seen.push((piece.polygon(), side, value));
        }
        let mut polygons = Vec::with_capacity(visible.count());
        polygons.extend(visible.iter().map(|polygon| PolygonSum { polygon, front: 0.0, back: 0.0 }));
        // The cells of one polygon are added in their order.
        for (polygon, side, value) in seen {
            let sum = &mut polygons[visible.place(polygon)];
            *(if side == Side::Front { &mut sum.front } else { &mut sum.back }) += value;
        }
        Sums { polygons, background }
    }
}

impl Cell<'_> {
    /// Its solid angle in steradians; never negative.
    pub fn solid_angle(self) -> f64 {
        solid_angle(&self.boundary().collect::<Vec<_>>())
    }

    /// Its form factor; `None` if the domain has no normal. Never negative.
    pub fn form_factor(self) -> Option<f64> {
        let receiver = Receiver::new(self.image().normal()?);
        let corners: Vec<DVec3> =
            self.boundary().chain(self.boundary().take(1)).map(|corner| receiver.turned(corner)).collect();
        Some(Receiver::factor(&corners))
    }
}

impl VisibleRegion {
    /// Its solid angle in steradians, as part of its image: the sum over its cells.
    pub fn solid_angle(&self, image: &ContourImage) -> f64 {
        self.cells().iter().map(|&id| image.cell(id).solid_angle()).sum()
    }

    /// Its form factor likewise; `None` if the domain has no normal.
    pub fn form_factor(&self, image: &ContourImage) -> Option<f64> {
        self.cells().iter().map(|&id| image.cell(id).form_factor()).sum()
    }
}
