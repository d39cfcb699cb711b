//! Contour images with a colour for each polygon.

use super::{Coverage, Picture, SizeError};
use crate::contour::{ContourImage, FlatRegion, Projector};
use crate::scene::PolygonId;
use glam::{DVec2, DVec3, UVec2};

/// How far, in pixels, a flattened curve may leave the true one.
const TOLERANCE: f64 = 0.02;

/// Draws the visible regions of an image in a projection, `width` pixels wide, each polygon in the linear colour that `colour` gives it (`None` is the
/// background); outside of what the picture shows, `outside`. Each pixel has the mean of what is in it, by exact areas. `done` is told of
/// each region that is painted, how many there are.
///
/// # Errors
/// If the picture would have no pixels, or too many.
pub fn flat_picture(
    image: &ContourImage,
    projector: &Projector,
    width: u32,
    outside: DVec3,
    mut colour: impl FnMut(Option<PolygonId>) -> DVec3,
    mut done: impl FnMut(usize),
) -> Result<Picture, SizeError> {
    let window = projector.window();
    let scale = f64::from(width) / window.size().x;
    let height = (window.size().y * scale).round().max(1.0);
    let size = UVec2::new(width, if height < f64::from(u32::MAX) { height as u32 } else { u32::MAX });
    let mut picture = Picture::new(size, outside)?;
    let mut coverage = Coverage::new(size);
    let place = |p: DVec2| DVec2::new(p.x - window.low.x, window.high.y - p.y) * scale;
    let regions = projector.regions(image, TOLERANCE / scale);
    let count = regions.len();
    for FlatRegion { polygon, exterior, holes, .. } in regions {
        coverage.clear();
        // Counter-clockwise with y up is clockwise with y down, and then holes run the other way.
        for ring in std::iter::once(&exterior).chain(&holes) {
            let ring: Vec<DVec2> = ring.iter().rev().map(|&p| place(p)).collect();
            coverage.add_ring(&ring);
        }
        picture.add(&coverage, colour(polygon) - outside);
        done(count);
    }
    Ok(picture)
}
