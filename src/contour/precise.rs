//! Corners of cells to twice the precision of `f64`, from their exact definitions.

use super::Horizon;
use super::directions::ExactCache;
use super::image::{Cell, ContourImage};
use crate::exact::U;
use glam::DVec3;

/// Computes corners of an image's cells. Vectors are sums of two, of any length.
pub(crate) struct Precise<'a> {
    image: &'a ContourImage,
    cache: ExactCache,
}

impl<'a> Precise<'a> {
    pub(crate) fn new(image: &'a ContourImage) -> Self {
        Self { image, cache: ExactCache::default() }
    }

    /// The receiver's normal, if the domain has one.
    pub(crate) fn normal(&mut self) -> Option<[DVec3; 2]> {
        match self.image.domain().horizon()? {
            Horizon::Normal(normal) => Some([normal, DVec3::ZERO]),
            Horizon::Surface => {
                let (piece, side) = self.image.viewpoint().surface_piece()?;
                let piece = self.image.scene().piece(piece);
                let directions = &self.image.tree.directions;
                let normal = directions.doubled_normal(self.image.skeleton(), piece.plane_id(), &mut self.cache);
                let is_up = piece.facing() == side;
                Some(normal.map(|part| if is_up { part } else { -part }))
            }
        }
    }

    /// The corners of a cell of the image, in the order of [`Cell::boundary`].
    pub(crate) fn corners(&mut self, cell: Cell<'_>) -> impl Iterator<Item = [DVec3; 2]> {
        let directions = &self.image.tree.directions;
        let skeleton = self.image.skeleton();
        cell.arcs().iter().map(move |arc| directions.doubled(skeleton, arc.from, &mut self.cache))
    }
}

impl Cell<'_> {
    /// A bound on how far, in radians, any of the corners in [`Cell::boundary`] is from the real one.
    pub(crate) fn corner_error(self) -> f64 {
        let directions = &self.image().tree.directions;
        let worst = self.arcs().iter().map(|arc| directions.approximation(arc.from).error_bound()).fold(0.0, f64::max);
        // Of three components, of a vector of length 1 at least; and what normalising it rounds.
        1.8 * worst + 4.0 * U
    }
}
