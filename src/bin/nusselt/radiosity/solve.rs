//! Solving, for patches as they are first and as they are halved then; and keeping what there is of it.

use super::{Keep, Radiosity, Stage};
use crate::failure::Failure;
use crate::output::write_file;
use crate::progress::{Progress, SharedProgress};
use nusselt::factors::{ExchangeOptions, PatchMesh};
use nusselt::io::matrix::{MatrixError, MatrixJob, MatrixWriter};
use nusselt::io::radiosity::{HalvingKey, KeptState, StateKey, read_state, write_state};
use nusselt::radiosity::{Gather, RadiosityError, Solver, SolverOptions, uneven_patches};
use nusselt::scene::Scene;
use std::fs;
use std::time::{Duration, Instant};

/// How often a state is kept.
const KEEP_EVERY: Duration = Duration::from_secs(10);
/// What --full leaves to be sent.
const ROUNDING: f64 = 1e-12;

pub(super) struct Work<'a> {
    pub(super) asked: &'a Radiosity,
    pub(super) scene: &'a Scene,
    pub(super) quiet: bool,
}

/// What a kept state belongs to, and the patches that were halved.
struct Keeping {
    key: StateKey,
    halved: Vec<Vec<u32>>,
}

/// A mesh with some patches halved.
struct Halved {
    mesh: PatchMesh,
    /// The patch that each was part of.
    parents: Vec<usize>,
    /// Which were to be halved, ascending.
    list: Vec<u32>,
}

impl Work<'_> {
    fn exchange_options(&self) -> ExchangeOptions {
        ExchangeOptions { tolerance: self.asked.tolerance, ..ExchangeOptions::default() }
    }

    fn until(&self) -> f64 {
        if self.asked.full { ROUNDING } else { self.asked.until }
    }

    pub(super) fn first_stage(&self) -> Result<Stage, Failure> {
        let longest = self.asked.patch.unwrap_or(f64::INFINITY);
        let mesh = PatchMesh::new(self.scene, longest).map_err(|error| self.asked.about(&error))?;
        Stage::of_mesh(mesh, self.exchange_options()).map_err(|error| self.asked.about(&error))
    }

    /// Solves, and gives what there is in the end: patches, their solution, and how many were halved each time, until none were uneven or it was as often as asked for.
    pub(super) fn solve<T>(
        &self,
        mut stage: Stage,
        finish: impl FnOnce(&Stage, &Solver<'_>, &[usize]) -> Result<T, Failure>,
    ) -> Result<T, Failure> {
        let mut keeping = Keeping { key: self.key(&stage), halved: Vec::new() };
        let mut state = None;
        if let Some(kept) = self.kept(&keeping.key)? {
            for list in &kept.halved {
                stage.mesh = stage.mesh.halved(|patch| is_in(list, patch)).0;
            }
            if !kept.halved.is_empty() {
                stage =
                    Stage::of_mesh(stage.mesh, self.exchange_options()).map_err(|error| self.asked.about(&error))?;
            }
            keeping.halved = kept.halved;
            state = Some(kept.solver);
        }
        let mut guess = None;
        loop {
            let options = SolverOptions { overshoot: self.asked.overshoot, ..SolverOptions::default() };
            let mut solver =
                Solver::new(self.scene, &stage.exchange, options).map_err(|error| self.asked.about(&error))?;
            if let Some(state) = state.take() {
                let path = self.asked.keep.state.as_deref().unwrap_or(&self.asked.scene);
                solver.resume(state).map_err(|error| Failure::about(path, &error))?;
            }
            if let Some(guess) = guess.take() {
                solver.start_from(guess).map_err(|error| self.asked.about(&error))?;
                self.keep(&keeping, &solver)?;
            }
            self.solve_stage(&keeping, &stage, &mut solver)?;
            let is_last = keeping.halved.len() >= self.asked.subdivide as usize;
            let halved = if is_last { None } else { self.halved(&stage, &solver)? };
            let Some(Halved { mesh, parents, list }) = halved else {
                let counts: Vec<usize> = keeping.halved.iter().map(Vec::len).collect();
                return finish(&stage, &solver, &counts);
            };
            guess = Some(parents.into_iter().map(|parent| solver.radiosity()[parent]).collect());
            keeping.halved.push(list);
            stage = Stage::of_mesh(mesh, self.exchange_options()).map_err(|error| self.asked.about(&error))?;
        }
    }

    fn key(&self, stage: &Stage) -> StateKey {
        let Radiosity { subdivide, gradient, overshoot, tolerance, .. } = *self.asked;
        let halving = (subdivide > 0).then(|| HalvingKey { gradient, until: self.until() });
        StateKey { overshoot, halving, ..StateKey::new(&stage.patches, tolerance) }
    }

    /// What was kept, if it is to be gone on from.
    fn kept(&self, key: &StateKey) -> Result<Option<KeptState>, Failure> {
        let Radiosity { keep: Keep { state, resume }, subdivide, .. } = self.asked;
        let Some(path) = state.as_ref().filter(|path| *resume && path.exists()) else { return Ok(None) };
        let text = fs::read_to_string(path)
            .map_err(|error| Failure::Work(format!("cannot read {}: {error}", path.display())))?;
        let kept = read_state(key, &text).map_err(|error| Failure::about(path, &error))?;
        if kept.halved.len() > *subdivide as usize {
            let times = kept.halved.len();
            let what = format!(
                "patches were halved {times} times; ask for --subdivide {times} or more, or leave out --resume"
            );
            return Err(Failure::about(path, &what));
        }
        Ok(Some(kept))
    }

    fn keep(&self, keeping: &Keeping, solver: &Solver<'_>) -> Result<(), Failure> {
        let Some(path) = &self.asked.keep.state else { return Ok(()) };
        write_file(path, |out| write_state(&keeping.key, &keeping.halved, solver.state(), out))
    }

    /// Halves those patches on which the light changes; none if there are none.
    fn halved(&self, stage: &Stage, solver: &Solver<'_>) -> Result<Option<Halved>, Failure> {
        let gather = Gather::new(&stage.exchange, solver.emission(), solver.reflectance(), solver.radiosity());
        let views = SharedProgress::new("views from corners", None, self.quiet);
        let done = |count| views.add(count);
        let uneven = uneven_patches(&stage.patches, &stage.regions, &gather, self.asked.gradient, &done)
            .map_err(|error| self.asked.about(&error))?;
        drop(views);
        let list: Vec<u32> = (0..uneven.len() as u32).filter(|&patch| uneven[patch as usize]).collect();
        if list.is_empty() {
            return Ok(None);
        }
        let (mesh, parents) = stage.mesh.halved(|patch| uneven[patch]);
        Ok(Some(Halved { mesh, parents, list }))
    }

    fn solve_stage(&self, keeping: &Keeping, stage: &Stage, solver: &mut Solver<'_>) -> Result<(), Failure> {
        let is_solved = solver.is_settled(self.until());
        let rows = if self.asked.full && !is_solved { self.compute_rows(keeping, stage, solver)? } else { None };
        if self.asked.full && !is_solved {
            // What was guessed is sent first.
            solver.solve(f64::INFINITY, |_| true).map_err(|error| self.asked.about(&error))?;
            solver.settle();
        }
        let mut progress = Progress::new("shots", None, self.quiet);
        let mut kept = Instant::now();
        let mut shots = solver.state().shots;
        let mut failure = None;
        let result = solver.solve(self.until(), |solver| {
            progress.add(solver.state().shots - shots);
            shots = solver.state().shots;
            progress.note(format!("{:.2e} unshot", solver.balance().unshot_fraction()));
            if kept.elapsed() > KEEP_EVERY {
                kept = Instant::now();
                failure = self.keep(keeping, solver).err();
            }
            failure.is_none()
        });
        drop(progress);
        result.map_err(|error| self.asked.about(&error))?;
        failure.map_or(Ok(()), Err)?;
        self.keep(keeping, solver)?;
        rows.map_or(Ok(()), |rows| rows.discard().map_err(|error| failed(&error)))
    }

    /// Computes all rows, and keeps them beside the state, if there is one, until it is solved.
    fn compute_rows(
        &self,
        keeping: &Keeping,
        stage: &Stage,
        solver: &mut Solver<'_>,
    ) -> Result<Option<MatrixWriter>, Failure> {
        let patches = stage.exchange.patches();
        let job = MatrixJob::new(&stage.patches, patches).with_option("--tolerance", self.asked.tolerance);
        let mut writer = match self.asked.rows_file(keeping.halved.len() as u32) {
            Some(path) if self.asked.keep.resume => {
                Some(MatrixWriter::resume_with(&path, &job, |row| solver.take_row(row.clone())))
            }
            Some(path) => {
                // Rows of another run are of no use.
                for old in &MatrixWriter::files(&path)[1..] {
                    let _ = fs::remove_file(old);
                }
                Some(MatrixWriter::create(&path, &job))
            }
            None => None,
        }
        .transpose()
        .map_err(|error| failed(&error))?;
        if writer.is_some() {
            // Rows alone do not tell what is halved.
            self.keep(keeping, solver)?;
        }
        let first = writer.as_ref().map_or(0, |writer| writer.next_row() as usize);
        let mut progress = Progress::new("rows", Some(patches.len() - first), self.quiet);
        solver
            .compute_rows(first, |row| {
                progress.add(1);
                writer
                    .as_mut()
                    .map_or(Ok(()), |writer| writer.row(row).map_err(|error| Stopped::Failed(failed(&error))))
            })
            .map_err(|stopped| match stopped {
                Stopped::Failed(failure) => failure,
                Stopped::NoRow(error) => self.asked.about(&error),
            })?;
        Ok(writer)
    }
}

/// Why there are not all rows.
enum Stopped {
    Failed(Failure),
    NoRow(RadiosityError),
}

impl From<RadiosityError> for Stopped {
    fn from(error: RadiosityError) -> Self {
        Self::NoRow(error)
    }
}

fn failed(error: &MatrixError) -> Failure {
    Failure::Work(error.to_string())
}

fn is_in(list: &[u32], patch: usize) -> bool {
    u32::try_from(patch).is_ok_and(|patch| list.binary_search(&patch).is_ok())
}
