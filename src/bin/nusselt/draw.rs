//! `nusselt draw`: vector drawings with hidden surfaces removed.

use crate::args::{Common, Loading, parse_aspect, parse_direction, parse_fov, parse_point};
use crate::failure::Failure;
use crate::input::load;
use crate::output::{print, print_json, write_file};
use crate::place::camera;
use crate::summary::{Lines, Timing};
use glam::DVec3;
use nusselt::bvh::SceneBvh;
use nusselt::contour::{Domain, Projection, Projector, Viewpoint};
use nusselt::io::{DrawingCounts, DrawingOptions, Fill, write_drawing};
use serde_json::json;
use std::path::PathBuf;
use std::time::Instant;

const EXAMPLE: &str = "\
Examples: a shaded drawing of a room
  nusselt draw room.obj --eye 1,1,1.6 --look-at 4,3,0.8 --fov 70 --aspect 4/3 -o room.svg

Lines only, with hidden ones dashed
  nusselt draw part.stl --eye 9,7,6 --look-at 0,0,0 --fov 30 --fill white --hidden -o part.svg";

/// Draw what a camera sees as clean vector graphics: visible surfaces cut out exactly, visible edges by kind
#[derive(clap::Args)]
#[command(after_help = EXAMPLE)]
pub(crate) struct Draw {
    /// The scene: OBJ, glTF, GLB, STL, PLY or CityJSON
    scene: PathBuf,
    /// Where the camera stands
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_point, allow_hyphen_values = true)]
    eye: DVec3,
    /// The point that it looks at
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_point, allow_hyphen_values = true)]
    look_at: DVec3,
    /// Its vertical field of view in degrees, above 0 and below 180
    #[arg(long, value_name = "DEG", value_parser = parse_fov, allow_hyphen_values = true)]
    fov: f64,
    /// Width over height, as a number or a fraction [default: 1]
    #[arg(long, value_name = "W/H", value_parser = parse_aspect, allow_hyphen_values = true)]
    aspect: Option<f64>,
    /// What is up in the picture [default: 0,0,1, or 0,1,0 when looking along it]
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_direction, allow_hyphen_values = true)]
    up: Option<DVec3>,
    /// The length of the picture's longer side
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(16..=100_000))]
    size: u32,
    /// How surfaces are filled: in the colour of their material, shaded by how they face a light over the left
    /// shoulder, or as it is, or in white
    #[arg(long, value_name = "shaded|flat|white", default_value = "shaded", value_parser = parse_fill)]
    fill: Fill,
    /// Dash the edges that are hidden
    #[arg(long)]
    hidden: bool,
    /// Draw edges within surfaces of one material where these turn by more than this, in degrees from 0 to 180
    #[arg(long, value_name = "DEG", default_value = "20", value_parser = parse_crease, allow_hyphen_values = true)]
    crease: f64,
    /// The file to write
    #[arg(short, long, value_name = "FILE.svg", value_parser = parse_svg)]
    output: PathBuf,
    #[command(flatten)]
    loading: Loading,
}

fn parse_fill(text: &str) -> Result<Fill, String> {
    match text {
        "shaded" => Ok(Fill::Shaded),
        "flat" => Ok(Fill::Flat),
        "white" => Ok(Fill::White),
        _ => Err("there are shaded, flat and white".to_owned()),
    }
}

fn parse_crease(text: &str) -> Result<f64, String> {
    let degrees: f64 = text.trim().parse().map_err(|_| format!("{:?} is not a number", text.trim()))?;
    if (0.0..=180.0).contains(&degrees) { Ok(degrees) } else { Err("it is from 0 to 180 degrees".to_owned()) }
}

fn parse_svg(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let is_svg = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("svg"));
    if is_svg { Ok(path) } else { Err("drawings are written as .svg".to_owned()) }
}

impl Draw {
    pub(crate) fn run(&self, common: &Common) -> Result<(), Failure> {
        let frustum = camera(self.eye, self.look_at, self.fov, self.aspect, self.up)?;
        let (scene, load_s) = load(&self.scene, [self.output.as_path()].into_iter(), &self.loading, common)?;
        let start = Instant::now();
        let bvh = SceneBvh::build(&scene);
        let order_s = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let image = bvh.view(&Viewpoint::free(self.eye), &Domain::Frustum(frustum));
        let image = image.map_err(|error| Failure::about(&self.scene, &error))?;
        let timing = Timing::new(load_s, order_s, &[start.elapsed().as_secs_f64() * 1e3]);
        let projector = Projector::of_image(&image, Projection::Gnomonic);
        let projector = projector.map_err(|error| Failure::about(&self.scene, &error))?;
        let options = DrawingOptions {
            size: f64::from(self.size),
            fill: self.fill,
            hidden: self.hidden,
            crease: self.crease.to_radians(),
        };
        let mut counts = DrawingCounts::default();
        write_file(&self.output, |out| {
            counts = write_drawing(&image, &projector, &options, out)?;
            Ok(())
        })?;
        if common.json {
            return print_json(&json!({
                "schema": "nusselt.drawing/1", "regions": counts.regions, "silhouettes": counts.silhouettes,
                "borders": counts.borders, "creases": counts.creases, "crossings": counts.crossings,
                "hidden": counts.hidden, "timing": timing,
            }));
        }
        if common.quiet {
            return Ok(());
        }
        let DrawingCounts { regions, silhouettes, borders, creases, crossings, hidden } = counts;
        let mut lines = Lines::default();
        lines.add("regions", regions);
        let crossings = if crossings == 0 { String::new() } else { format!(", {crossings} crossings") };
        let hidden = if self.hidden { format!(", {hidden} hidden") } else { String::new() };
        lines.add(
            "lines",
            format!("{silhouettes} of silhouettes, {borders} of borders, {creases} of creases{crossings}{hidden}"),
        );
        lines.add("time", format!("{:.1} ms, and {:.1} ms for the boxes", timing.view_ms_mean, timing.bsp_s * 1e3));
        lines.add("wrote", self.output.display());
        print(&lines.0)
    }
}
