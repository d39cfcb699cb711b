//! What a cell of a contour image shows: nothing, the same radiance all over, one that varies, or the sky.

use super::Sky;
use crate::contour::Cell;
use crate::scene::Side;
use glam::DVec3;
use std::borrow::Cow;

/// The radiance that comes from a cell, in W / (m^2 sr) or the scene's unit for it.
#[derive(Clone, Debug, PartialEq)]
pub enum Emission<'a> {
    /// The same from all of it.
    Constant(DVec3),
    /// At each vertex of the cell's piece, in the order of [`PieceRef::vertices`](crate::scene::PieceRef::vertices); between them linear in space, on the
    /// triangles of the fan about the first one. So radiosities are interpolated.
    Vertices(Cow<'a, [DVec3]>),
    /// By direction.
    Sky(&'a Sky),
}

impl Emission<'_> {
    /// Nothing.
    pub const NONE: Self = Self::Constant(DVec3::ZERO);
}

impl From<DVec3> for Emission<'_> {
    fn from(radiance: DVec3) -> Self {
        Self::Constant(radiance)
    }
}

/// The radiance that a cell shows if polygons emit what their materials say, from their fronts only, and the background nothing.
pub fn emitted(cell: Cell<'_>) -> DVec3 {
    if cell.side() == Some(Side::Front) { emitted_by_both_sides(cell) } else { DVec3::ZERO }
}

/// The same if polygons emit from both of their sides.
pub fn emitted_by_both_sides(cell: Cell<'_>) -> DVec3 {
    let of = |polygon| DVec3::from(cell.image().scene().polygon(polygon).material().emission);
    cell.polygon().map_or(DVec3::ZERO, of)
}
