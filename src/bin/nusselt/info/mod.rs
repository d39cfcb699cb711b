//! `nusselt info`: what a scene consists of, and what may be wrong with it.

mod json;
mod words;

use crate::args::{Common, Loading, Order};
use crate::failure::Failure;
use crate::input::{load, try_to_build};
use crate::output::{print, print_json, write_obj};
use crate::summary::Timing;
use nusselt::bsp::{BspError, SceneBsp};
use nusselt::io::fragment_groups;
use nusselt::scene::{Scene, Shape};
use std::path::{Path, PathBuf};

const EXAMPLE: &str = "\
Example: look over a room, and write the fragments of its 3D BSP
  nusselt info room.obj --fragments -o fragments.obj";

/// Tell what a scene consists of and what may be wrong with it
#[derive(clap::Args)]
#[command(after_help = EXAMPLE)]
pub(crate) struct Info {
    /// The scene: OBJ, glTF, GLB, STL, PLY or CityJSON
    scene: PathBuf,
    /// Write the fragments into which the 3D BSP cuts the scene
    #[arg(long)]
    fragments: bool,
    /// Where to write the fragments; their materials go beside, with the ending .mtl
    #[arg(short, long, value_name = "FILE.obj", requires = "fragments", value_parser = parse_obj)]
    output: Option<PathBuf>,
    #[command(flatten)]
    loading: Loading,
    #[command(flatten)]
    order: Order,
}

fn parse_obj(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let is_obj = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("obj"));
    if is_obj { Ok(path) } else { Err("fragments are written as .obj".to_owned()) }
}

impl Info {
    pub(crate) fn run(&self, common: &Common) -> Result<(), Failure> {
        let output = match (&self.output, self.fragments) {
            (None, true) => return Err(Failure::Usage("--fragments takes -o FILE.obj: say where to write".to_owned())),
            (output, _) => output.as_deref(),
        };
        let (scene, load_s) = load(&self.scene, output.into_iter(), &self.loading, common)?;
        let report = scene.report();
        let (bsp, bsp_s) = try_to_build(&scene, &self.order);
        let bsp = match bsp {
            Err(error @ BspError::TooManyFragments { .. }) if output.is_none() => Err(error),
            bsp => Ok(bsp.map_err(|error| Failure::about(&self.scene, &error))?),
        };
        let bsp = bsp.as_ref();
        let left_out = match (output, bsp) {
            (Some(output), Ok(bsp)) => write_fragments(output, bsp, &scene)?,
            _ => 0,
        };
        if let (Some(output), 1..) = (output, left_out) {
            let what = "fragments too thin to have three different corners were left out";
            common.warn(&format!("{}: {left_out} {what}", output.display()));
        }
        let timing = Timing::new(load_s, bsp_s, &[]);
        if common.json {
            let repair = &self.loading.repair;
            return print_json(&json::summary(&self.scene, repair, &scene, &report, bsp, timing));
        }
        if common.quiet { Ok(()) } else { print(&words::summary(&scene, &report, bsp, timing)) }
    }
}

/// Writes the fragments; gives how many are too thin to be faces.
fn write_fragments(output: &Path, bsp: &SceneBsp, scene: &Scene) -> Result<usize, Failure> {
    let groups = fragment_groups(bsp);
    write_obj(output, &groups, scene)?;
    Ok(bsp.fragment_count() - groups.iter().map(|group| group.polygons.len()).sum::<usize>())
}

fn emitters(scene: &Scene) -> usize {
    scene.polygons().filter(|polygon| polygon.material().is_emitter()).count()
}

fn concave(scene: &Scene) -> usize {
    scene.polygons().filter(|polygon| polygon.shape() == Shape::Concave).count()
}
