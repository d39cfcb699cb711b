//! Rough matt surfaces.

use super::error::{reflectance, within};
use super::{Brdf, BrdfError, Form, RgbEstimate, are_above};
use crate::integral::Smoothness;
use glam::DVec3;
use std::f64::consts::PI;

/// Oren and Nayar's qualitative model ("Generalization of Lambert's reflectance model", SIGGRAPH 1994): facets that are matt, with
/// slopes of standard deviation sigma:
/// rho / pi (A + B max(0, cos(phi)) sin(alpha) tan(beta)), phi the difference of the azimuths, alpha the larger and beta the smaller angle to the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrenNayar {
    reflectance: DVec3,
    a: f64,
    b: f64,
}

impl OrenNayar {
    /// Of reflectance rho and roughness sigma in radians; with 0 it is [`Lambert`](super::Lambert).
    ///
    /// # Errors
    /// If rho is not from 0 to 1 or sigma not from 0 to 10.
    pub fn new(rho: DVec3, sigma: f64) -> Result<Self, BrdfError> {
        let sigma = within("the deviation of slopes", 10.0, sigma)?;
        let square = sigma * sigma;
        let (a, b) = (1.0 - 0.5 * square / (square + 0.33), 0.45 * square / (square + 0.09));
        Ok(Self { reflectance: reflectance(rho)?, a, b })
    }
}

impl Brdf for OrenNayar {
    fn eval(&self, incoming: DVec3, outgoing: DVec3) -> DVec3 {
        if !are_above(incoming, outgoing) {
            return DVec3::ZERO;
        }
        // cos(difference of azimuths) sin(one) sin(other), over the cosine of the smaller angle.
        let along = incoming.truncate().dot(outgoing.truncate()).max(0.0);
        self.reflectance / PI * (self.a + self.b * along / incoming.z.max(outgoing.z))
    }

    fn form(&self, outgoing: DVec3) -> Form<'_> {
        let crease = DVec3::new(outgoing.x, outgoing.y, 0.0);
        Form::General {
            peaks: Vec::new(),
            creases: crease.try_normalize().into_iter().collect(),
            smoothness: Smoothness::Kinked,
        }
    }

    /// In closed form: A + 2 B sin(t) / pi ((t - sin(t) cos(t)) / 2 + (1 - sin(t)^3) / (3 cos(t))) times rho, t the angle to the normal.
    fn albedo(&self, outgoing: DVec3) -> RgbEstimate {
        let (sin, cos) = (outgoing.truncate().length(), outgoing.z);
        let angle = sin.atan2(cos);
        // 1 - sin^3 without loss at the horizon.
        let beyond = cos * (1.0 + sin + sin * sin) / (3.0 * (1.0 + sin));
        let value = self.reflectance * (self.a + self.b * 2.0 * sin / PI * (0.5 * (angle - sin * cos) + beyond));
        RgbEstimate { value, error: DVec3::splat(1e-15) }
    }
}
