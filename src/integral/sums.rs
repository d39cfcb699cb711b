//! Solid angles and form factors of what a contour image shows.

use super::form_factor::form_factor_of_rounded;
use super::precise::{Bounded, PreciseFactors};
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

    /// The same, each sum with an error below 1e-9 of itself, or below 1e-24 if that is more: also of what is small, far, thin, cut off by
    /// other polygons or low above the horizon. `None` if the domain has no normal.
    ///
    /// Where the bound on the error of [`ContourImage::form_factors`] is more than that, corners are computed from their exact definitions
    /// to twice the precision of `f64`, and so is the integral (docs/integrals.md): a few microseconds a cell. Where it is not, the value is the same.
    ///
    /// ```
    /// use nusselt::contour::{Domain, SceneOrder, Viewpoint};
    /// use nusselt::scene::{Material, Scene};
    ///
    /// // A millimetre in ten kilometres, half of it behind a screen: the corners of what is seen are crossings.
    /// let far = [[-5e-4, -5e-4, 1e4], [5e-4, -5e-4, 1e4], [5e-4, 5e-4, 1e4], [-5e-4, 5e-4, 1e4]];
    /// let screen = [[0., -1., 1.], [1., -1., 1.], [1., 1., 1.], [0., 1., 1.]];
    /// let square = [vec![0, 1, 2, 3]];
    /// let builder = Scene::builder().mesh(&far, &square, Material::new("far"));
    /// let scene = builder.mesh(&screen, &square, Material::new("screen")).build()?;
    /// let up = Domain::Hemisphere(glam::DVec3::Z);
    /// let image = SceneOrder::new(&scene).view(&Viewpoint::free(glam::DVec3::ZERO), &up)?;
    /// let factors = image.precise_form_factors().expect("a hemisphere has a normal");
    /// let expected = 0.5e-6 / (std::f64::consts::PI * 1e8);
    /// assert!((factors.polygons[0].both() / expected - 1.0).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn precise_form_factors(&self) -> Option<Sums> {
        let normal = UnitDirection::new(self.normal()?)?;
        let mut places = Places::default();
        let mut sums: Vec<Bounded> = Vec::new();
        let mut corners = Vec::new();
        for cell in self.cells() {
            corners.clear();
            corners.extend(cell.boundary());
            let factor = form_factor_of_rounded(&corners, normal);
            let place = places.of(cell);
            sums.resize(sums.len().max(place + 1), Bounded::default());
            sums[place].add(Bounded::of(cell, &corners, normal.rounded(), factor));
        }
        let is_poor: Vec<bool> = sums.iter().map(|sum| sum.is_poor()).collect();
        if is_poor.contains(&true) {
            let mut precise = PreciseFactors::new(self)?;
            for (sum, _) in sums.iter_mut().zip(&is_poor).filter(|(_, is_poor)| **is_poor) {
                sum.value = 0.0;
            }
            for cell in self.cells() {
                let place = places.of(cell);
                if is_poor[place] {
                    sums[place].value += precise.of(cell);
                }
            }
        }
        Some(places.sums(|place| sums.get(place).map_or(0.0, |sum| sum.value)))
    }

    fn sums(&self, measure: impl Fn(&[DVec3]) -> f64) -> Sums {
        let mut places = Places::default();
        let mut sums = Vec::new();
        let mut corners = Vec::new();
        for cell in self.cells() {
            corners.clear();
            corners.extend(cell.boundary());
            let place = places.of(cell);
            sums.resize(sums.len().max(place + 1), 0.0);
            sums[place] += measure(&corners);
        }
        places.sums(|place| sums.get(place).copied().unwrap_or(0.0))
    }
}

/// A place for a sum of each side of each visible polygon, and the first one for the background: the cells of one are added in
/// their order.
#[derive(Default)]
struct Places {
    /// One more than half the place of the front. Not by all polygons: few may be seen of many.
    of_polygon: FxHashMap<PolygonId, u32>,
    visible: Vec<PolygonId>,
}

impl Places {
    fn of(&mut self, cell: Cell<'_>) -> usize {
        let (Some(polygon), Some(side)) = (cell.polygon(), cell.side()) else { return 0 };
        let visible = &mut self.visible;
        let number = *self.of_polygon.entry(polygon).or_insert_with(|| {
            visible.push(polygon);
            visible.len() as u32
        });
        number as usize * 2 - usize::from(side == Side::Front)
    }

    fn sums(mut self, at: impl Fn(usize) -> f64) -> Sums {
        self.visible.sort_unstable();
        let sum = |polygon: PolygonId| {
            let place = self.of_polygon[&polygon] as usize * 2;
            PolygonSum { polygon, front: at(place - 1), back: at(place) }
        };
        Sums { polygons: self.visible.iter().map(|&polygon| sum(polygon)).collect(), background: at(0) }
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
