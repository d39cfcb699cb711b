//! `nusselt info`: what a scene consists of, and what may be wrong with it.

mod json;
mod words;

use crate::args::{Common, Loading, Order};
use crate::failure::Failure;
use crate::input::{build, load};
use crate::output::{print, print_json, write_obj};
use crate::summary::Timing;
use nusselt::io::fragment_groups;
use nusselt::scene::{Scene, Shape};
use std::path::PathBuf;

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
        let (bsp, bsp_s) = build(&self.scene, &scene, &self.order)?;
        if let Some(output) = output {
            write_obj(output, &fragment_groups(&bsp), &scene)?;
        }
        let timing = Timing::new(load_s, bsp_s, &[]);
        if common.json {
            let repair = &self.loading.repair;
            return print_json(&json::summary(&self.scene, repair, &scene, &report, &bsp, timing));
        }
        if common.quiet { Ok(()) } else { print(&words::summary(&scene, &report, &bsp, timing)) }
    }
}

fn emitters(scene: &Scene) -> usize {
    scene.polygons().filter(|polygon| polygon.material().is_emitter()).count()
}

fn concave(scene: &Scene) -> usize {
    scene.polygons().filter(|polygon| polygon.shape() == Shape::Concave).count()
}
