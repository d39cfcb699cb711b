//! Solid angles and form factors of what a contour image shows.

use super::form_factor::form_factor_of_rounded;
use super::{UnitDirection, solid_angle};
use crate::contour::{Cell, ContourImage, VisibleRegion};
use crate::scene::{ObjectId, PolygonId, Scene, Side};
use glam::DVec3;
use rustc_hash::FxHashMap;
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
        self.sums(solid_angle)
    }

    /// The form factor from the viewpoint (a differential element with the domain's normal) to each
    /// polygon: the share of diffusely emitted energy that arrives there. They sum to 1 with the
    /// background. `None` if the domain has no normal.
    pub fn form_factors(&self) -> Option<Sums> {
        let normal = self.normal()?;
        let normal = UnitDirection::new(normal)?;
        Some(self.sums(|corners| form_factor_of_rounded(corners, normal)))
    }

    fn sums(&self, measure: impl Fn(&[DVec3]) -> f64) -> Sums {
        // The place of every polygon that is seen: the cells of one are added in their order.
        let mut places = FxHashMap::default();
        let mut sums = Vec::new();
        let mut background = 0.0;
        let mut corners = Vec::new();
        for cell in self.cells() {
            corners.clear();
            corners.extend(cell.boundary());
            let value = measure(&corners);
            let (Some(polygon), Some(side)) = (cell.polygon(), cell.side()) else {
                background += value;
                continue;
            };
            let place = *places.entry(polygon).or_insert_with(|| {
                sums.push(PolygonSum { polygon, front: 0.0, back: 0.0 });
                sums.len() as u32 - 1
            });
            let sum = &mut sums[place as usize];
            *(if side == Side::Front { &mut sum.front } else { &mut sum.back }) += value;
        }
        sums.sort_unstable_by_key(|sum| sum.polygon);
        Sums { polygons: sums, background }
    }
}

impl Cell<'_> {
    /// Its solid angle in steradians; never negative.
    pub fn solid_angle(self) -> f64 {
        solid_angle(&self.boundary().collect::<Vec<_>>())
    }

    /// Its form factor; `None` if the domain has no normal. Never negative.
    pub fn form_factor(self) -> Option<f64> {
        let normal = UnitDirection::new(self.image().normal()?)?;
        Some(form_factor_of_rounded(&self.boundary().collect::<Vec<_>>(), normal))
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
