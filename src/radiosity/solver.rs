//! Progressive refinement.

use super::{Balance, RadiosityError, strength};
use crate::factors::{Exchange, PatchInfo, Row};
use crate::parallel;
use crate::scene::Scene;
use glam::DVec3;
use std::f64::consts::PI;
use std::sync::Arc;

/// How it is solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolverOptions {
    /// So many patches shoot at a time, on as many threads as there are: 1 or more. The solution depends on it, though not
    /// on the number of threads.
    pub batch: usize,
    /// Rows of form factors are kept until they have so many entries together, of 24 bytes each: patches shoot many times.
    pub most_entries: usize,
    /// Overshooting (Feda and Purgathofer 1992): patches send more than they have, what they would reflect of all that others have yet to send
    /// were it spread evenly. What was too much is taken back later. It ends after four shots for each patch, so that it converges whatever
    /// the scene is.
    pub overshoot: bool,
}

impl Default for SolverOptions {
    fn default() -> Self {
        Self { batch: 8, most_entries: 40_000_000, overshoot: false }
    }
}

/// What one patch sent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shot {
    /// The patch.
    pub patch: usize,
    /// The power, by red, green and blue.
    pub power: DVec3,
}

/// A solution as far as it has come, with which it can be gone on with.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SolverState {
    /// The radiosity of each patch.
    pub radiosity: Vec<DVec3>,
    /// What of it has yet to be sent; below zero, what of it was sent too much.
    pub unshot: Vec<DVec3>,
    /// Power absorbed by fronts, that arrived at backs, and that left the scene.
    pub gone: [DVec3; 3],
    /// How many times a patch has shot.
    pub shots: usize,
}

/// Solves for the radiosities of the patches of a scene by shooting: whatever has most left to send sends it.
///
/// Powers are conserved, as each row of form factors sums to 1: what is emitted is, at any time, absorbed, gone, or yet to be sent
/// ([`Solver::balance`]).
///
/// ```
/// use nusselt::factors::{Exchange, ExchangeOptions, PatchPlan, mesh_scene};
/// use nusselt::radiosity::{Solver, SolverOptions};
///
/// let (patches, _) = mesh_scene(&nusselt::samples::cornell_box().to_builder().build()?, 200.0)?;
/// let options = ExchangeOptions { tolerance: 1e-3, ..ExchangeOptions::default() };
/// let exchange = Exchange::new(&patches, PatchPlan::Polygons, options)?;
/// let mut solver = Solver::new(&patches, &exchange, SolverOptions::default())?;
/// while solver.balance().unshot_fraction() > 0.05 {
///     solver.shoot()?;
/// }
/// assert!(solver.balance().defect() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Solver<'a> {
    exchange: &'a Exchange,
    options: SolverOptions,
    emission: Vec<DVec3>,
    reflectance: Vec<DVec3>,
    state: SolverState,
    rows: Vec<Option<Arc<Row>>>,
    kept_entries: usize,
}

impl<'a> Solver<'a> {
    /// Starts with what patches emit. The exchange is that of the scene, patch by polygon.
    ///
    /// # Errors
    /// If a material has no reflectance ([`Material::reflectances`](crate::scene::Material::reflectances)), or if nothing emits.
    pub fn new(scene: &Scene, exchange: &'a Exchange, options: SolverOptions) -> Result<Self, RadiosityError> {
        let (mut emission, mut reflectance) = (Vec::new(), Vec::new());
        for PatchInfo { polygon, .. } in exchange.patches() {
            let material = scene.polygon(*polygon).material();
            let [matt, _] = material.reflectances().map_err(|source| {
                let (polygon, material) = (*polygon, material.name.clone());
                RadiosityError::BadMaterial { polygon, material, source }
            })?;
            emission.push(DVec3::from(material.emission) * PI);
            reflectance.push(matt);
        }
        let areas = exchange.patches().iter().map(|patch| patch.area);
        if !emission.iter().zip(areas).any(|(&emission, area)| strength(emission) * area > 0.0) {
            return Err(RadiosityError::Dark);
        }
        let state = SolverState { radiosity: emission.clone(), unshot: emission.clone(), ..SolverState::default() };
        let rows = vec![None; emission.len()];
        Ok(Self { exchange, options, emission, reflectance, state, rows, kept_entries: 0 })
    }

    /// Goes on from a state that [`Solver::state`] gave.
    ///
    /// # Errors
    /// If it is that of another number of patches, or has numbers that are not finite.
    pub fn resume(&mut self, state: SolverState) -> Result<(), RadiosityError> {
        let expected = self.emission.len();
        for found in [state.radiosity.len(), state.unshot.len()] {
            if found != expected {
                return Err(RadiosityError::OtherState { found, expected });
            }
        }
        let is_bad = |v: &DVec3| !v.is_finite();
        let bad = state.radiosity.iter().zip(&state.unshot).position(|(b, unshot)| is_bad(b) || is_bad(unshot));
        if let Some(patch) = bad.or(state.gone.iter().any(is_bad).then_some(0)) {
            return Err(RadiosityError::BadState { patch });
        }
        self.state = state;
        Ok(())
    }

    /// The solution as it is now.
    pub fn state(&self) -> &SolverState {
        &self.state
    }

    /// The radiosity of each patch, of its front: what it emits and reflects.
    pub fn radiosity(&self) -> &[DVec3] {
        &self.state.radiosity
    }

    /// What each patch emits.
    pub fn emission(&self) -> &[DVec3] {
        &self.emission
    }

    /// What part each patch reflects.
    pub fn reflectance(&self) -> &[DVec3] {
        &self.reflectance
    }

    fn area(&self, patch: usize) -> f64 {
        self.exchange.patches()[patch].area
    }

    fn power(&self, of: &[DVec3]) -> DVec3 {
        of.iter().enumerate().map(|(patch, &b)| b * self.area(patch)).sum()
    }

    /// Where the power is.
    pub fn balance(&self) -> Balance {
        let [absorbed, backs, background] = self.state.gone;
        let (emitted, unshot) = (self.power(&self.emission), self.power(&self.state.unshot));
        let unsettled = self.state.unshot.iter().enumerate().map(|(patch, &b)| b.abs() * self.area(patch)).sum();
        Balance { emitted, absorbed, backs, background, unshot, unsettled }
    }

    /// The ambient term of progressive refinement for each patch: what it would get in addition if all that is yet to be sent were spread evenly.
    /// For display before the solution is there; it is no part of it.
    pub fn ambient(&self) -> Vec<DVec3> {
        let irradiance = self.ambient_irradiance();
        self.reflectance.iter().map(|&reflectance| reflectance * irradiance).collect()
    }

    /// What would arrive everywhere if all that is yet to be sent were spread evenly, with what it comes back to after reflections.
    fn ambient_irradiance(&self) -> DVec3 {
        let area: f64 = self.exchange.patches().iter().map(|patch| patch.area).sum();
        let mean = self.power(&self.reflectance) / area;
        self.power(&self.state.unshot) / area / (DVec3::ONE - mean).max(DVec3::splat(1e-3))
    }

    /// The irradiance of which patches send what they will reflect; 0 unless they overshoot.
    fn anticipated(&self) -> DVec3 {
        let is_over = self.options.overshoot && self.state.shots < 4 * self.emission.len();
        if is_over { self.ambient_irradiance().max(DVec3::ZERO) } else { DVec3::ZERO }
    }

    /// The patches with the most power left to send shoot it, one after the other; what they sent. Nothing is left if that is empty.
    ///
    /// # Errors
    /// If there is no row of form factors for one of them.
    pub fn shoot(&mut self) -> Result<Vec<Shot>, RadiosityError> {
        let anticipated = self.anticipated();
        let to_send = |patch: usize| self.state.unshot[patch] + self.reflectance[patch] * anticipated;
        let left = |patch: usize| strength(to_send(patch).abs()) * self.area(patch);
        let mut order: Vec<(f64, usize)> =
            (0..self.emission.len()).map(|patch| (left(patch), patch)).filter(|(power, _)| *power > 0.0).collect();
        order.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        order.truncate(self.options.batch.max(1));
        let patches: Vec<usize> = order.into_iter().map(|(_, patch)| patch).collect();
        let rows = self.rows_of(&patches)?;
        let shots = patches.into_iter().zip(rows).map(|(patch, row)| self.send(patch, &row));
        Ok(shots.collect())
    }

    /// The rows of some patches; those that are not kept are computed by all threads.
    fn rows_of(&mut self, patches: &[usize]) -> Result<Vec<Arc<Row>>, RadiosityError> {
        let missing = patches.iter().copied().filter(|&patch| self.rows[patch].is_none()).collect();
        let exchange = self.exchange;
        let found = parallel::map(missing, |patch| (patch, exchange.row(patch)));
        let mut passing = Vec::new();
        for (patch, row) in found {
            let row = Arc::new(row?);
            if self.kept_entries + row.entries.len() <= self.options.most_entries {
                self.kept_entries += row.entries.len();
                self.rows[patch] = Some(row);
            } else {
                passing.push((patch, row));
            }
        }
        let row = |&patch: &usize| {
            let passing = || passing.iter().find(|(other, _)| *other == patch).map(|(_, row)| row.clone());
            self.rows[patch].clone().or_else(passing).unwrap_or_else(|| unreachable!("it was computed"))
        };
        Ok(patches.iter().map(row).collect())
    }

    /// Computes the rows of all patches, as far as they may be kept.
    ///
    /// # Errors
    /// If there is no row for some patch.
    pub fn compute_all_rows(&mut self) -> Result<(), RadiosityError> {
        let all: Vec<usize> = (0..self.emission.len()).collect();
        for chunk in all.chunks(256) {
            self.rows_of(chunk)?;
            if self.kept_entries >= self.options.most_entries {
                break;
            }
        }
        Ok(())
    }

    fn send(&mut self, patch: usize, row: &Row) -> Shot {
        let over = self.reflectance[patch] * self.anticipated();
        let power = (std::mem::replace(&mut self.state.unshot[patch], -over) + over) * self.area(patch);
        for entry in &row.entries {
            let receiver = entry.column as usize;
            let arrives = power * entry.share.factor;
            let reflected = arrives * self.reflectance[receiver];
            let radiosity = reflected / self.area(receiver);
            self.state.radiosity[receiver] += radiosity;
            self.state.unshot[receiver] += radiosity;
            self.state.gone[0] += arrives - reflected;
        }
        self.state.gone[1] += power * row.backs.factor;
        self.state.gone[2] += power * row.background.factor;
        self.state.shots += 1;
        Shot { patch, power }
    }

    /// Shoots until at most that part of what is emitted is left; `watch` sees the solver after every batch, and ends it by returning false. With rows of all patches kept, and
    /// a small part, this is the full-matrix solution.
    ///
    /// # Errors
    /// As [`Solver::shoot`]; also if it would never end, as nothing is absorbed.
    pub fn solve(&mut self, until: f64, mut watch: impl FnMut(&Self) -> bool) -> Result<(), RadiosityError> {
        let mut checked = (self.state.shots, self.balance().unshot_fraction());
        while self.balance().unshot_fraction() > until {
            if self.shoot()?.is_empty() || !watch(self) {
                break;
            }
            // All patches have shot many times, and as much is left.
            let patience = 20 * self.emission.len() + 1000;
            if self.state.shots - checked.0 > patience {
                let left = self.balance().unshot_fraction();
                if left > checked.1 * (1.0 - 1e-9) {
                    return Err(RadiosityError::Endless { shots: self.state.shots });
                }
                checked = (self.state.shots, left);
            }
        }
        Ok(())
    }
}
