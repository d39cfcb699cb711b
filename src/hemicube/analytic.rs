//! Visibility by z-buffer, form factors by formula.
//!
//! Baum, Rushmeier and Winget (1989) replace the hemicube's form factors by Lambert's formula and let the
//! hemicube tell only what is visible. Our reading, for a differential receiver:
//!
//! - a piece that is seen in every pixel it covers counts as wholly visible: it gets its analytic form factor, clipped
//!   at the horizon. One evaluation;
//! - a piece that is seen in some of its pixels only gets the analytic form factors of those pixels' rectangles. One evaluation
//!   for each pixel, however they are tabulated;
//! - a piece that is seen in no pixel is lost, as on the hemicube.
//!
//! It is a fair reading: where visibility has no part in it, the result is exact; where it has, visibility is known
//! at pixels only, and so the part that is seen is known as a set of pixels; every formula is exact for what it is
//! applied to. The sum over everything is not 1 any more.

use super::error::BaselineError;
use super::view::{Hemicube, HemicubeStats};
use crate::contour::Viewpoint;
use crate::integral::form_factor;
use crate::scene::PolygonId;
use glam::DVec3;

/// What a hemicube shows, with analytic form factors.
#[derive(Clone, Copy, Debug)]
pub struct AnalyticView<'a> {
    hemicube: &'a Hemicube,
    stats: HemicubeStats,
    whole: usize,
    evaluations: usize,
}

impl Hemicube {
    /// As [`Hemicube::view`], but the z-buffer only tells what is visible: pieces that are seen in every pixel they cover have their
    /// analytic form factor, and others those of the pixels they are seen in.
    ///
    /// # Errors
    /// As [`Hemicube::view`].
    pub fn analytic(&mut self, viewpoint: &Viewpoint, normal: DVec3) -> Result<AnalyticView<'_>, BaselineError> {
        let stats = self.draw(viewpoint, normal)?;
        self.sum_by_piece();
        let mut whole = 0;
        let mut evaluations = 0;
        self.factors.fill(0.0);
        let mut outline = Vec::new();
        for (piece, &(sum, seen)) in self.pixels.iter().enumerate() {
            let factor = match self.covered.get(piece) {
                Some(&covered) if seen > 0 && seen == covered => {
                    whole += 1;
                    evaluations += 1;
                    self.outline(piece, &mut outline);
                    form_factor(&outline, DVec3::Z)
                }
                _ => {
                    evaluations += seen as usize;
                    sum
                }
            };
            self.factors[self.polygons[piece] as usize] += factor;
        }
        Ok(AnalyticView { hemicube: self, stats, whole, evaluations })
    }

    /// A piece above the horizon, in the hemicube's frame, as integrals want it.
    fn outline(&self, piece: usize, outline: &mut Vec<DVec3>) {
        outline.clear();
        let corners = || self.geometry.corners(piece).iter().map(|&k| DVec3::from(self.seen.positions[k as usize]));
        for (a, b) in corners().zip(corners().cycle().skip(1)) {
            if a.z >= 0.0 {
                outline.push(a);
            }
            if (a.z > 0.0 && b.z < 0.0) || (a.z < 0.0 && b.z > 0.0) {
                // The same point from both pieces at an edge.
                let [low, high] = if a.z < b.z { [a, b] } else { [b, a] };
                outline.push((high * -low.z + low * high.z).with_z(0.0));
            }
        }
        let area: DVec3 = outline.iter().zip(outline.iter().cycle().skip(1)).map(|(a, b)| a.cross(*b)).sum();
        if outline.first().is_some_and(|first| area.dot(*first) < 0.0) {
            outline.reverse();
        }
    }
}

impl<'a> AnalyticView<'a> {
    /// The form factor of every polygon by its number, 0 for those that are not seen.
    pub fn factors(&self) -> &'a [f64] {
        let factors = &self.hemicube.factors;
        &factors[..factors.len() - 1]
    }

    /// The form factor of a polygon.
    ///
    /// # Panics
    /// If there is no polygon of that number.
    pub fn of(&self, polygon: PolygonId) -> f64 {
        self.factors()[polygon.index()]
    }

    /// The pixels where nothing is seen.
    pub fn background(&self) -> f64 {
        self.hemicube.factors[self.hemicube.factors.len() - 1]
    }

    /// Over all polygons and the background: near 1.
    pub fn total(&self) -> f64 {
        self.hemicube.factors.iter().sum()
    }

    /// How many pieces counted as wholly visible.
    pub fn whole(&self) -> usize {
        self.whole
    }

    /// Form factors evaluated: one for each wholly visible piece, and one for each pixel of the others and of the background.
    pub fn evaluations(&self) -> usize {
        self.evaluations
    }

    /// What the z-buffer took.
    pub fn stats(&self) -> HemicubeStats {
        self.stats
    }
}
