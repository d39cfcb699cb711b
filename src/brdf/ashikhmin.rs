//! Ashikhmin and Shirley's anisotropic model.

use super::error::{exponent, reflectance};
use super::halfway::{halfway, peaks};
use super::{Brdf, BrdfError, Form, are_above};
use crate::integral::Smoothness;
use glam::DVec3;
use std::f64::consts::PI;

/// A glossy lobe over a matt base that gets what the lobe lets through (Ashikhmin and Shirley, "An anisotropic Phong BRDF
/// model", 2000), with Schlick's reflectance:
/// sqrt((nx + 1)(ny + 1)) / (8 pi) hz^((nx hx^2 + ny hy^2) / (1 - hz^2)) F(h.v) / ((h.v) max(uz, vz))
/// + 28 Rd / (23 pi) (1 - Rs) (1 - (1 - uz / 2)^5) (1 - (1 - vz / 2)^5).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AshikhminShirley {
    diffuse: DVec3,
    specular: DVec3,
    exponents: [f64; 2],
}

impl AshikhminShirley {
    /// Of the base's reflectance Rd, the lobe's at normal incidence Rs, and exponents along x and y.
    ///
    /// # Errors
    /// If a reflectance is not from 0 to 1 or an exponent not from 0 to 1,000,000.
    pub fn new(diffuse: DVec3, specular: DVec3, along_x: f64, along_y: f64) -> Result<Self, BrdfError> {
        let exponents = [exponent(along_x)?, exponent(along_y)?];
        Ok(Self { diffuse: reflectance(diffuse)?, specular: reflectance(specular)?, exponents })
    }
}

impl Brdf for AshikhminShirley {
    fn eval(&self, incoming: DVec3, outgoing: DVec3) -> DVec3 {
        if !are_above(incoming, outgoing) {
            return DVec3::ZERO;
        }
        let [nx, ny] = self.exponents;
        let h = halfway(incoming, outgoing);
        let across = h.x * h.x + h.y * h.y;
        let exponent = if across > 0.0 { (nx * h.x * h.x + ny * h.y * h.y) / across } else { 0.0 };
        let cosine = h.dot(outgoing);
        let fresnel = self.specular + (DVec3::ONE - self.specular) * (1.0 - cosine.min(1.0)).powi(5);
        let peak = ((nx + 1.0) * (ny + 1.0)).sqrt() / (8.0 * PI);
        let lobe = peak * h.z.powf(exponent) / (cosine * incoming.z.max(outgoing.z));
        let through = |z: f64| 1.0 - (1.0 - 0.5 * z).powi(5);
        let base = 28.0 / (23.0 * PI) * through(incoming.z) * through(outgoing.z);
        fresnel * lobe + self.diffuse * (DVec3::ONE - self.specular) * base
    }

    fn form(&self, outgoing: DVec3) -> Form<'_> {
        let [x, y] = self.exponents.map(|n| 1.0 / n.max(1.0).sqrt());
        Form::General { peaks: peaks(outgoing, x, y), creases: Vec::new(), smoothness: Smoothness::Kinked }
    }
}
