//! `nusselt radiosity`: diffuse interreflection.

use crate::args::{Common, Loading, parse_direction};
use crate::failure::Failure;
use crate::input::load_materials;
use crate::output::{check_once, print, print_json, write_file};
use crate::progress::{Progress, SharedProgress};
use crate::summary::{Lines, Timing, number};
use glam::DVec3;
use nusselt::contour::SceneOrder;
use nusselt::factors::{Exchange, ExchangeOptions, PatchPlan, mesh_scene};
use nusselt::io::gltf::write_glb;
use nusselt::io::radiosity::{
    RadiosityTable, StateKey, auto_exposure, radiosity_meshes, read_state, write_radiosity_html, write_radiosity_json,
    write_radiosity_ply, write_state,
};
use nusselt::radiosity::{Gather, Solver, SolverOptions, Surface, SurfaceOptions};
use nusselt::scene::{PolygonId, Scene};
use serde_json::json;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

const EXAMPLE: &str = "\
Examples: a room in patches of at most 0.3 m, for a viewer and as a page that shows itself
  nusselt radiosity room.obj --patch 0.3 -o room.glb -o room.html

A long one, kept every ten seconds, and on again after an interruption
  nusselt radiosity hall.obj --patch 0.2 --until 1e-4 --state hall.state -o hall.ply
  nusselt radiosity hall.obj --patch 0.2 --until 1e-4 --state hall.state --resume -o hall.ply";

/// How often a state is kept.
const KEEP_EVERY: Duration = Duration::from_secs(10);

/// Solve for diffuse interreflection by progressive refinement, with exact visibility
#[derive(clap::Args)]
#[command(after_help = EXAMPLE)]
pub(crate) struct Radiosity {
    /// The scene: OBJ, glTF, GLB, STL, PLY or CityJSON. Emissions (Ke) are radiances, of fronts; diffuse colours (Kd)
    /// are what part is reflected
    scene: PathBuf,
    /// Mesh polygons into patches with edges of at most this length, in scene units [default: polygons as they are]
    #[arg(long, value_name = "SIZE", value_parser = parse_size, allow_hyphen_values = true)]
    patch: Option<f64>,
    /// Stop when so much of the emitted power is left to be sent
    #[arg(long, value_name = "FRACTION", default_value = "0.01", value_parser = parse_fraction, allow_hyphen_values = true)]
    until: f64,
    /// Solve the whole matrix instead: all rows of form factors are computed, and nothing but rounding (1e-12) is left
    #[arg(long, conflicts_with = "until")]
    full: bool,
    /// Let patches send in advance what they will reflect, and take back what was too much: fewer shots in bright closed rooms
    #[arg(long)]
    overshoot: bool,
    /// Compute each form factor to this absolute error
    #[arg(long, value_name = "T", default_value = "1e-3", value_parser = parse_size, allow_hyphen_values = true)]
    tolerance: f64,
    /// Halve edges of patches where the radiosity in their middle differs by more than this part from what their ends
    /// say; in .glb, .ply and .html
    #[arg(long, value_name = "PART", default_value = "0.03", value_parser = parse_size, allow_hyphen_values = true)]
    detail: f64,
    /// How often at most an edge of a patch is halved; 0 shows patches as they are
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(0..=8))]
    depth: u32,
    /// Show radiances times this [default: so that 95% of what reflects is at most 0.8]
    #[arg(long, value_name = "FACTOR", value_parser = parse_size, allow_hyphen_values = true)]
    exposure: Option<f64>,
    /// What is up in .html, where it can be changed [default: 0,1,0 for glTF, which has it so, and 0,0,1 for everything else]
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_direction, allow_hyphen_values = true)]
    up: Option<DVec3>,
    /// Write to this file; the ending decides: .glb (colours at vertices), .ply (radiosities too), .html (a page with a
    /// viewer) or .json (patches, and where the power goes). May be repeated
    #[arg(short, long, value_name = "FILE", value_parser = Output::parse)]
    output: Vec<Output>,
    /// Keep the solution in this file every ten seconds and in the end
    #[arg(long, value_name = "FILE")]
    state: Option<PathBuf>,
    /// Go on from the file of --state, if it is there
    #[arg(long, requires = "state")]
    resume: bool,
    #[command(flatten)]
    loading: Loading,
}

pub(crate) fn parse_size(text: &str) -> Result<f64, String> {
    let size = text.trim().parse().ok().filter(|x: &f64| x.is_finite() && *x > 0.0);
    size.ok_or_else(|| "it takes a number above 0".to_owned())
}

pub(crate) fn parse_fraction(text: &str) -> Result<f64, String> {
    let fraction = text.trim().parse().ok().filter(|x: &f64| (1e-13..=1.0).contains(x));
    fraction.ok_or_else(|| "it takes a part of what is emitted, from 1e-13 to 1".to_owned())
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Format {
    Glb,
    Ply,
    Html,
    Json,
}

#[derive(Clone)]
struct Output {
    path: PathBuf,
    format: Format,
}

impl Output {
    fn parse(text: &str) -> Result<Self, String> {
        let path = PathBuf::from(text);
        let format = match path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).as_deref() {
            Some("glb") => Format::Glb,
            Some("ply") => Format::Ply,
            Some("html") => Format::Html,
            Some("json") => Format::Json,
            _ => return Err("its ending is none of .glb, .ply, .html, .json".to_owned()),
        };
        Ok(Self { path, format })
    }
}

impl Radiosity {
    pub(crate) fn run(&self, common: &Common) -> Result<(), Failure> {
        let files: Vec<&Path> =
            self.output.iter().map(|output| output.path.as_path()).chain(self.state.as_deref()).collect();
        check_once(files.iter().copied())?;
        let (scene, materials, load_s) = load_materials(&self.scene, files.iter().copied(), &self.loading, common)?;
        materials.check(&scene, common, |_| true)?;
        let (patches, of) = self.mesh(&scene)?;
        let start = Instant::now();
        let options = ExchangeOptions { tolerance: self.tolerance, ..ExchangeOptions::default() };
        // The same patches as parts of whole polygons, of which there are fewer to see.
        let plan = self.patch.map_or(PatchPlan::Polygons, |longest_edge| PatchPlan::Mesh { longest_edge });
        let exchange = Exchange::new(&scene, plan, options).map_err(|error| self.about(&error))?;
        let order_s = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let options = SolverOptions { overshoot: self.overshoot, ..SolverOptions::default() };
        let mut solver = Solver::new(&scene, &exchange, options).map_err(|error| self.about(&error))?;
        let key = StateKey::new(&patches, self.tolerance);
        self.take_up(&key, &mut solver)?;
        self.solve(&key, &mut solver, common)?;
        let solve_s = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let surface = self.write(&patches, &of, &exchange, &solver, common)?;
        let surface_s = start.elapsed().as_secs_f64();
        let timing = Timing::of_many(load_s, order_s, solver.state().shots, solve_s * 1e3, 0.0);
        let balance = solver.balance();
        let corners = surface.map_or(0, |surface| surface.positions.len());
        if common.json {
            return print_json(&json!({
                "schema": "nusselt.radiosity/1", "patches": exchange.patches().len(), "shots": solver.state().shots,
                "unshot": balance.unshot_fraction(), "defect": balance.defect(),
                "emitted": balance.emitted.to_array(), "absorbed": balance.absorbed.to_array(),
                "backs": balance.backs.to_array(), "background": balance.background.to_array(),
                "corners": corners, "solve_s": solve_s, "surface_s": surface_s, "timing": timing,
            }));
        }
        if common.quiet {
            return Ok(());
        }
        let mut lines = Lines::default();
        lines.add("patches", exchange.patches().len());
        lines.add("shots", solver.state().shots);
        lines.add("unshot", format!("{:.3e} of what is emitted", balance.unshot_fraction()));
        let part = |power: DVec3| 100.0 * power.element_sum() / balance.emitted.element_sum();
        let [absorbed, backs, background] = [balance.absorbed, balance.backs, balance.background].map(part);
        lines.add("power", format!("{absorbed:.2}% absorbed, {backs:.2}% at backs, {background:.2}% left the scene"));
        lines.add("defect", number(balance.defect()));
        if corners > 0 {
            lines.add("corners", format!("{corners} with a view each"));
        }
        lines.add("time", format!("{solve_s:.2} s to solve, {surface_s:.2} s for the surface"));
        for file in &files {
            lines.add("wrote", file.display());
        }
        print(&lines.0)
    }

    fn about(&self, error: &impl std::fmt::Display) -> Failure {
        Failure::about(&self.scene, error)
    }

    /// The scene of patches, and the polygon that each is part of.
    fn mesh(&self, scene: &Scene) -> Result<(Scene, Vec<PolygonId>), Failure> {
        match self.patch {
            Some(longest) => mesh_scene(scene, longest).map_err(|error| self.about(&error)),
            None => Ok((scene.clone(), (0..scene.polygon_count() as u32).map(PolygonId).collect())),
        }
    }

    /// Takes up a kept state.
    fn take_up(&self, key: &StateKey, solver: &mut Solver<'_>) -> Result<(), Failure> {
        let Some(path) = self.state.as_ref().filter(|path| self.resume && path.exists()) else { return Ok(()) };
        let text = fs::read_to_string(path)
            .map_err(|error| Failure::Work(format!("cannot read {}: {error}", path.display())))?;
        let state = read_state(key, &text).map_err(|error| Failure::about(path, &error))?;
        solver.resume(state).map_err(|error| Failure::about(path, &error))
    }

    fn solve(&self, key: &StateKey, solver: &mut Solver<'_>, common: &Common) -> Result<(), Failure> {
        if self.full {
            solver.compute_all_rows().map_err(|error| self.about(&error))?;
        }
        let mut progress = Progress::new("shots", None, common.quiet);
        let mut kept = Instant::now();
        let mut shots = solver.state().shots;
        let mut failure = None;
        let result = solver.solve(if self.full { 1e-12 } else { self.until }, |solver| {
            progress.add(solver.state().shots - shots);
            shots = solver.state().shots;
            progress.note(format!("{:.2e} unshot", solver.balance().unshot_fraction()));
            if kept.elapsed() > KEEP_EVERY {
                kept = Instant::now();
                failure = self.keep(key, solver).err();
            }
            failure.is_none()
        });
        drop(progress);
        result.map_err(|error| self.about(&error))?;
        failure.map_or(Ok(()), Err)?;
        self.keep(key, solver)
    }

    fn keep(&self, key: &StateKey, solver: &Solver<'_>) -> Result<(), Failure> {
        let Some(path) = &self.state else { return Ok(()) };
        write_file(path, |out| write_state(key, solver.state(), out))
    }

    /// Writes all files; gives the surface, if there was one to make.
    fn write(
        &self,
        patches: &Scene,
        of: &[PolygonId],
        exchange: &Exchange,
        solver: &Solver<'_>,
        common: &Common,
    ) -> Result<Option<Surface>, Failure> {
        for output in self.output.iter().filter(|output| output.format == Format::Json) {
            let centers: Vec<_> = patches.polygons().map(|patch| middle(patches, patch.id())).collect();
            let table = RadiosityTable { solver, patches: exchange.patches(), of, centers: &centers };
            write_file(&output.path, |out| write_radiosity_json(&table, out))?;
        }
        if self.output.iter().all(|output| output.format == Format::Json) {
            return Ok(None);
        }
        let order = SceneOrder::new(patches);
        let gather = Gather::new(order, solver.emission(), solver.reflectance(), solver.radiosity());
        let options = SurfaceOptions { detail: self.detail, depth: self.depth, ..SurfaceOptions::default() };
        let views = SharedProgress::new("views from corners", None, common.quiet);
        let surface = Surface::watched(patches, of, &gather, &options, &|count| views.add(count))
            .map_err(|error| self.about(&error))?;
        drop(views);
        let exposure = self.exposure.unwrap_or_else(|| auto_exposure(&surface, solver.emission()));
        for Output { path, format } in &self.output {
            match format {
                Format::Glb => write_file(path, |out| write_glb(out, &radiosity_meshes(&surface, patches, exposure)))?,
                Format::Ply => write_file(path, |out| write_radiosity_ply(&surface, exposure, out))?,
                Format::Html => {
                    let up = self.up.unwrap_or_else(|| usual_up(&self.scene));
                    let title = self.scene.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                    write_file(path, |out| write_radiosity_html(&surface, &title, exposure, up, out))?;
                }
                Format::Json => {}
            }
        }
        Ok(Some(surface))
    }
}

/// What is up in scenes of a file's format: y in glTF, which says so; elsewhere z, as for cameras.
fn usual_up(file: &Path) -> DVec3 {
    let ending = file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    if matches!(&*ending, "gltf" | "glb") { DVec3::Y } else { DVec3::Z }
}

/// The mean of the corners of a polygon, or the origin if it has none.
fn middle(scene: &Scene, polygon: PolygonId) -> DVec3 {
    let polygon = scene.polygon(polygon);
    let ring = polygon.rings().first().map_or(&[][..], Vec::as_slice);
    let sum: DVec3 = ring.iter().map(|&vertex| scene.vertex(vertex)).sum();
    sum / ring.len().max(1) as f64
}
