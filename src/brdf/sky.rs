//! The radiance of the sky, seen where nothing else is.

use crate::integral::Peak;
use glam::DVec3;

/// The radiance of a sky by direction.
///
/// Overcast and clear skies are those of the CIE, given by the radiance Lz at the zenith; with g the angle above the sky's horizon:
///
/// - overcast (Moon and Spencer 1942; CIE 1955): L = Lz (1 + 2 sin g) / 3. A level surface gets the irradiance 7 pi Lz / 9;
/// - clear (Kittler 1967; CIE 22, 1973), with c the angle to the sun and z that between the sun and the zenith: L = Lz f(c) p(g) / (f(z) p(90 deg)),
///   f(c) = 0.91 + 10 exp(-3 c) + 0.45 cos(c)^2, p(g) = 1 - exp(-0.32 / sin g). The sun itself is not in it: it is a
///   [`Light::Directional`](super::Light::Directional).
///
/// Below their horizon both are black: the ground is up to the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sky(Kind);

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Constant(DVec3),
    Overcast {
        zenith: DVec3,
        up: DVec3,
    },
    /// With the radiance over f p.
    Clear {
        scale: DVec3,
        up: DVec3,
        sun: DVec3,
    },
}

/// Why there is no such sky.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SkyError {
    /// A radiance is negative or not a number.
    #[error("a radiance of the sky has to be finite and not negative, not {0}")]
    BadRadiance(DVec3),
    /// Up, or the sun, is no direction.
    #[error("{0} is not a direction")]
    BadDirection(DVec3),
    /// The sun is not above the horizon.
    #[error("the sun at {0} is not above the horizon: it takes a direction with sun.up > 0")]
    SunBelow(DVec3),
}

impl Sky {
    /// The same from all directions, also from below.
    ///
    /// # Errors
    /// If the radiance is negative or not finite.
    pub fn constant(radiance: DVec3) -> Result<Self, SkyError> {
        Ok(Self(Kind::Constant(sound(radiance)?)))
    }

    /// Overcast, of that radiance at the zenith. `up` points there, with any length.
    ///
    /// # Errors
    /// If the radiance is negative or not finite, or `up` zero or not finite.
    pub fn overcast(zenith: DVec3, up: DVec3) -> Result<Self, SkyError> {
        Ok(Self(Kind::Overcast { zenith: sound(zenith)?, up: unit(up)? }))
    }

    /// Clear, of that radiance at the zenith, with the sun in a direction of any length.
    ///
    /// # Errors
    /// As for [`Sky::overcast`], or if the sun is not above the horizon.
    pub fn clear(zenith: DVec3, up: DVec3, sun: DVec3) -> Result<Self, SkyError> {
        let (zenith, up, unit_sun) = (sound(zenith)?, unit(up)?, unit(sun)?);
        if up.dot(unit_sun) <= 0.0 {
            return Err(SkyError::SunBelow(sun));
        }
        let scale = zenith / (scattering(up, unit_sun) * gradation(1.0));
        Ok(Self(Kind::Clear { scale, up, sun: unit_sun }))
    }

    /// From a unit direction.
    pub fn radiance(&self, direction: DVec3) -> DVec3 {
        match self.0 {
            Kind::Constant(radiance) => radiance,
            Kind::Overcast { zenith, up } => match up.dot(direction) {
                height if height > 0.0 => zenith * ((1.0 + 2.0 * height) / 3.0),
                _ => DVec3::ZERO,
            },
            Kind::Clear { scale, up, sun } => match up.dot(direction) {
                height if height > 0.0 => scale * (scattering(direction, sun) * gradation(height)),
                _ => DVec3::ZERO,
            },
        }
    }

    /// The radiance, if it is the same from everywhere.
    pub fn as_constant(&self) -> Option<DVec3> {
        match self.0 {
            Kind::Constant(radiance) => Some(radiance),
            Kind::Overcast { .. } | Kind::Clear { .. } => None,
        }
    }

    /// The same sky in other axes.
    pub(super) fn turned(&self, turn: impl Fn(DVec3) -> DVec3) -> Self {
        Self(match self.0 {
            Kind::Constant(radiance) => Kind::Constant(radiance),
            Kind::Overcast { zenith, up } => Kind::Overcast { zenith, up: turn(up) },
            Kind::Clear { scale, up, sun } => Kind::Clear { scale, up: turn(up), sun: turn(sun) },
        })
    }

    /// Up from the horizon below which it is black.
    pub(super) fn horizon(&self) -> Option<DVec3> {
        match self.0 {
            Kind::Constant(_) => None,
            Kind::Overcast { up, .. } | Kind::Clear { up, .. } => Some(up),
        }
    }

    /// No direction has more.
    pub(super) fn most(&self) -> DVec3 {
        match self.0 {
            Kind::Constant(most) | Kind::Overcast { zenith: most, .. } => most,
            Kind::Clear { scale, .. } => scale * 11.36,
        }
    }

    /// Where it changes fast. About the sun the radiance is a cone: its tip is to be in a triangle so small that it does not matter.
    pub(super) fn peak(&self) -> Option<Peak> {
        match self.0 {
            Kind::Constant(_) | Kind::Overcast { .. } => None,
            Kind::Clear { sun, .. } => Some(Peak { axis: sun, width: 1e-4 }),
        }
    }
}

/// f of the angle to the sun.
fn scattering(direction: DVec3, sun: DVec3) -> f64 {
    let cosine = direction.dot(sun);
    let angle = direction.cross(sun).length().atan2(cosine);
    0.91 + 10.0 * (-3.0 * angle).exp() + 0.45 * cosine * cosine
}

/// p of the sine of the angle above the horizon.
fn gradation(sine: f64) -> f64 {
    -(-0.32 / sine).exp_m1()
}

fn sound(radiance: DVec3) -> Result<DVec3, SkyError> {
    let is_sound = radiance.is_finite() && radiance.min_element() >= 0.0;
    if is_sound { Ok(radiance) } else { Err(SkyError::BadRadiance(radiance)) }
}

fn unit(direction: DVec3) -> Result<DVec3, SkyError> {
    (direction / direction.abs().max_element()).try_normalize().ok_or(SkyError::BadDirection(direction))
}

#[cfg(test)]
mod tests {
    use super::{Sky, SkyError};
    use crate::integral::{CubatureOptions, integrate};
    use glam::DVec3;
    use std::f64::consts::PI;

    #[test]
    fn zeniths_and_horizons() {
        let [zenith, up] = [DVec3::new(3.0, 2.0, 1.0), DVec3::new(0.0, 0.0, 5.0)];
        let sun = DVec3::new(1.0, 0.0, 1.0);
        let overcast = Sky::overcast(zenith, up).unwrap();
        let clear = Sky::clear(zenith, up, sun).unwrap();
        for sky in [overcast, clear, Sky::constant(zenith).unwrap()] {
            assert!((sky.radiance(DVec3::Z) - zenith).length() < 1e-15, "{sky:?}");
        }
        assert!((overcast.radiance(DVec3::new(1.0, 0.0, 1e-9)) - zenith / 3.0).length() < 1e-8);
        assert_eq!(overcast.radiance(DVec3::X), DVec3::ZERO);
        assert_eq!(clear.radiance(DVec3::NEG_Z), DVec3::ZERO);
        // CIE 22: towards the sun at 45 degrees, and opposite to it.
        let f = |c: f64| 0.91 + 10.0 * (-3.0 * c).exp() + 0.45 * c.cos().powi(2);
        let p = |g: f64| 1.0 - (-0.32 / g.sin()).exp();
        for (degrees, from_sun) in [(45.0_f64, 0.0_f64), (20.0, 115.0), (80.0, 35.0)] {
            let (height, angle) = (degrees.to_radians(), from_sun.to_radians());
            // In the sun's vertical plane, from 45 degrees, over the zenith if need be.
            let tilt = std::f64::consts::FRAC_PI_4 + angle;
            let direction = DVec3::new(tilt.cos(), 0.0, tilt.sin());
            assert!((direction.z - height.sin()).abs() < 1e-12, "{degrees}");
            let expected = zenith * (f(angle) * p(height) / (f(std::f64::consts::FRAC_PI_4) * p(PI / 2.0)));
            assert!((clear.radiance(direction) - expected).length() < 1e-12, "{degrees}");
        }
    }

    #[test]
    fn an_overcast_sky_lights_a_level_surface_with_seven_ninths_of_pi() {
        let sky = Sky::overcast(DVec3::ONE, DVec3::Z).unwrap();
        let hemisphere = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y];
        let options = CubatureOptions { relative: 1e-10, ..CubatureOptions::default() };
        let irradiance = integrate(|u| sky.radiance(u) * u.z, &hemisphere, &[], options);
        assert!((irradiance.value.x - 7.0 * PI / 9.0).abs() < 1e-10);
    }

    #[test]
    fn what_is_no_sky_is_refused() {
        let white = DVec3::ONE;
        assert_eq!(Sky::constant(-white), Err(SkyError::BadRadiance(-white)));
        assert!(matches!(Sky::overcast(DVec3::NAN, DVec3::Z), Err(SkyError::BadRadiance(_))));
        assert_eq!(Sky::overcast(white, DVec3::ZERO), Err(SkyError::BadDirection(DVec3::ZERO)));
        assert!(matches!(Sky::clear(white, DVec3::Z, DVec3::INFINITY), Err(SkyError::BadDirection(_))));
        assert_eq!(Sky::clear(white, DVec3::Z, DVec3::X), Err(SkyError::SunBelow(DVec3::X)));
    }
}
