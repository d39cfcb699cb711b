//! Microfacets of Trowbridge and Reitz.

use super::error::roughness;
use super::halfway::{halfway, peaks};
use super::{Brdf, BrdfError, Form, Fresnel, are_above};
use crate::integral::Smoothness;
use glam::DVec3;
use std::f64::consts::PI;

/// D(h) G(u, v) F(h.v) / (4 uz vz): the distribution of Trowbridge and Reitz (1975; "GGX" of Walter, Marschner, Li and Torrance, EGSR 2007), with
/// Smith's masking for heights that are correlated (Heitz, "Understanding the masking-shadowing function in microfacet-based BRDFs", 2014).
///
/// G / (4 uz vz) is written as 1 / (2 (vz S(u) + uz S(v))), S(w)^2 = wz^2 + (ax wx)^2 + (ay wy)^2, which divides by nothing that vanishes at the horizon.
/// Light that is reflected twice is lost, as the model has it: rough surfaces are too dark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ggx {
    fresnel: Fresnel,
    roughness: [f64; 2],
}

impl Ggx {
    /// Of the facets' reflectance, and roughnesses along x and y (the a of the papers: glTF's is its square root).
    ///
    /// # Errors
    /// If a roughness is not from 0.0001 to 10.
    pub fn new(fresnel: Fresnel, along_x: f64, along_y: f64) -> Result<Self, BrdfError> {
        Ok(Self { fresnel, roughness: [roughness(along_x)?, roughness(along_y)?] })
    }
}

impl Brdf for Ggx {
    fn eval(&self, incoming: DVec3, outgoing: DVec3) -> DVec3 {
        if !are_above(incoming, outgoing) {
            return DVec3::ZERO;
        }
        let [ax, ay] = self.roughness;
        let h = halfway(incoming, outgoing);
        let slopes = (h.x / ax).powi(2) + (h.y / ay).powi(2) + h.z * h.z;
        let distribution = 1.0 / (PI * ax * ay * slopes * slopes);
        let smith = |w: DVec3| (w.z * w.z + (ax * w.x).powi(2) + (ay * w.y).powi(2)).sqrt();
        let visible = 0.5 / (outgoing.z * smith(incoming) + incoming.z * smith(outgoing));
        self.fresnel.reflectance(h.dot(outgoing)) * (distribution * visible)
    }

    fn form(&self, outgoing: DVec3) -> Form<'_> {
        let [ax, ay] = self.roughness;
        Form::General { peaks: peaks(outgoing, ax, ay), creases: Vec::new(), smoothness: Smoothness::Smooth }
    }
}
