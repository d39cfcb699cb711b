//! Interreflection, solved before pictures are taken.

use super::path::Camera;
use crate::args::Common;
use crate::failure::Failure;
use crate::progress::{Progress, SharedProgress};
use crate::radiosity::{parse_fraction, parse_size};
use glam::DVec3;
use nusselt::factors::{Exchange, ExchangeOptions, PatchMesh};
use nusselt::radiosity::{Gathered, RadiosityError, Solver, SolverOptions, SurfaceOptions};
use nusselt::render::{Indirect, RenderError, Shader, Shading};
use nusselt::scene::Scene;
use std::fmt::Display;
use std::path::Path;
use std::time::Instant;

/// How interreflection is found.
#[derive(clap::Args)]
pub(super) struct Interreflection {
    /// Show light straight from lamps, sky and lights alone; without it surfaces light each other too, by the radiosity of what polygons
    /// emit
    #[arg(long, conflicts_with_all = ["gather", "patch", "until", "tolerance", "detail", "depth"])]
    pub(super) direct: bool,
    /// Gather interreflected light at every point from all patches that it sees, instead of interpolating it between
    /// corners of a mesh; slower. Hemicubes and rays always do
    #[arg(long)]
    gather: bool,
    /// Mesh polygons, those of one plane and material together, into patches with edges of at most this length, in scene
    /// units [default: a 12th of the scene's diagonal]
    #[arg(long, value_name = "SIZE", value_parser = parse_size, allow_hyphen_values = true)]
    patch: Option<f64>,
    /// Stop when so much of the emitted power is left to be sent, in each group of surfaces that exchange light
    #[arg(long, value_name = "FRACTION", default_value = "1e-4", value_parser = parse_fraction, allow_hyphen_values = true)]
    until: f64,
    /// Compute each form factor between patches to this absolute error and shoot with them, as radiosity does; slower [default: by one to
    /// four exact views from each patch, and gathering]
    #[arg(long, value_name = "T", value_parser = parse_size, allow_hyphen_values = true)]
    tolerance: Option<f64>,
    /// Halve edges of patches where the interreflected light in their middle differs by more than this part from what their ends say
    #[arg(long, value_name = "PART", default_value = "0.03", value_parser = parse_size, allow_hyphen_values = true)]
    detail: f64,
    /// How often at most an edge of a patch is halved
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(0..=8))]
    depth: u32,
}

/// What it took; zeros if there is none.
#[derive(Default)]
pub(super) struct Solved {
    pub(super) patches: usize,
    pub(super) shots: usize,
    pub(super) bounces: usize,
    pub(super) corners: usize,
    pub(super) solve_s: f64,
    pub(super) surface_s: f64,
}

/// Edges of patches are at most this part of the scene's diagonal.
const PART: f64 = 1.0 / 12.0;
/// Form factors between patches take 16 bytes each, twice for a while.
const MOST_FACTORS: usize = 30_000_000;

impl Interreflection {
    /// Adds it to a shader, if it is wanted and something emits.
    pub(super) fn add_to(
        &self,
        shader: Shader,
        shading: Shading,
        cameras: &[Camera],
        file: &Path,
        common: &Common,
    ) -> Result<(Shader, Solved), Failure> {
        if self.direct {
            return Ok((shader, Solved::default()));
        }
        let failed = |error: &dyn Display| Failure::about(file, &error);
        let scene = shader.scene().clone();
        let start = Instant::now();
        let longest = self.patch.unwrap_or(scene.diagonal() * PART);
        if scene.piece_count() == 0 || longest <= 0.0 {
            return Ok((shader, Solved::default()));
        }
        let (mesh, hosts) = PatchMesh::joined(&scene, longest).map_err(|error| failed(&error))?;
        let patches = mesh.patches().map_err(|error| failed(&error))?;
        let default = ExchangeOptions::default();
        let options = ExchangeOptions { tolerance: self.tolerance.unwrap_or(default.tolerance), ..default };
        // Patches as parts of whole polygons, of which there are fewer to see.
        let exchange = Exchange::of_mesh(&mesh, options).map_err(|error| failed(&error))?;
        let solution = match self.tolerance {
            None => self.by_views(&scene, &exchange, longest, common),
            Some(_) => self.by_shooting(&scene, &exchange, common),
        };
        let solution = match solution {
            Err(RadiosityError::Dark) => return Ok((shader, Solved::default())),
            solution => solution.map_err(|error| failed(&error))?,
        };
        let solve_s = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let count = scene.polygon_count();
        let mut indirect =
            Indirect::new(&patches, &mesh.polygons(), count, &solution.emission, &solution.radiosity).with_hosts(hosts);
        if !self.gather && shading == Shading::Contour {
            let options = SurfaceOptions { detail: self.detail, depth: self.depth, ..SurfaceOptions::default() };
            let mut shown = vec![false; patches.polygon_count()];
            for camera in cameras {
                let by_camera = shader.shown(&indirect, camera.eye, &camera.frustum);
                let by_camera = by_camera.map_err(|error| camera.place(failed(&error)))?;
                shown.iter_mut().zip(by_camera).for_each(|(shown, is_shown)| *shown |= is_shown);
            }
            let views = SharedProgress::new("views from corners", None, common.quiet);
            indirect = indirect
                .interpolated_on(&shown, &exchange, &mesh.regions(), &options, &|count| views.add(count))
                .map_err(|error| failed(&error))?;
        }
        let solved = Solved {
            patches: patches.polygon_count(),
            shots: solution.shots,
            bounces: solution.bounces,
            corners: indirect.corner_count(),
            solve_s,
            surface_s: start.elapsed().as_secs_f64(),
        };
        let shader = shader.with_indirect(indirect).map_err(|error: RenderError| failed(&error))?;
        Ok((shader, solved))
    }

    fn by_views(
        &self,
        scene: &Scene,
        exchange: &Exchange,
        longest: f64,
        common: &Common,
    ) -> Result<Solution, RadiosityError> {
        // What has no solution is not looked at.
        Gathered::check(scene, exchange)?;
        let progress = SharedProgress::new("rows", Some(exchange.patches().len()), common.quiet);
        let rows = exchange.viewed_rows(0.5 * longest, MOST_FACTORS, &|count| progress.add(count))?;
        drop(progress);
        let mut progress = Progress::new("bounces", None, common.quiet);
        let Gathered { emission, radiosity, bounces } =
            Gathered::watched(scene, exchange, &rows, self.until, |left| {
                progress.note(format!("{left:.2e} unshot"));
                progress.add(1);
            })?;
        Ok(Solution { emission, radiosity, shots: 0, bounces })
    }

    fn by_shooting(&self, scene: &Scene, exchange: &Exchange, common: &Common) -> Result<Solution, RadiosityError> {
        let mut solver = Solver::new(scene, exchange, SolverOptions::default())?;
        let mut progress = Progress::new("shots", None, common.quiet);
        let mut shots = 0;
        solver.solve(self.until, |solver| {
            progress.add(solver.state().shots - shots);
            shots = solver.state().shots;
            progress.note(format!("{:.2e} unshot", solver.balance().unshot_fraction()));
            true
        })?;
        let [emission, radiosity] = [solver.emission(), solver.radiosity()].map(<[DVec3]>::to_vec);
        Ok(Solution { emission, radiosity, shots, bounces: 0 })
    }
}

/// The radiosity of patches, and how many shots it took, or how many bounces.
struct Solution {
    emission: Vec<DVec3>,
    radiosity: Vec<DVec3>,
    shots: usize,
    bounces: usize,
}
