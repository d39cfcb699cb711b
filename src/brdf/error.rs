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
    /// A parameter that may be 0 is too large, negative or not a number.
    #[error("{what} has to be from 0 to {most}, not {value}")]
    OutOfRange {
        /// What it is.
        what: &'static str,
        /// The largest that it may be.
        most: f64,
        /// What was given.
        value: f64,
    },
    /// A refractive index is not a positive number, or an absorption is negative.
    #[error("a refractive index has to be from 0.01 to 100, and an absorption from 0 to 100, not {0}")]
    BadIndex(DVec3),
    /// A scale of a lobe is not finite.
    #[error("the scales of a lobe have to be finite numbers, not {0}")]
    BadScale(DVec3),
    /// A series of spherical harmonics is too long.
    #[error("spherical harmonics to band {band} are too many; take a band to {highest}")]
    HighBand {
        /// The band asked for.
        band: u16,
        /// The highest there may be.
        highest: u16,
    },
    /// A table has the wrong size.
    #[error("the table has {count} entries instead of {expected}")]
    BadTable {
        /// How many entries there are.
        count: usize,
        /// How many there should be.
        expected: usize,
    },
    /// An entry of a table is not a finite number, or too large.
    #[error("entry {index} of the table is {value}: it has to be of finite numbers up to 1e12")]
    BadCoefficient {
        /// Which, from 0.
        index: usize,
        /// What it is.
        value: DVec3,
    },
    /// A BRDF with a mirror in it is to be put into a table.
    #[error("a mirror is no function of the direction: leave it out of what is tabulated and add it again after")]
    NoFunction,
    /// A BRDF that is to be put into a table has a value that is not finite.
    #[error("the BRDF is not finite for the direction {outgoing} towards the viewer")]
    NotFinite {
        /// Towards the viewer.
        outgoing: DVec3,
    },
    /// A bin of measurements is negative where there are directions above the surface.
    #[error(
        "bin theta_h {}, theta_d {}, phi_d {} is {value}: measurements of directions above the surface may not be negative", bin[0], bin[1], bin[2]
    )]
    BadMeasurement {
        /// Its numbers, from 0.
        bin: [usize; 3],
        /// What it is, in sr^-1.
        value: DVec3,
    },
    /// A roughness is outside of the table of fits.
    #[error("a roughness of linearly transformed cosines has to be from 0.0025 to 1, not {0}")]
    NotFitted(f64),
    /// More light would be reflected than there is.
    #[error("the lobe may reflect up to {0} times the light it gets; take a smaller weight or scale")]
    NotConserving(f64),
}

/// A reflectance that is one.
pub(super) fn reflectance(value: DVec3) -> Result<DVec3, BrdfError> {
    let is_good = value.cmpge(DVec3::ZERO).all() && value.cmple(DVec3::ONE).all();
    if is_good { Ok(value) } else { Err(BrdfError::BadReflectance(value)) }
}

/// A number from 0 to a largest one.
pub(super) fn within(what: &'static str, most: f64, value: f64) -> Result<f64, BrdfError> {
    if (0.0..=most).contains(&value) { Ok(value) } else { Err(BrdfError::OutOfRange { what, most, value }) }
}

/// An exponent that is one.
pub(super) fn exponent(value: f64) -> Result<f64, BrdfError> {
    if (0.0..=1e6).contains(&value) { Ok(value) } else { Err(BrdfError::BadExponent(value)) }
}

/// A roughness that is one.
pub(super) fn roughness(value: f64) -> Result<f64, BrdfError> {
    if (1e-4..=10.0).contains(&value) { Ok(value) } else { Err(BrdfError::BadRoughness(value)) }
}
