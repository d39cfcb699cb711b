//! What lights surfaces besides polygons that emit, as it is said on the command line.

use crate::args::{parse_direction, parse_point};
use crate::brdf::colour;
use crate::failure::Failure;
use glam::DVec3;
use nusselt::brdf::{Light, Lighting, Sky, SkyError};

/// The sky, and lights without extent.
#[derive(clap::Args)]
pub(crate) struct Lights {
    /// The sky, seen where nothing else is: constant:L, overcast:L (CIE, L at the zenith) or clear:L:X,Y,Z (CIE, with the sun
    /// towards X,Y,Z; the sun itself is a --directional-light). L is a radiance, one number or R,G,B [default: black]
    #[arg(long, value_name = "SKY", value_parser = SkySpec::parse)]
    sky: Option<SkySpec>,
    /// Towards the zenith of an overcast or clear sky [default: 0,0,1]
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_direction, allow_hyphen_values = true, requires = "sky")]
    sky_up: Option<DVec3>,
    /// A light at a point, of radiant intensity I, one number or R,G,B. May be repeated
    #[arg(long, value_name = "X,Y,Z:I", value_parser = parse_point_light, allow_hyphen_values = true)]
    point_light: Vec<Light>,
    /// A light towards X,Y,Z, infinitely far away, that lights a surface which faces it by the irradiance E. May be repeated
    #[arg(long, value_name = "X,Y,Z:E", value_parser = parse_directional_light, allow_hyphen_values = true)]
    directional_light: Vec<Light>,
}

impl Lights {
    pub(crate) fn lighting(&self, is_two_sided: bool) -> Result<Lighting, Failure> {
        let up = self.sky_up.unwrap_or(DVec3::Z);
        let sky = self.sky.map(|sky| sky.sky(up)).transpose();
        Ok(Lighting {
            is_two_sided,
            sky: sky.map_err(|error| Failure::Usage(format!("--sky: {error}")))?,
            lights: self.point_light.iter().chain(&self.directional_light).copied().collect(),
        })
    }
}

/// A sky, before it is known which way is up.
#[derive(Clone, Copy)]
enum SkySpec {
    Constant(DVec3),
    Overcast(DVec3),
    Clear { zenith: DVec3, sun: DVec3 },
}

impl SkySpec {
    fn parse(text: &str) -> Result<Self, String> {
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

    fn sky(self, up: DVec3) -> Result<Sky, SkyError> {
        match self {
            Self::Constant(radiance) => Sky::constant(radiance),
            Self::Overcast(zenith) => Sky::overcast(zenith, up),
            Self::Clear { zenith, sun } => Sky::clear(zenith, up, sun),
        }
    }
}

/// `X,Y,Z:I`.
fn parse_point_light(text: &str) -> Result<Light, String> {
    let (position, intensity) = text.split_once(':').ok_or("it takes the form X,Y,Z:I")?;
    Ok(Light::Point { position: parse_point(position)?, intensity: strength(intensity)? })
}

/// `X,Y,Z:E`.
fn parse_directional_light(text: &str) -> Result<Light, String> {
    let (towards, irradiance) = text.split_once(':').ok_or("it takes the form X,Y,Z:E")?;
    Ok(Light::Directional { towards: parse_direction(towards)?, irradiance: strength(irradiance)? })
}

fn strength(text: &str) -> Result<DVec3, String> {
    let colour = colour(text)?;
    if colour.min_element() >= 0.0 { Ok(colour) } else { Err(format!("{text} is negative")) }
}
