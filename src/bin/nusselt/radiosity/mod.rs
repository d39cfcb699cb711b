//! `nusselt radiosity`: diffuse interreflection.

mod solve;
mod stage;
mod write;

use crate::args::{Common, Loading, parse_direction};
use crate::failure::Failure;
use crate::input::load_materials;
use crate::output::{check_glb, check_once, print, print_json};
use crate::summary::{Lines, Timing, number};
use glam::DVec3;
use nusselt::io::matrix::MatrixWriter;
use nusselt::radiosity::Solver;
use serde_json::json;
use solve::Work;
use stage::Stage;
use std::path::{Path, PathBuf};
use std::time::Instant;
use write::Output;

const EXAMPLE: &str = "\
Examples: a room in patches of at most 0.3 m, for a viewer and as a page that shows itself
  nusselt radiosity room.obj --patch 0.3 -o room.glb -o room.html

Patches halved twice where the light changes on them by more than a half
  nusselt radiosity room.obj --patch 1 --subdivide 2 --gradient 0.5 -o room.html

A long one, kept again and again, and on again after an interruption
  nusselt radiosity hall.obj --patch 0.2 --until 1e-4 --state hall.state -o hall.ply
  nusselt radiosity hall.obj --patch 0.2 --until 1e-4 --state hall.state --resume -o hall.ply";

/// Solve for diffuse interreflection by progressive refinement, with exact visibility
#[derive(clap::Args)]
#[command(after_help = EXAMPLE)]
pub(crate) struct Radiosity {
    /// The scene: OBJ, glTF, GLB, STL, PLY or CityJSON. Emissions (Ke) are radiances, of fronts; diffuse colours (Kd)
    /// are what part is reflected
    scene: PathBuf,
    /// Mesh polygons into patches with edges of at most this length, in scene units, that end where others stand on them
    /// [default: polygons as they are, cut where others stand on them]
    #[arg(long, value_name = "SIZE", value_parser = parse_size, allow_hyphen_values = true)]
    patch: Option<f64>,
    /// Halve patches, in both directions, where the light on them changes, and go on; so many times. Without --patch, starting
    /// from polygons cut where others stand on them
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=6))]
    subdivide: u32,
    /// Halve patches on which radiosities differ by more than this part of their mean, or of the mean of all surfaces if that is more
    #[arg(long, value_name = "PART", default_value = "0.5", requires = "subdivide", value_parser = parse_size, allow_hyphen_values = true)]
    gradient: f64,
    /// Stop when so much of the emitted power is left to be sent, in each group of surfaces that exchange light
    #[arg(long, value_name = "FRACTION", default_value = "0.01", value_parser = parse_fraction, allow_hyphen_values = true)]
    until: f64,
    /// Solve the whole matrix instead: all rows of form factors are computed, and nothing but rounding (1e-12) is left
    #[arg(long, conflicts_with = "until")]
    full: bool,
    /// Let patches send in advance what they will reflect, and take back what was too much: fewer shots in bright closed rooms
    #[arg(long)]
    overshoot: bool,
    /// Show, in addition, what would be left to be received were it spread evenly (the ambient term of Cohen et al. 1988): for solutions that are stopped
    /// early. Powers do not have it
    #[arg(long)]
    ambient: bool,
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
    #[command(flatten)]
    keep: Keep,
    #[command(flatten)]
    loading: Loading,
}

/// What is kept of a solution.
#[derive(clap::Args)]
struct Keep {
    /// Keep the solution in this file in the end, and before that after each batch of rows that is done more than ten seconds after the last time; with --full, until it is solved, rows of form factors too, beside it
    #[arg(long, value_name = "FILE")]
    state: Option<PathBuf>,
    /// Go on from the file of --state, if it is there
    #[arg(long, requires = "state")]
    resume: bool,
}

pub(crate) fn parse_size(text: &str) -> Result<f64, String> {
    let size = text.trim().parse().ok().filter(|x: &f64| x.is_finite() && *x > 0.0);
    size.ok_or_else(|| "it takes a number above 0".to_owned())
}

pub(crate) fn parse_fraction(text: &str) -> Result<f64, String> {
    let fraction = text.trim().parse().ok().filter(|x: &f64| (1e-13..=1.0).contains(x));
    fraction.ok_or_else(|| "it takes a part of what is emitted, from 1e-13 to 1".to_owned())
}

impl Radiosity {
    pub(crate) fn run(&self, common: &Common) -> Result<(), Failure> {
        let files: Vec<&Path> =
            self.output.iter().map(|output| output.path.as_path()).chain(self.keep.state.as_deref()).collect();
        let rows = (0..=self.subdivide).filter_map(|halvings| self.rows_file(halvings));
        let rows_files = rows.flat_map(|path| MatrixWriter::files(&path)).collect::<Vec<_>>();
        check_once(files.iter().copied().chain(rows_files.iter().map(PathBuf::as_path)))?;
        let (scene, materials, load_s) = load_materials(&self.scene, files.iter().copied(), &self.loading, common)?;
        materials.check(&scene, common, |_| true)?;
        self.output.iter().filter(|output| output.is_glb()).try_for_each(|output| check_glb(&output.path, &scene))?;
        let start = Instant::now();
        let work = Work { asked: self, scene: &scene, quiet: common.quiet };
        let stage = work.first_stage()?;
        let order_s = start.elapsed().as_secs_f64();
        let start = Instant::now();
        work.solve(stage, |stage, solver, halved| {
            let times = Spent { load: load_s, order: order_s, solve: start.elapsed().as_secs_f64() };
            self.finish(stage, solver, halved, times, &files, common)
        })
    }

    /// The file of rows of --full after so many halvings, if they are kept.
    fn rows_file(&self, halvings: u32) -> Option<PathBuf> {
        let mut name = self.keep.state.as_ref().filter(|_| self.full)?.clone().into_os_string();
        name.push(format!(".{halvings}.rows"));
        Some(name.into())
    }

    /// Writes all files, and says what there was.
    fn finish(
        &self,
        stage: &Stage,
        solver: &Solver<'_>,
        halved: &[usize],
        Spent { load: load_s, order: order_s, solve: solve_s }: Spent,
        files: &[&Path],
        common: &Common,
    ) -> Result<(), Failure> {
        let exchange = &stage.exchange;
        let start = Instant::now();
        let surface = self.write(stage, solver, common)?;
        let surface_s = start.elapsed().as_secs_f64();
        let timing = Timing::of_many(load_s, order_s, solver.state().shots, solve_s * 1e3, 0.0);
        let balance = solver.balance();
        let corners = surface.map_or(0, |surface| surface.positions.len());
        if common.json {
            return print_json(&json!({
                "schema": "nusselt.radiosity/1", "patches": exchange.patches().len(), "shots": solver.state().shots, "halved": halved,
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
        if self.subdivide > 0 {
            lines.add("halved", self.told(halved));
        }
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
        for file in files {
            lines.add("wrote", file.display());
        }
        print(&lines.0)
    }

    /// How many patches were uneven, time after time.
    fn told(&self, halved: &[usize]) -> String {
        let counts: Vec<String> = halved.iter().map(usize::to_string).collect();
        let is_even = halved.len() < self.subdivide as usize;
        match (counts.is_empty(), is_even) {
            (true, _) => "none, as no patch is uneven".to_owned(),
            (false, true) => format!("{} patches that were uneven; then none was", counts.join(", then ")),
            (false, false) => format!("{} patches that were uneven; some may still be", counts.join(", then ")),
        }
    }

    fn about(&self, error: &impl std::fmt::Display) -> Failure {
        Failure::about(&self.scene, error)
    }
}

/// How long it took, in seconds, before what was found is written.
struct Spent {
    load: f64,
    order: f64,
    solve: f64,
}
