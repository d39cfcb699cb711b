//! Lights without extent, and all that lights a surface together.

use super::emission::{Emission, emitted, emitted_by_both_sides};
use super::reflected::{Place, reflected_radiance};
use super::{Brdf, ReflectError, RgbEstimate, Sky};
use crate::contour::{Cell, ContourImage, Region};
use crate::integral::CubatureOptions;
use glam::DVec3;
use std::fmt;

/// A source of light without extent. It is hidden by whatever is in front of it, and seen by no mirror.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// At a place.
    Point {
        /// Where it is.
        position: DVec3,
        /// The radiant intensity, in W / sr, the same in all directions.
        intensity: DVec3,
    },
    /// Infinitely far away, like the sun.
    Directional {
        /// Towards the light, with any length.
        towards: DVec3,
        /// The irradiance of a surface that faces it, in W / m^2.
        irradiance: DVec3,
    },
}

impl fmt::Display for Light {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Point { position: p, intensity: i } => {
                write!(f, "light at {},{},{} of intensity {},{},{}", p.x, p.y, p.z, i.x, i.y, i.z)
            }
            Self::Directional { towards: d, irradiance: e } => {
                write!(f, "light towards {},{},{} of irradiance {},{},{}", d.x, d.y, d.z, e.x, e.y, e.z)
            }
        }
    }
}

/// All that lights a surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lighting {
    /// Polygons emit from their backs too.
    pub is_two_sided: bool,
    /// What is seen where nothing else is; black by default.
    pub sky: Option<Sky>,
    /// Lights without extent.
    pub lights: Vec<Light>,
}

impl Lighting {
    /// The radiance that a surface at the viewpoint of an image reflects towards a viewer: [`reflected_radiance`] of what polygons emit and of
    /// the sky, and what comes from the lights.
    ///
    /// A light is visible or not, exactly: the image is asked what is seen in its exact direction, and on which side of that polygon's plane it is. A light in
    /// the plane of a polygon is not hidden by it, and one whose direction lies between two cells gets the value of one of them, with
    /// an error that tells how much others differ. O(depth of the contour tree) for each light.
    ///
    /// # Errors
    /// Those of [`reflected_radiance`], or if a light is not fit for use.
    pub fn reflected(
        &self,
        image: &ContourImage,
        brdf: &dyn Brdf,
        tangent: Option<DVec3>,
        view: DVec3,
        options: CubatureOptions,
    ) -> Result<RgbEstimate, ReflectError> {
        let emission = |cell: Cell<'_>| match (cell.polygon(), self.is_two_sided) {
            (None, _) => self.sky.as_ref().map_or(Emission::NONE, Emission::Sky),
            (Some(_), false) => emitted(cell).into(),
            (Some(_), true) => emitted_by_both_sides(cell).into(),
        };
        let mut sum = reflected_radiance(image, brdf, tangent, view, emission, options)?;
        let place = Place::new(image, tangent, view)?;
        for light in &self.lights {
            sum += light.reflected(image, brdf, &place)?;
        }
        Ok(sum)
    }
}

impl Light {
    fn reflected(&self, image: &ContourImage, brdf: &dyn Brdf, place: &Place) -> Result<RgbEstimate, ReflectError> {
        let full = self.unhidden(image.viewpoint().eye(), brdf, place)?;
        let location = match *self {
            Self::Point { position, .. } => image.locate_point(position),
            Self::Directional { towards, .. } => image.locate(towards),
        };
        let regions = location.regions();
        let mut shares = regions.iter().map(|&region| self.is_seen_in(image, region));
        let first = shares.next().unwrap_or(false);
        let is_undecided = shares.any(|is_seen| is_seen != first);
        Ok(RgbEstimate {
            value: if first { full } else { DVec3::ZERO },
            error: if is_undecided { full } else { DVec3::ZERO },
        })
    }

    /// Refuses places, directions and strengths that are none.
    pub(crate) fn check(&self) -> Result<(), ReflectError> {
        let (place, strength) = match *self {
            Self::Point { position, intensity } => (Some(position), intensity),
            Self::Directional { towards, irradiance } => {
                ((towards / towards.abs().max_element()).try_normalize(), irradiance)
            }
        };
        let is_fit = place.is_some_and(DVec3::is_finite) && strength.is_finite() && strength.min_element() >= 0.0;
        if is_fit { Ok(()) } else { Err(ReflectError::BadLight(*self)) }
    }

    /// What a surface at `eye` reflects of it if nothing is in the way. A point light that is there itself, or so near that its irradiance is more than numbers hold, is not fit for it.
    pub(crate) fn unhidden(&self, eye: DVec3, brdf: &dyn Brdf, place: &Place) -> Result<DVec3, ReflectError> {
        let (towards, irradiance) = match *self {
            Self::Point { position, intensity } => {
                // Scaled, so that no square over- or underflows.
                let offset = position - eye;
                let most = offset.abs().max_element();
                let scaled = offset / most;
                (scaled, intensity / most / most / scaled.length_squared())
            }
            Self::Directional { towards, irradiance } => (towards / towards.abs().max_element(), irradiance),
        };
        let unit = towards.try_normalize().ok_or(ReflectError::BadLight(*self))?;
        if !(irradiance.is_finite() && irradiance.min_element() >= 0.0) {
            return Err(ReflectError::BadLight(*self));
        }
        let incoming = place.to_local(unit);
        Ok(brdf.eval(incoming, place.outgoing) * irradiance * incoming.z.max(0.0))
    }

    /// True if nothing that is seen in a region which its direction is in hides it.
    fn is_seen_in(&self, image: &ContourImage, region: Region) -> bool {
        let Region::Cell(cell) = region else { return false };
        let Some(piece) = image.cell(cell).piece() else { return true };
        match *self {
            Self::Directional { .. } => false,
            Self::Point { position, .. } => !image.is_behind(piece, position),
        }
    }
}
