//! The radiance that a surface reflects from what a contour image shows.

use super::frame::Frame;
use super::reflect::{Lit, Surroundings, reflect};
use super::{Brdf, RgbEstimate};
use crate::contour::{Cell, CellId, ContourImage, Region};
use crate::integral::CubatureOptions;
use crate::scene::Side;
use glam::DVec3;

/// Why there is no reflected radiance.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReflectError {
    /// The image is of a sphere or of a camera's directions: there is no surface.
    #[error("only what is above a surface is reflected by it: take a view of a hemisphere")]
    NoNormal,
    /// The tangent has no direction along the surface.
    #[error("the tangent {0} is not a direction along the surface")]
    BadTangent(DVec3),
    /// The direction towards the viewer is not one above the surface.
    #[error("the direction {0} towards the viewer is not above the surface")]
    BadView(DVec3),
    /// An emission is not a number, or negative.
    #[error("cell {} emits {emission}: radiances have to be finite and not negative", cell.0)]
    BadEmission {
        /// Where.
        cell: CellId,
        /// What was given.
        emission: DVec3,
    },
}

/// The radiance that a cell shows if polygons emit what their materials say, from their fronts only, and the background nothing.
pub fn emitted(cell: Cell<'_>) -> DVec3 {
    match (cell.polygon(), cell.side()) {
        (Some(polygon), Some(Side::Front)) => DVec3::from(cell.image().scene().polygon(polygon).material().emission),
        _ => DVec3::ZERO,
    }
}

/// The radiance that a surface at the viewpoint reflects towards a viewer, from what is seen in all directions above it.
///
/// `image` is of a hemisphere, or of windows that end at a horizon: what is outside of its domain counts as black. `tangent` is
/// the surface's x direction, of any length, made perpendicular to its normal; it matters to anisotropic models only. `view` points from the surface
/// towards the viewer, with any length. `emission` tells the radiance of a cell: [`emitted`], or anything else that
/// is the same all over a cell, such as radiosities or a sky.
///
/// Lobes and series of spherical harmonics are integrated in closed form and everything else by cubature to the tolerance of `options`, for each part of a sum; mirrors
/// show the cell that holds the mirror direction, exactly as rounded. If that lies between cells the value is that of one of
/// them, and the error how much others differ. The cost is O(corners of cells that emit), times the exponent of a lobe that reaches them, or a
/// few hundred evaluations of the BRDF a cell.
///
/// # Errors
/// If the image has no horizon, or a direction or a radiance is not fit for use.
pub fn reflected_radiance(
    image: &ContourImage,
    brdf: &dyn Brdf,
    tangent: Option<DVec3>,
    view: DVec3,
    emission: impl Fn(Cell<'_>) -> DVec3,
    options: CubatureOptions,
) -> Result<RgbEstimate, ReflectError> {
    let normal = image.normal().ok_or(ReflectError::NoNormal)?;
    let frame = Frame::new(normal, tangent).ok_or(ReflectError::BadTangent(tangent.unwrap_or_default()))?;
    let outgoing = (view / view.abs().max_element()).try_normalize().map(|unit| frame.to_local(unit));
    let outgoing = outgoing.filter(|outgoing| outgoing.z > 0.0).ok_or(ReflectError::BadView(view))?;
    let mut lit = Vec::new();
    let mut boundary = Vec::new();
    for cell in image.cells() {
        let radiance = emission(cell);
        if !(radiance.is_finite() && radiance.min_element() >= 0.0) {
            return Err(ReflectError::BadEmission { cell: cell.id(), emission: radiance });
        }
        if radiance.max_element() > 0.0 {
            boundary.clear();
            boundary.extend(cell.boundary().map(|corner| frame.to_local(corner)));
            lit.extend(Lit::new(&boundary, radiance));
        }
    }
    let from = |direction: DVec3| {
        let regions = image.locate(frame.to_scene(direction)).regions();
        let radiances = regions.iter().map(|&region| match region {
            Region::Cell(cell) => emission(image.cell(cell)),
            Region::Outside => DVec3::ZERO,
        });
        let mut sum: Option<RgbEstimate> = None;
        for radiance in radiances {
            let estimate = sum.get_or_insert(RgbEstimate { value: radiance, error: DVec3::ZERO });
            estimate.error = estimate.error.max((radiance - estimate.value).abs());
        }
        sum.unwrap_or_default()
    };
    let eval = |incoming| brdf.eval(incoming, outgoing);
    Ok(reflect(brdf.form(outgoing), &eval, outgoing, &Surroundings { lit: &lit, from: &from }, options))
}
