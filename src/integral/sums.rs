//! Solid angles and form factors of what a contour image shows.

use super::precise::{Bounded, PreciseFactors};
use super::receiver::Receiver;
use super::solid_angle;
use super::visible::Visible;
use crate::contour::{Cell, ContourImage, VisibleRegion};
use crate::scene::{ObjectId, PieceRef, PlaneId, PolygonId, Scene, Side};
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
        Some(self.sums(|cell| Receiver::factor(cell.corners().map(|corner| turned[corner]))))
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
        let normal = self.normal()?;
        let receiver = Receiver::new(normal);
        let places = Places::of(self);
        let mut sums = vec![Bounded::default(); places.count()];
        let mut corners = Vec::new();
        let mut turned = Vec::new();
        for (cell, &place) in self.cells().zip(&places.of_cells) {
            corners.clear();
            corners.extend(cell.boundary());
            turned.clear();
            turned.extend(corners.iter().map(|&corner| receiver.turned(corner)));
            let factor = Receiver::factor(turned.iter().copied());
            sums[place as usize].add(Bounded::of(cell, &corners, normal, factor));
        }
        let is_poor: Vec<bool> = sums.iter().map(|sum| sum.is_poor()).collect();
        if is_poor.contains(&true) {
            let mut precise = PreciseFactors::new(self)?;
            for (sum, _) in sums.iter_mut().zip(&is_poor).filter(|(_, is_poor)| **is_poor) {
                sum.value = 0.0;
            }
            for (cell, &place) in self.cells().zip(&places.of_cells) {
                if is_poor[place as usize] {
                    sums[place as usize].value += precise.of(cell);
                }
            }
        }
        Some(places.sums(|place| sums[place].value))
    }

    fn sums(&self, mut measure: impl FnMut(Cell<'_>) -> f64) -> Sums {
        let places = Places::of(self);
        let mut sums = vec![0.0; places.count()];
        for (cell, &place) in self.cells().zip(&places.of_cells) {
            sums[place as usize] += measure(cell);
        }
        places.sums(|place| sums[place])
    }
}

/// A place for a sum of each side of each visible polygon, ascending, after one for the background: the cells of one are added in
/// their order.
struct Places {
    of_cells: Vec<u32>,
    visible: Vec<PolygonId>,
}

impl Places {
    fn of(image: &ContourImage) -> Self {
        let scene = image.scene();
        let mut visible = Visible::none(scene.polygon_count());
        // Cells that follow each other are mostly of one plane.
        let mut last: Option<(PlaneId, Side)> = None;
        let mut side_of = |cell: Cell<'_>, piece: PieceRef<'_>| {
            let plane = piece.plane_id();
            let above = match last {
                Some((known, above)) if known == plane => above,
                _ if cell.side() == Some(piece.facing()) => Side::Front,
                _ => Side::Back,
            };
            last = Some((plane, above));
            if above == Side::Front { piece.facing() } else { piece.facing().opposite() }
        };
        let seen: Vec<Option<(PolygonId, Side)>> = image
            .cells()
            .map(|cell| {
                let piece = scene.piece(cell.piece()?);
                visible.insert(piece.polygon());
                Some((piece.polygon(), side_of(cell, piece)))
            })
            .collect();
        let mut polygons = Vec::with_capacity(visible.count());
        polygons.extend(visible.iter());
        let place = |seen: Option<(PolygonId, Side)>| {
            seen.map_or(0, |(polygon, side)| {
                2 * visible.place(polygon) as u32 + if side == Side::Front { 1 } else { 2 }
            })
        };
        Self { of_cells: seen.into_iter().map(place).collect(), visible: polygons }
    }

    fn count(&self) -> usize {
        2 * self.visible.len() + 1
    }

    fn sums(self, at: impl Fn(usize) -> f64) -> Sums {
        let of = |(k, polygon): (usize, PolygonId)| PolygonSum { polygon, front: at(2 * k + 1), back: at(2 * k + 2) };
        Sums { polygons: self.visible.into_iter().enumerate().map(of).collect(), background: at(0) }
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
        Some(Receiver::factor(self.boundary().map(|corner| receiver.turned(corner))))
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
