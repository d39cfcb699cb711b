//! Phong's lobe, energy-normalised.

use super::error::{exponent, reflectance};
use super::{Brdf, BrdfError, Form, Lobe, are_above, mirrored};
use crate::integral::{Peak, Smoothness};
use glam::DVec3;
use std::f64::consts::TAU;

/// rho (n + 2) / (2 pi) max(0, r.u)^n about the mirror direction r of the viewer (Phong 1975; normalised as by Lewis 1994, which makes it
/// reciprocal and no brighter than rho).
///
/// Whole exponents to 65,535 are integrated in closed form, others by cubature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phong {
    reflectance: DVec3,
    exponent: f64,
}

impl Phong {
    /// Of reflectance rho, its albedo at normal incidence (less at others, where part of the lobe is below the surface), and exponent n.
    ///
    /// # Errors
    /// If rho is not from 0 to 1 or n not from 0 to 1,000,000.
    pub fn new(rho: DVec3, n: f64) -> Result<Self, BrdfError> {
        Ok(Self { reflectance: reflectance(rho)?, exponent: exponent(n)? })
    }
}

impl Brdf for Phong {
    fn eval(&self, incoming: DVec3, outgoing: DVec3) -> DVec3 {
        let cosine = mirrored(outgoing).dot(incoming);
        if !are_above(incoming, outgoing) || cosine <= 0.0 {
            return DVec3::ZERO;
        }
        self.reflectance * ((self.exponent + 2.0) / TAU * cosine.powf(self.exponent))
    }

    fn form(&self, outgoing: DVec3) -> Form<'_> {
        let axis = mirrored(outgoing);
        // With exponent 0 the half sphere about the axis counts, not that about the normal.
        if let Some(power) = whole(self.exponent).filter(|&power| power > 0) {
            let weight = self.reflectance * ((self.exponent + 2.0) / TAU);
            return Form::Lobes(vec![Lobe { axis, power, weight }]);
        }
        let width = 1.0 / self.exponent.max(1.0).sqrt();
        Form::General { peaks: vec![Peak { axis, width }], creases: vec![axis], smoothness: Smoothness::Smooth }
    }
}

/// An exponent for which there are moments.
pub(super) fn whole(exponent: f64) -> Option<u16> {
    (exponent.fract() == 0.0 && exponent <= f64::from(u16::MAX)).then_some(exponent as u16)
}
