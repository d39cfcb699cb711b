//! Gathering, bounce by bounce, with form factors that are all there.

use super::{RadiosityError, strength};
use crate::factors::{Exchange, ViewedRows};
use crate::radiosity::solver::surfaces;
use crate::scene::Scene;
use glam::DVec3;

/// Radiosities of all patches, by gathering.
#[derive(Clone, Debug, PartialEq)]
pub struct Gathered {
    /// What each patch emits.
    pub emission: Vec<DVec3>,
    /// The radiosity of each patch, of its front: what it emits and reflects.
    pub radiosity: Vec<DVec3>,
    /// How many times light was reflected.
    pub bounces: usize,
}

/// So many bounces may take nothing away.
const PATIENCE: usize = 1000;

impl Gathered {
    /// Gathers at every patch what all others have sent to it, first what they emit, then what they have reflected of that, and so on (Goral, Torrance, Greenberg and Battaile 1984; the iteration of Jacobi), until what is
    /// still to be sent is no more than `until` of the power that is emitted.
    ///
    /// The exchange is that of the scene, patch by polygon, and the rows are its. Each radiosity is a mean of others, times the reflectance, so that errors of factors do not add up; power
    /// is conserved as well as the factors are reciprocal. Shooting with [`Solver`](super::Solver) conserves it whatever they are.
    ///
    /// # Errors
    /// If a material has no reflectance, if nothing emits, or if it would never end, as nothing is absorbed.
    ///
    /// # Panics
    /// If there are not as many rows as patches.
    pub fn new(scene: &Scene, exchange: &Exchange, rows: &ViewedRows, until: f64) -> Result<Self, RadiosityError> {
        Self::watched(scene, exchange, rows, until, |_| ())
    }

    /// The same; after every bounce `watch` is told what part of the power that is emitted is still to be sent. Where surfaces reflect nearly all that they get, there are very many:
    /// in a closed room of reflectance rho about ln(until) / ln(rho).
    ///
    /// # Errors
    /// As [`Gathered::new`].
    ///
    /// # Panics
    /// As [`Gathered::new`].
    pub fn watched(
        scene: &Scene,
        exchange: &Exchange,
        rows: &ViewedRows,
        until: f64,
        mut watch: impl FnMut(f64),
    ) -> Result<Self, RadiosityError> {
        let (emission, reflectance) = surfaces(scene, exchange)?;
        assert_eq!(rows.len(), emission.len(), "a row for every patch");
        let areas: Vec<f64> = exchange.patches().iter().map(|patch| patch.area).collect();
        let power = |of: &[DVec3]| of.iter().zip(&areas).map(|(&b, &area)| strength(b) * area).sum::<f64>();
        let mut radiosity = emission.clone();
        let mut sent = emission.clone();
        let emitted = power(&emission);
        let (mut bounces, mut left) = (0, emitted);
        let mut checked = left;
        while left > until * emitted {
            let gathered = |patch: usize| {
                let irradiance: DVec3 = rows.row(patch).iter().map(|&(other, f)| sent[other as usize] * f).sum();
                reflectance[patch] * irradiance
            };
            sent = (0..sent.len()).map(gathered).collect();
            radiosity.iter_mut().zip(&sent).for_each(|(sum, &b)| *sum += b);
            left = power(&sent);
            bounces += 1;
            watch(left / emitted);
            if bounces % PATIENCE == 0 {
                if left > checked * (1.0 - 1e-9) {
                    return Err(RadiosityError::Endless { shots: bounces * sent.len() });
                }
                checked = left;
            }
        }
        Ok(Self { emission, radiosity, bounces })
    }
}
