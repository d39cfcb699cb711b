//! The radiance that a surface reflects from what a contour image shows.

use super::emission::Emission;
use super::frame::Frame;
use super::reflect::{Surroundings, reflect, reflect_varying};
use super::seen::Seen;
use super::{Brdf, Light, RgbEstimate};
use crate::contour::{Cell, CellId, ContourImage, Region};
use crate::integral::CubatureOptions;
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
    /// The radiances at the vertices of a cell's piece are not as many as those, or are of a cell that shows none.
    #[error("cell {} shows a piece of {vertices} vertices, and {radiances} radiances are given for them", cell.0)]
    WrongVertices {
        /// Where.
        cell: CellId,
        /// How many vertices its piece has; 0 for background.
        vertices: usize,
        /// How many radiances were given.
        radiances: usize,
    },
    /// A light is where the surface is or in no direction, or its strength is not a number or negative.
    #[error(
        "the {0} lights nothing here: it takes a finite direction away from the surface, and finite numbers that are not negative"
    )]
    BadLight(Light),
}

/// A surface that reflects towards a viewer.
pub(crate) struct Place {
    frame: Frame,
    /// Towards the viewer, in the surface's frame.
    pub(crate) outgoing: DVec3,
}

impl Place {
    pub(crate) fn new(image: &ContourImage, tangent: Option<DVec3>, view: DVec3) -> Result<Self, ReflectError> {
        Self::at(image.normal().ok_or(ReflectError::NoNormal)?, tangent, view)
    }

    /// By the surface's unit normal.
    pub(crate) fn at(normal: DVec3, tangent: Option<DVec3>, view: DVec3) -> Result<Self, ReflectError> {
        let frame = Frame::new(normal, tangent).ok_or(ReflectError::BadTangent(tangent.unwrap_or_default()))?;
        let outgoing = (view / view.abs().max_element()).try_normalize().map(|unit| frame.to_local(unit));
        let outgoing = outgoing.filter(|outgoing| outgoing.z > 0.0).ok_or(ReflectError::BadView(view))?;
        Ok(Self { frame, outgoing })
    }

    /// From the scene's directions to the surface's.
    pub(crate) fn to_local(&self, direction: DVec3) -> DVec3 {
        self.frame.to_local(direction)
    }

    /// And back.
    pub(crate) fn to_scene(&self, direction: DVec3) -> DVec3 {
        self.frame.to_scene(direction)
    }
}

/// The radiance that a surface at the viewpoint reflects towards a viewer, from what is seen in all directions above it.
///
/// `image` is of a hemisphere, or of windows that end at a horizon: what is outside of its domain counts as black. `tangent` is
/// the surface's x direction, of any length, made perpendicular to its normal; it matters to anisotropic models only. `view` points from the surface
/// towards the viewer, with any length. `emission` tells the radiance of a cell, as an [`Emission`] or, if it is the same all over, as a colour:
/// [`emitted`](super::emitted()), radiosities, a sky. [`Lighting`](super::Lighting) puts the usual ones together.
///
/// Lobes and series of spherical harmonics are integrated in closed form and everything else by cubature to the tolerance of `options`, for each part of a sum, and
/// apart for what is the same all over a cell, linear radiances, and the sky; mirrors
/// show the cell that holds the mirror direction, exactly as rounded. If that lies between cells the value is that of one of
/// them, and the error how much others differ. The cost is O(corners of cells that emit), times the exponent of a lobe that reaches them, or a
/// few hundred evaluations of the BRDF a cell.
///
/// # Errors
/// If the image has no horizon, or a direction or a radiance is not fit for use.
pub fn reflected_radiance<'e, E: Into<Emission<'e>>>(
    image: &ContourImage,
    brdf: &dyn Brdf,
    tangent: Option<DVec3>,
    view: DVec3,
    emission: impl Fn(Cell<'_>) -> E,
    options: CubatureOptions,
) -> Result<RgbEstimate, ReflectError> {
    let place = Place::new(image, tangent, view)?;
    let outgoing = place.outgoing;
    let seen = Seen::new(image, place.frame, |cell| emission(cell).into())?;
    let from = |direction: DVec3| {
        let direction = place.to_scene(direction);
        let regions = image.locate(direction).regions();
        let radiances = regions.iter().map(|&region| match region {
            Region::Cell(cell) => {
                let cell = image.cell(cell);
                emission(cell).into().towards(cell, direction)
            }
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
    let surroundings = Surroundings { lit: &seen.lit, from: &from };
    let mut sum = reflect(brdf.form(outgoing), &eval, outgoing, &surroundings, options);
    sum += reflect_varying(brdf.form(outgoing), &eval, outgoing, &seen, options);
    Ok(sum)
}

/// The albedo of a surface at the viewpoint towards a viewer: [`Brdf::albedo`] in the scene's directions, given as for [`reflected_radiance`].
///
/// # Errors
/// If the image has no horizon, or a direction is not fit for use.
pub fn albedo_towards(
    image: &ContourImage,
    brdf: &dyn Brdf,
    tangent: Option<DVec3>,
    view: DVec3,
) -> Result<RgbEstimate, ReflectError> {
    Ok(brdf.albedo(Place::new(image, tangent, view)?.outgoing))
}
