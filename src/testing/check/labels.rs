//! Cells show what rays meet.

use super::Defect;
use crate::contour::{Cell, ContourImage, Location};
use crate::scene::PieceId;
use crate::verify::{RayAnswer, RayOracle};
use glam::DVec3;
use std::collections::HashSet;

/// Directions about the middle of a cell, and nearer to two of its corners. They are strictly inside of it
/// unless it is so thin that rounding leads out of it: ask [`ContourImage::locate`].
pub fn inner_directions(cell: Cell<'_>) -> impl Iterator<Item = DVec3> {
    let sum: DVec3 = cell.boundary().sum();
    let nearer = cell.boundary().take(2).map(move |corner| sum + corner * 20.0);
    std::iter::once(sum).chain(nearer)
}

/// Checks that every cell shows the polygon, piece and side that a ray meets, in up to three directions
/// inside of it; gives the number of directions in which both had an answer. Where something is shown and
/// something is met, it is excused if either is a piece among
/// [`SceneBsp::uncut_slivers`](crate::bsp::SceneBsp::uncut_slivers): none if epsilon is 0.
///
/// # Errors
/// The first cell that shows something else.
pub fn check_labels(image: &ContourImage, oracle: &RayOracle) -> Result<usize, Defect> {
    let slivers: HashSet<PieceId> = image.uncut_slivers().iter().map(|sliver| sliver.piece).collect();
    let eye = image.viewpoint().eye();
    let mut compared = 0;
    for cell in image.cells() {
        let shown = cell.polygon().zip(cell.piece()).zip(cell.side());
        let shown = shown.map(|((polygon, piece), side)| (polygon, piece, side));
        for direction in inner_directions(cell) {
            if !matches!(image.locate(direction), Location::Cell(id) if id == cell.id()) {
                continue;
            }
            let ray = oracle.cast(eye, direction);
            let met = match ray {
                RayAnswer::Boundary => continue,
                RayAnswer::Miss => None,
                RayAnswer::Hit { polygon, piece, side } => Some((polygon, piece, side)),
            };
            compared += 1;
            let excused = match (shown, met) {
                (Some((_, a, _)), Some((_, b, _))) => slivers.contains(&a) || slivers.contains(&b),
                _ => false,
            };
            if shown != met && !excused {
                return Err(Defect::Label { cell: cell.id(), direction, shown, ray });
            }
        }
    }
    Ok(compared)
}
