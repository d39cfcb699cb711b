//! `nusselt scene`: sample scenes.

use crate::args::Common;
use crate::failure::Failure;
use crate::output::{clear, library_of, print, print_json, write_file};
use crate::summary::Timing;
use nusselt::samples::{Kind, Mesh, cornell_box, generate};
use serde_json::json;
use std::path::PathBuf;
use std::time::Instant;

const EXAMPLE: &str = "\
Example: a closed room of 2000 polygons, as room.obj and room.mtl
  nusselt scene room --polygons 2000 --seed 7 -o room.obj";

/// Generate a closed scene, or write the Cornell box
#[derive(clap::Args)]
#[command(after_help = EXAMPLE)]
pub(crate) struct Scene {
    /// What to make
    kind: Name,
    /// Exactly so many triangles and quads; not for the Cornell box, which has 16 quads
    #[arg(long, value_name = "N")]
    polygons: Option<usize>,
    /// The same seed makes the same scene
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// The file to write; its materials go beside it, with the ending .mtl
    #[arg(short, long, value_name = "FILE.obj", value_parser = parse_obj)]
    output: PathBuf,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Name {
    /// A room with lamps, furniture and balls, mostly turned by arbitrary angles
    Room,
    /// Cubicles below many lamps: mostly axis-aligned boxes
    Office,
    /// Buildings with all kinds of roofs between streets, below a luminous sky
    City,
    /// The Cornell box as measured, open at its front
    Cornell,
}

fn parse_obj(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let is_obj = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("obj"));
    if is_obj { Ok(path) } else { Err("scenes are written as .obj".to_owned()) }
}

impl Scene {
    pub(crate) fn run(&self, common: &Common) -> Result<(), Failure> {
        let start = Instant::now();
        let (mesh, name) = self.make()?;
        let timing = Timing::new(start.elapsed().as_secs_f64(), 0.0, &[]);
        let (library, library_name) = library_of(&self.output);
        clear(&self.output);
        // First, so that the scene never refers to what is not there.
        write_file(&library, |out| mesh.write_mtl(out))?;
        write_file(&self.output, |out| mesh.write_obj(&library_name, out))?;
        let files = [&self.output, &library].map(|path| path.display().to_string());
        let [faces, objects, materials] = [mesh.faces().len(), mesh.objects().len(), mesh.materials().len()];
        if common.json {
            return print_json(&json!({
                "schema": "nusselt.scene/1", "kind": name, "seed": self.seed, "polygons": faces,
                "vertices": mesh.vertices().len(), "objects": objects, "materials": materials, "files": files,
                "timing": timing,
            }));
        }
        if common.quiet {
            return Ok(());
        }
        print(&format!(
            "{name}: {faces} polygons, {objects} objects, {materials} materials in {} and {}\n",
            files[0], files[1]
        ))
    }

    fn make(&self) -> Result<(Mesh, &'static str), Failure> {
        let kind = match self.kind {
            Name::Room => Kind::Room,
            Name::Office => Kind::Office,
            Name::City => Kind::City,
            Name::Cornell if self.polygons.is_some() => {
                let message = "--polygons does not go with cornell: the Cornell box has 16; leave it out";
                return Err(Failure::Usage(message.to_owned()));
            }
            Name::Cornell => return Ok((cornell_box(), "cornell")),
        };
        let Some(polygons) = self.polygons else {
            return Err(Failure::Usage(format!("a generated {kind} takes --polygons N; say how many it is to have")));
        };
        match generate(kind, polygons, self.seed) {
            Ok(mesh) => Ok((mesh, kind.name())),
            Err(error) => Err(Failure::Usage(error.to_string())),
        }
    }
}
