//! Progressive refinement.

mod settle;

use super::groups::{GAPS, alone, firsts, join};
use super::{Balance, RadiosityError, strength};
use crate::factors::{Exchange, PatchInfo, Row, RowsOnce};
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
    /// What patches send first, whether they have it or not: radiosities from a similar solution, or none.
    pub guess: Vec<DVec3>,
    /// So many patches have sent that, in their order.
    pub guessed: usize,
    /// For each patch itself, or one of a lower number that it is known to exchange light with, directly or through others. May be empty for a start.
    pub groups: Vec<u32>,
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
    source: RowsOnce<'a>,
    rows: Vec<Option<Arc<Row>>>,
    kept_entries: usize,
}

impl<'a> Solver<'a> {
    /// Starts with what patches emit. The exchange is that of the scene, patch by polygon.
    ///
    /// # Errors
    /// If a material has no reflectance ([`Material::reflectances`](crate::scene::Material::reflectances)), if nothing emits, or if
    /// numbers do not hold the power that is emitted, its parts, or the area of a patch.
    pub fn new(scene: &Scene, exchange: &'a Exchange, options: SolverOptions) -> Result<Self, RadiosityError> {
        let (emission, reflectance) = surfaces(scene, exchange)?;
        check_parts(exchange.patches(), &emission)?;
        let (radiosity, unshot, groups) = (emission.clone(), emission.clone(), alone(emission.len()));
        let state = SolverState { radiosity, unshot, groups, ..SolverState::default() };
        let rows = vec![None; emission.len()];
        let source = RowsOnce::new(exchange);
        Ok(Self { exchange, options, emission, reflectance, state, source, rows, kept_entries: 0 })
    }

    /// Starts anew, from radiosities that the solution will be near to, such as those of coarser patches: every patch sends as much first, as if it had it,
    /// and what was wrong is settled after that. The solution is the same, to what is left; it takes one row for every patch, and few more shots.
    ///
    /// # Errors
    /// If there is not one for every patch, or one is not finite.
    pub fn start_from(&mut self, guess: Vec<DVec3>) -> Result<(), RadiosityError> {
        let (radiosity, unshot) = (self.emission.clone(), self.emission.clone());
        self.resume(SolverState { radiosity, unshot, guess, ..SolverState::default() })
    }

    /// Goes on from a state that [`Solver::state`] gave.
    ///
    /// # Errors
    /// If it is that of another number of patches, or has numbers that are not finite.
    pub fn resume(&mut self, state: SolverState) -> Result<(), RadiosityError> {
        let expected = self.emission.len();
        let guess = if state.guess.is_empty() { expected } else { state.guess.len() };
        let groups = if state.groups.is_empty() { expected } else { state.groups.len() };
        for found in [state.radiosity.len(), state.unshot.len(), groups, guess] {
            if found != expected {
                return Err(RadiosityError::OtherState { found, expected });
            }
        }
        let is_bad = |v: &DVec3| !v.is_finite();
        let first_bad = |list: &[DVec3]| list.iter().position(is_bad);
        let lists = [&state.radiosity, &state.unshot, &state.guess];
        let bad_group = (0..).zip(&state.groups).position(|(patch, &group)| group > patch);
        let bad = lists.into_iter().filter_map(|list| first_bad(list)).chain(bad_group).min();
        // Nor may any of their powers be more than numbers hold.
        let is_bad_power = |list: &Vec<DVec3>| is_bad(&(ROOM * self.power(list)));
        if let Some(patch) = bad.or((state.gone.iter().any(is_bad) || lists.into_iter().any(is_bad_power)).then_some(0))
        {
            return Err(RadiosityError::BadState { patch });
        }
        self.state = state;
        if self.state.groups.is_empty() {
            self.state.groups = alone(expected);
        }
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

    /// The ambient term of progressive refinement for each patch (Cohen et al. 1988, section 4.3): the radiosity that it would have in addition if all that is yet to be
    /// sent were spread evenly over all surfaces, and reflected by each as by their mean, again and again: with areas A, reflectances rho and what is unshot dB,
    ///
    /// ```text
    /// ambient_i = rho_i sum(dB_j A_j) / sum(A_j) / (1 - sum(rho_j A_j) / sum(A_j))
    /// ```
    ///
    /// by channel; a mean reflectance above 0.999 is taken as that. For display before the solution is there; it is no part of it.
    pub fn ambient(&self) -> Vec<DVec3> {
        let irradiance = self.ambient_irradiance();
        self.reflectance.iter().map(|&reflectance| reflectance * irradiance).collect()
    }

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
        self.shoot_from(|_| true)
    }

    /// The same, of those patches that may.
    fn shoot_from(&mut self, may_shoot: impl Fn(usize) -> bool) -> Result<Vec<Shot>, RadiosityError> {
        let batch = self.options.batch.max(1);
        if self.is_guessing() {
            let end = (self.state.guessed + batch).min(self.state.guess.len());
            let has_some = |&patch: &usize| self.state.guess[patch] != DVec3::ZERO;
            let patches: Vec<usize> = (self.state.guessed..end).filter(has_some).collect();
            let rows = self.rows_of(&patches)?;
            self.state.guessed = end;
            let shots = patches.into_iter().zip(rows).map(|(patch, row)| {
                let sent = self.state.guess[patch];
                self.state.unshot[patch] -= sent;
                self.send(patch, &row, sent)
            });
            return Ok(shots.collect());
        }
        let anticipated = self.anticipated();
        let to_send = |patch: usize| self.state.unshot[patch] + self.reflectance[patch] * anticipated;
        let left = |patch: usize| strength(to_send(patch).abs()) * self.area(patch);
        let patches = (0..self.emission.len()).filter(|&patch| may_shoot(patch));
        let mut order: Vec<(f64, usize)> =
            patches.map(|patch| (left(patch), patch)).filter(|(power, _)| *power > 0.0).collect();
        order.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        order.truncate(batch);
        let patches: Vec<usize> = order.into_iter().map(|(_, patch)| patch).collect();
        let rows = self.rows_of(&patches)?;
        let shots = patches.into_iter().zip(rows).map(|(patch, row)| {
            let over = self.reflectance[patch] * self.anticipated();
            let unshot = std::mem::replace(&mut self.state.unshot[patch], -over);
            self.send(patch, &row, unshot + over)
        });
        Ok(shots.collect())
    }

    /// True as long as patches send what was guessed that they have.
    pub fn is_guessing(&self) -> bool {
        self.state.guessed < self.state.guess.len()
    }

    /// The rows of some patches; those that are not kept are computed by all threads.
    fn rows_of(&mut self, patches: &[usize]) -> Result<Vec<Arc<Row>>, RadiosityError> {
        let missing = patches.iter().copied().filter(|&patch| self.rows[patch].is_none()).collect();
        let source = &self.source;
        let found = parallel::map(missing, |patch| (patch, source.row(patch)));
        let mut passing = Vec::new();
        for (patch, row) in found {
            let row = Arc::new(row?);
            if !self.keep(&row) {
                passing.push((patch, row));
            }
        }
        let row = |&patch: &usize| {
            let passing = || passing.iter().find(|(other, _)| *other == patch).map(|(_, row)| row.clone());
            self.rows[patch].clone().or_else(passing).unwrap_or_else(|| unreachable!("it was computed"))
        };
        Ok(patches.iter().map(row).collect())
    }

    /// Keeps a row if there is room for it.
    fn keep(&mut self, row: &Arc<Row>) -> bool {
        let has_room = self.kept_entries + row.entries.len() <= self.options.most_entries;
        if has_room {
            self.kept_entries += row.entries.len();
            self.rows[row.patch as usize] = Some(row.clone());
        }
        has_room
    }

    /// Takes a row that was computed before, for the same patches and with the same options, as far as it may be kept.
    ///
    /// # Panics
    /// If there is no such patch.
    pub fn take_row(&mut self, row: Row) {
        if self.rows[row.patch as usize].is_none() {
            self.keep(&Arc::new(row));
        }
    }

    /// Computes the rows of all patches from a first one on, in their order, and keeps them as far as they may be; `made` sees each, and ends it by an error.
    ///
    /// # Errors
    /// If there is no row for some patch, or that of `made`.
    pub fn compute_rows<E: From<RadiosityError>>(
        &mut self,
        first: usize,
        mut made: impl FnMut(&Row) -> Result<(), E>,
    ) -> Result<(), E> {
        let all: Vec<usize> = (first..self.emission.len()).collect();
        all.chunks(32).try_for_each(|chunk| self.rows_of(chunk)?.iter().try_for_each(|row| made(row)))
    }

    fn send(&mut self, patch: usize, row: &Row, radiosity: DVec3) -> Shot {
        let power = radiosity * self.area(patch);
        for entry in &row.entries {
            let receiver = entry.column as usize;
            if entry.share.factor > entry.share.error.max(GAPS) {
                join(&mut self.state.groups, patch as u32, entry.column);
            }
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

    /// For each patch the first one of its group, and for each of these what part of the power that is emitted in the group is yet to be sent there, or was sent too much. Groups in which nothing is emitted are one
    /// with that in which most is, so that of all together no larger part is left.
    fn left_in_groups(&self) -> (Vec<u32>, Vec<f64>) {
        let mut firsts = firsts(&self.state.groups);
        let sums = |of: &[DVec3], firsts: &[u32]| {
            let mut sums = vec![DVec3::ZERO; firsts.len()];
            for (patch, &first) in firsts.iter().enumerate() {
                sums[first as usize] += of[patch].abs() * self.area(patch);
            }
            sums
        };
        let emitted = sums(&self.emission, &firsts);
        let brightest = (0..firsts.len()).max_by(|&a, &b| strength(emitted[a]).total_cmp(&strength(emitted[b])));
        for first in &mut firsts {
            // Numbers do not hold parts of less.
            if strength(emitted[*first as usize]) < FAINT {
                *first = brightest.unwrap_or(0) as u32;
            }
        }
        let (emitted, left) = (sums(&self.emission, &firsts), sums(&self.state.unshot, &firsts));
        let part = |(left, emitted): (&DVec3, &DVec3)| {
            if *left == DVec3::ZERO { 0.0 } else { strength(*left) / strength(*emitted) }
        };
        let parts = left.iter().zip(&emitted).map(part).collect();
        (firsts, parts)
    }

    /// True if nothing but at most that part of what is emitted is left to be sent, in each group of patches that exchange light, directly or through others.
    pub fn is_settled(&self, until: f64) -> bool {
        !self.is_guessing() && self.left_in_groups().1.iter().all(|&left| left <= until)
    }

    /// Shoots until at most that part of what is emitted is left, in each group of patches that exchange light, directly or through others: a dim room is solved as well as it would be without a bright one that it does not see.
    /// `watch` sees the solver after every batch, and ends it by returning false. After [`Solver::settle`], and with
    /// a small part, this is the full-matrix solution.
    ///
    /// # Errors
    /// As [`Solver::shoot`]; also if it would not end, as less than 1e-9 of what is left is absorbed while every patch shoots twenty times.
    pub fn solve(&mut self, until: f64, mut watch: impl FnMut(&Self) -> bool) -> Result<(), RadiosityError> {
        let mut checked = (self.state.shots, f64::INFINITY);
        loop {
            let was_guessing = self.is_guessing();
            let (firsts, left) = self.left_in_groups();
            let sum: f64 = left.iter().filter(|&&left| left > until).sum();
            if !was_guessing && sum <= 0.0 {
                return Ok(());
            }
            let shots = self.shoot_from(|patch| left[firsts[patch] as usize] > until)?;
            if shots.is_empty() && !was_guessing || !watch(self) {
                return Ok(());
            }
            // All patches have shot many times, and as much is left.
            let patience = 20 * self.emission.len() + 1000;
            if self.state.shots - checked.0 > patience {
                if sum > checked.1 * (1.0 - 1e-9) {
                    return Err(RadiosityError::Endless { shots: self.state.shots });
                }
                checked = (self.state.shots, sum);
            }
        }
    }
}

/// Powers are added up, and multiplied by what anticipates reflections: so many times their sum has to be a number.
const ROOM: f64 = 1e6;

/// Checks that something emits, and that numbers hold all of it, and the areas that it arrives at.
fn check_power(patches: &[PatchInfo], emission: &[DVec3]) -> Result<(), RadiosityError> {
    if emission.iter().all(|&emission| emission == DVec3::ZERO) {
        return Err(RadiosityError::Dark);
    }
    if let Some(&PatchInfo { polygon, .. }) = patches.iter().find(|patch| !patch.area.is_finite()) {
        return Err(RadiosityError::TooLarge { polygon });
    }
    let mut sum = 0.0;
    for (&PatchInfo { polygon, area, .. }, &emission) in patches.iter().zip(emission) {
        sum += strength(emission) * area;
        if !(ROOM * strength(emission)).is_finite() || !(ROOM * sum).is_finite() {
            return Err(RadiosityError::TooBright { polygon });
        }
    }
    if sum > 0.0 {
        return Ok(());
    }
    // What has no area emits nothing; else numbers do not hold what it emits.
    let emits = |&(patch, &emission): &(&PatchInfo, &DVec3)| patch.shape.is_some() && emission != DVec3::ZERO;
    let first = patches.iter().zip(emission).find(emits);
    Err(first.map_or(RadiosityError::Dark, |(patch, _)| RadiosityError::TooDim { polygon: patch.polygon }))
}

/// Below some 1e-308 numbers lose digits: each is off by 5e-324 at most, and so is a power by that times an area. With as many as 1e10 operations those are 5e-14 of all that is emitted.
const FAINT: f64 = 1e-300;

/// Checks that numbers hold parts of what is emitted as precisely as the whole.
fn check_parts(patches: &[PatchInfo], emission: &[DVec3]) -> Result<(), RadiosityError> {
    let power = |k: &usize| strength(emission[*k]) * patches[*k].area;
    let whole: f64 = (0..patches.len()).map(|k| power(&k)).sum();
    let area: f64 = patches.iter().map(|patch| patch.area).sum();
    if whole >= FAINT && whole / area >= FAINT {
        return Ok(());
    }
    let most = (0..patches.len()).max_by(|a, b| power(a).total_cmp(&power(b)));
    Err(most.map_or(RadiosityError::Dark, |most| RadiosityError::TooDim { polygon: patches[most].polygon }))
}

/// What each patch emits, and what part it reflects.
pub(super) fn surfaces(scene: &Scene, exchange: &Exchange) -> Result<(Vec<DVec3>, Vec<DVec3>), RadiosityError> {
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
    check_power(exchange.patches(), &emission)?;
    Ok((emission, reflectance))
}
