//! Blinn's lobe of the halfway vector.

use super::error::{exponent, reflectance};
use super::halfway::{halfway, peaks};
use super::{Brdf, BrdfError, Form, are_above};
use crate::integral::Smoothness;
use glam::DVec3;
use std::f64::consts::PI;

/// rho N (n.h)^e about the normal n, h halfway between the directions (Blinn, "Models of light reflection for computer
/// synthesized pictures", SIGGRAPH 1977), with N = (e + 2)(e + 4) / (8 pi (2^(-e/2) + e)), which makes the albedo rho at
/// normal incidence, where it is largest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blinn {
    weight: DVec3,
    exponent: f64,
}

impl Blinn {
    /// Of reflectance rho and exponent e.
    ///
    /// # Errors
    /// If rho is not from 0 to 1 or e not from 0 to 1,000,000.
    pub fn new(rho: DVec3, e: f64) -> Result<Self, BrdfError> {
        let (rho, e) = (reflectance(rho)?, exponent(e)?);
        let weight = rho * ((e + 2.0) * (e + 4.0) / (8.0 * PI * ((-0.5 * e).exp2() + e)));
        Ok(Self { weight, exponent: e })
    }
}

impl Brdf for Blinn {
    fn eval(&self, incoming: DVec3, outgoing: DVec3) -> DVec3 {
        if !are_above(incoming, outgoing) {
            return DVec3::ZERO;
        }
        self.weight * halfway(incoming, outgoing).z.powf(self.exponent)
    }

    fn form(&self, outgoing: DVec3) -> Form<'_> {
        let width = 1.0 / self.exponent.max(1.0).sqrt();
        Form::General { peaks: peaks(outgoing, width, width), creases: Vec::new(), smoothness: Smoothness::Smooth }
    }
}
