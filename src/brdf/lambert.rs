//! Matt surfaces.

use super::error::reflectance;
use super::{Brdf, BrdfError, Form, Lobe, RgbEstimate, are_above};
use glam::DVec3;
use std::f64::consts::PI;

/// The same radiance in all directions: rho / pi (Lambert, *Photometria*, 1760).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lambert {
    reflectance: DVec3,
}

impl Lambert {
    /// Of that reflectance rho, which is its albedo in any direction.
    ///
    /// # Errors
    /// If it is not from 0 to 1.
    pub fn new(rho: DVec3) -> Result<Self, BrdfError> {
        Ok(Self { reflectance: reflectance(rho)? })
    }
}

impl Brdf for Lambert {
    fn eval(&self, incoming: DVec3, outgoing: DVec3) -> DVec3 {
        if are_above(incoming, outgoing) { self.reflectance / PI } else { DVec3::ZERO }
    }

    fn form(&self, _outgoing: DVec3) -> Form<'_> {
        Form::Lobes(vec![Lobe { axis: DVec3::Z, power: 0, weight: self.reflectance / PI }])
    }

    fn albedo(&self, _outgoing: DVec3) -> RgbEstimate {
        RgbEstimate { value: self.reflectance, error: DVec3::ZERO }
    }
}
