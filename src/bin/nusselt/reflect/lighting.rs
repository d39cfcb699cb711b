//! What lights the surface, as it is said on the command line.

use crate::args::{parse_direction, parse_point};
use crate::brdf::colour;
use glam::DVec3;
use nusselt::brdf::{Light, Sky, SkyError};

/// A sky, before it is known which way is up.
#[derive(Clone, Copy)]
pub(super) enum SkySpec {
    Constant(DVec3),
    Overcast(DVec3),
    Clear { zenith: DVec3, sun: DVec3 },
}

impl SkySpec {
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let fields: Vec<&str> = text.split(':').collect();
        let spec = match fields[..] {
            ["constant", radiance] => Self::Constant(colour(radiance)?),
            ["overcast", zenith] => Self::Overcast(colour(zenith)?),
            ["clear", zenith, sun] => Self::Clear { zenith: colour(zenith)?, sun: parse_direction(sun)? },
            _ => return Err("it takes the form constant:L, overcast:L or clear:L:X,Y,Z".to_owned()),
        };
        // Whatever is up, this much can be told.
        Sky::constant(match spec {
            Self::Constant(radiance) | Self::Overcast(radiance) | Self::Clear { zenith: radiance, .. } => radiance,
        })
        .map_err(|error| error.to_string())?;
        Ok(spec)
    }

    pub(super) fn sky(self, up: DVec3) -> Result<Sky, SkyError> {
        match self {
            Self::Constant(radiance) => Sky::constant(radiance),
            Self::Overcast(zenith) => Sky::overcast(zenith, up),
            Self::Clear { zenith, sun } => Sky::clear(zenith, up, sun),
        }
    }
}

/// `X,Y,Z:I`.
pub(super) fn parse_point_light(text: &str) -> Result<Light, String> {
    let (position, intensity) = text.split_once(':').ok_or("it takes the form X,Y,Z:I")?;
    Ok(Light::Point { position: parse_point(position)?, intensity: strength(intensity)? })
}

/// `X,Y,Z:E`.
pub(super) fn parse_directional_light(text: &str) -> Result<Light, String> {
    let (towards, irradiance) = text.split_once(':').ok_or("it takes the form X,Y,Z:E")?;
    Ok(Light::Directional { towards: parse_direction(towards)?, irradiance: strength(irradiance)? })
}

fn strength(text: &str) -> Result<DVec3, String> {
    let colour = colour(text)?;
    if colour.min_element() >= 0.0 { Ok(colour) } else { Err(format!("{text} is negative")) }
}
