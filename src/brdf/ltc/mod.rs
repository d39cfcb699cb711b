//! Linearly transformed cosines: a fast approximation of microfacets.

mod range;
mod table;
#[cfg(test)]
mod tests;

pub use table::{LtcFit, LtcTable};

use super::error::reflectance;
use super::{Brdf, BrdfError, Form, are_above};
use glam::{DMat3, DVec3};
use std::f64::consts::PI;

/// [`Ggx`](super::Ggx) approximated by linearly transformed cosines (Heitz, Dupuy, Hill and Neubelt, "Real-time polygonal-light shading with
/// linearly transformed cosines", SIGGRAPH 2016): BRDF times cosine is replaced by one transformed cosine for a roughness and an angle, out of a table of fits. A polygon then costs
/// what it costs with a matt surface.
///
/// *Never a reference.* It is no BRDF of its own either: it is not reciprocal, and grows without limit at the horizon. The error that is returned with a reflected
/// radiance is the smaller of two. One is the distance to the true model, the integral of the difference's size over all directions, times the brightest radiance: the two differ by
/// no more, whatever the polygons. It was measured when the table was fitted, as the largest of 25 places about each entry; see `docs/brdf.md`. The other is
/// how far the value can be from what the least and the largest values of the true model over each polygon allow: a bound that small lamps off the lobe are better off with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GgxLtc {
    at_normal: DVec3,
    roughness: f64,
}

impl GgxLtc {
    /// Of the facets' reflectance at normal incidence, which is Schlick's at others, and a roughness as of [`Ggx`](super::Ggx), the same along x and y.
    ///
    /// # Errors
    /// If the reflectance is not from 0 to 1 or the roughness not from 0.0025 to 1.
    pub fn new(at_normal: DVec3, roughness: f64) -> Result<Self, BrdfError> {
        if !(LtcTable::SMOOTHEST..=1.0).contains(&roughness) {
            return Err(BrdfError::NotFitted(roughness));
        }
        Ok(Self { at_normal: reflectance(at_normal)?, roughness })
    }

    fn transformed(&self, outgoing: DVec3) -> (DMat3, DVec3, DVec3) {
        let fit = LtcTable::built_in().at(self.roughness, outgoing.z);
        let mix = |[all, edge]: [f64; 2]| self.at_normal * all + (DVec3::ONE - self.at_normal) * edge;
        (fit.inverse(outgoing), mix(fit.weights), mix(fit.distances))
    }
}

impl Brdf for GgxLtc {
    fn eval(&self, incoming: DVec3, outgoing: DVec3) -> DVec3 {
        if !are_above(incoming, outgoing) {
            return DVec3::ZERO;
        }
        let (inverse, weight, _) = self.transformed(outgoing);
        weight * (transformed_cosine(inverse, incoming) / incoming.z)
    }

    fn form(&self, outgoing: DVec3) -> Form<'_> {
        let (inverse, weight, distance) = self.transformed(outgoing);
        let range = Box::new(move |corners: &[DVec3]| range::of_ggx(self.at_normal, self.roughness, outgoing, corners));
        Form::Transformed { inverse, weight, distance, range }
    }

    /// False.
    fn is_reciprocal(&self) -> bool {
        false
    }
}

/// The density of a transformed cosine in a unit direction.
fn transformed_cosine(inverse: DMat3, direction: DVec3) -> f64 {
    let moved = inverse * direction;
    let square = moved.length_squared();
    if moved.z > 0.0 { moved.z * inverse.determinant() / (PI * square * square) } else { 0.0 }
}
