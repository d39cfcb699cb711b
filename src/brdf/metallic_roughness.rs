//! The material model of glTF.

use super::error::{reflectance, within};
use super::halfway::halfway;
use super::{Brdf, BrdfError, Form, Fresnel, Ggx, are_above};
use crate::scene;
use glam::DVec3;
use std::f64::consts::PI;

/// Metal, or a matt base below a clear coat, or a mixture, as glTF has it (Khronos, *glTF 2.0 Specification*, appendix B):
/// (1 - F(h.v)) c / pi + F(h.v) D(h) G(u, v) / (4 uz vz) with F Schlick's reflectance from f, f = 0.04 and c the base colour for what is no metal,
/// f the base colour and c = 0 for a metal, mixed in between; the microfacets are those of [`Ggx`] of roughness squared: masking is correlated by height, which the
/// specification (B.3.6.1) names as more accurate than the product that it writes.
///
/// As specified (B.3.6.3 says so) it may reflect more than it gets where it is no metal: F(h.v) of light from the side is small, so that the base gets it all, when the
/// coat sends all that comes from beyond to the viewer. With a base colour of 0.9 the albedo is 1.09 at 75 degrees.
///
/// A roughness below 0.01 counts as 0.01.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MetallicRoughness {
    matt: DVec3,
    fresnel: Fresnel,
    facets: Ggx,
}

impl MetallicRoughness {
    /// Of a base colour, a metallic part and a roughness.
    ///
    /// # Errors
    /// If one of them is not from 0 to 1.
    pub fn new(base_colour: DVec3, metallic: f64, roughness: f64) -> Result<Self, BrdfError> {
        let base_colour = reflectance(base_colour)?;
        let metallic = within("the metallic part", 1.0, metallic)?;
        let roughness = within("a roughness of glTF", 1.0, roughness)?;
        let fresnel = Fresnel::schlick(DVec3::splat(0.04 * (1.0 - metallic)) + base_colour * metallic)?;
        let squared = (roughness * roughness).max(1e-4);
        Ok(Self {
            matt: base_colour * ((1.0 - metallic) / PI),
            fresnel,
            facets: Ggx::new(Fresnel::ALL, squared, squared)?,
        })
    }
}

impl TryFrom<scene::MetallicRoughness> for MetallicRoughness {
    type Error = BrdfError;

    fn try_from(surface: scene::MetallicRoughness) -> Result<Self, BrdfError> {
        Self::new(DVec3::from(surface.base_colour), surface.metallic, surface.roughness)
    }
}

impl Brdf for MetallicRoughness {
    fn eval(&self, incoming: DVec3, outgoing: DVec3) -> DVec3 {
        if !are_above(incoming, outgoing) {
            return DVec3::ZERO;
        }
        let fresnel = self.fresnel.reflectance(halfway(incoming, outgoing).dot(outgoing));
        (DVec3::ONE - fresnel) * self.matt + fresnel * self.facets.eval(incoming, outgoing)
    }

    /// The matt part is smooth: where the facets' lobe is looked for will do for it.
    fn form(&self, outgoing: DVec3) -> Form<'_> {
        self.facets.form(outgoing)
    }
}
