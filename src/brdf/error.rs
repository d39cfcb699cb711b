//! Why there is no BRDF of those parameters.

use glam::DVec3;

/// Why there is no BRDF of those parameters.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BrdfError {
    /// A reflectance is not a number from 0 to 1.
    #[error("a reflectance has to be from 0 to 1, not {0}")]
    BadReflectance(DVec3),
    /// An exponent is not a number from 0 to 1e6.
    #[error("an exponent has to be from 0 to 1,000,000, not {0}")]
    BadExponent(f64),
    /// A roughness is too small or not a number.
    #[error("a roughness has to be from 0.0001 to 10, not {0}")]
    BadRoughness(f64),
    /// A refractive index is not a positive number, or an absorption is negative.
    #[error("a refractive index has to be from 0.01 to 100, and an absorption from 0 to 100, not {0}")]
    BadIndex(DVec3),
    /// A scale of a lobe is not finite.
    #[error("the scales of a lobe have to be finite numbers, not {0}")]
    BadScale(DVec3),
    /// More light would be reflected than there is.
    #[error("the lobe may reflect up to {0} times the light it gets; take a smaller weight or scale")]
    NotConserving(f64),
}

/// A reflectance that is one.
pub(super) fn reflectance(value: DVec3) -> Result<DVec3, BrdfError> {
    let is_good = value.cmpge(DVec3::ZERO).all() && value.cmple(DVec3::ONE).all();
    if is_good { Ok(value) } else { Err(BrdfError::BadReflectance(value)) }
}

/// An exponent that is one.
pub(super) fn exponent(value: f64) -> Result<f64, BrdfError> {
    if (0.0..=1e6).contains(&value) { Ok(value) } else { Err(BrdfError::BadExponent(value)) }
}

/// A roughness that is one.
pub(super) fn roughness(value: f64) -> Result<f64, BrdfError> {
    if (1e-4..=10.0).contains(&value) { Ok(value) } else { Err(BrdfError::BadRoughness(value)) }
}
