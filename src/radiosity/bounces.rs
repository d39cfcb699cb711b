//! Gathering, bounce by bounce, with form factors that are all there.

use super::RadiosityError;
use super::groups::{GAPS, alone, firsts, join};
use super::residual::{Residual, symmetric_weights};
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
    /// How many times all patches gathered: so many bounces of light were followed, and all others found from these.
    pub bounces: usize,
}

/// So many bounces may take nothing away.
const PATIENCE: usize = 1000;

impl Gathered {
    /// Checks what needs no rows of form factors, which take long.
    ///
    /// # Errors
    /// If a material has no reflectance, if nothing emits, or if numbers do not hold the power that is emitted, or the area of a patch.
    pub fn check(scene: &Scene, exchange: &Exchange) -> Result<(), RadiosityError> {
        surfaces(scene, exchange).map(|_| ())
    }

    /// Gathers at every patch what all others have sent to it, first what they emit, then what they have reflected of that, and so on (Goral, Torrance, Greenberg and Battaile 1984), until what is
    /// still to be sent is no more than `until` of the power that is emitted, in each group of patches that exchange light, directly or through others.
    ///
    /// Bounces are not just added up: they are combined so that least is left (generalized conjugate residuals; Eisenstat, Elman and Schultz, *Variational Iterative Methods for Nonsymmetric Systems of Linear Equations*, 1983). So
    /// there are few of them where surfaces reflect nearly all that they get, too. With what is left received at last, and nothing below what is emitted, what patches do not see gives them no light.
    ///
    /// The exchange is that of the scene, patch by polygon, and the rows are its. Each radiosity is a mean of others, times the reflectance, so that errors of factors do not add up; power
    /// is conserved as well as the factors are reciprocal. Shooting with [`Solver`](super::Solver) conserves it whatever they are. Where all but a part x of the light is reflected, radiosities are right to some 1e-16 / x of themselves.
    ///
    /// The cost is that of a pass over all factors for each bounce. Memory: some 500 bytes a patch.
    ///
    /// # Errors
    /// If a material has no reflectance, if nothing emits, or if it would not end, as 1000 bounces take less than 1e-9 from what is left.
    ///
    /// # Panics
    /// If there are not as many rows as patches.
    pub fn new(scene: &Scene, exchange: &Exchange, rows: &ViewedRows, until: f64) -> Result<Self, RadiosityError> {
        Self::watched(scene, exchange, rows, until, |_| ())
    }

    /// The same; after every bounce `watch` is told what part of the power that is emitted is still to be sent.
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
        let count = emission.len();
        assert_eq!(rows.len(), count, "a row for every patch");
        // Relative to the largest, as their squares have to be numbers.
        let areas: Vec<f64> = exchange.patches().iter().map(|patch| patch.area).collect();
        let areas = relative(&areas);
        let groups = groups_of(rows);
        let mut brightest = vec![DVec3::ZERO; count];
        for (&group, &emission) in groups.iter().zip(&emission) {
            brightest[group as usize] = brightest[group as usize].max(emission);
        }
        let unit = |k: usize| {
            let brightest = brightest[groups[k] as usize];
            DVec3::select(brightest.cmpgt(DVec3::ZERO), brightest, DVec3::ONE)
        };
        // The channels of a group's light, its brightest being 1.
        let share = |k: usize| {
            let brightest = brightest[groups[k] as usize];
            brightest / brightest.max_element().max(f64::MIN_POSITIVE)
        };
        let in_groups = |value: &dyn Fn(usize) -> f64| {
            let mut sums = vec![0.0; count];
            (0..count).for_each(|k| sums[groups[k] as usize] += value(k));
            sums
        };
        let emitted = in_groups(&|k| (emission[k] / unit(k) * share(k)).element_sum() * areas[k]);
        // What part of the power that is emitted is reflected of some irradiance, in the group in which that is most.
        let part = |irradiance: &[DVec3]| {
            let reflected = in_groups(&|k| (reflectance[k] * irradiance[k].abs() * share(k)).element_sum() * areas[k]);
            let parts = reflected.iter().zip(&emitted).filter(|&(_, &emitted)| emitted > 0.0);
            parts.map(|(reflected, emitted)| reflected / emitted).fold(0.0, f64::max)
        };
        let gather = |sent: &[DVec3]| -> Vec<DVec3> {
            let at = |k: usize| rows.row(k).iter().map(|&(other, f)| sent[other as usize] * f).sum();
            (0..count).map(at).collect()
        };
        if until >= 1.0 {
            return Ok(Self { radiosity: emission.clone(), emission, bounces: 0 });
        }
        let received = gather(&(0..count).map(|k| emission[k] / unit(k)).collect::<Vec<_>>());
        let weights = relative(&symmetric_weights(rows, &areas));
        let weights = weights.iter().zip(&reflectance).map(|(&weight, &rho)| weight * rho).collect();
        let mut residual = Residual::new(received, weights, &groups);
        let (mut bounces, mut left) = (1, part(residual.left()));
        watch(left);
        let mut checked = left;
        while left > until {
            let sent: Vec<DVec3> = residual.left().iter().zip(&reflectance).map(|(&e, &rho)| rho * e).collect();
            residual.reduce(&gather(&sent));
            left = part(residual.left());
            bounces += 1;
            watch(left);
            if bounces % PATIENCE == 0 {
                if left > checked * (1.0 - 1e-9) {
                    return Err(RadiosityError::Endless { shots: bounces * count });
                }
                checked = left;
            }
        }
        let irradiance = residual.into_solution();
        let radiosity = (0..count).map(|k| emission[k] + reflectance[k] * irradiance[k].max(DVec3::ZERO) * unit(k));
        Ok(Self { radiosity: radiosity.collect(), emission, bounces })
    }
}

/// For each patch the first one of those that it exchanges light with, directly or through others.
fn groups_of(rows: &ViewedRows) -> Vec<u32> {
    let mut groups = alone(rows.len());
    for patch in 0..rows.len() {
        for &(other, factor) in rows.row(patch) {
            if factor > GAPS {
                join(&mut groups, patch as u32, other);
            }
        }
    }
    firsts(&groups)
}

/// Numbers over the largest of them.
fn relative(values: &[f64]) -> Vec<f64> {
    let most = values.iter().copied().fold(0.0, f64::max);
    if most > 0.0 { values.iter().map(|value| value / most).collect() } else { values.to_vec() }
}
