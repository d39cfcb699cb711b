//! `nusselt shadows`: polygons cut into lit and shadowed parts.

use crate::args::{Common, Loading, parse_point};
use crate::failure::Failure;
use crate::input::load;
use crate::output::{check_glb, check_once, print, print_json, write_file, write_obj};
use crate::summary::{Lines, Timing, number, vector};
use glam::DVec3;
use nusselt::bvh::SceneBvh;
use nusselt::contour::{Shadows, ViewOptions};
use nusselt::io::{gltf, shadow_groups, shadow_meshes};
use nusselt::scene::Scene;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::time::Instant;

const EXAMPLE: &str = "\
Example: what a lamp lights in a room, and what is in shadow, for a modeller and for a viewer
  nusselt shadows room.obj --light 2,1.5,2.4 -o shadows.obj -o shadows.glb";

/// Cut all polygons into what a point light reaches and what it does not, exactly
#[derive(clap::Args)]
#[command(after_help = EXAMPLE)]
pub(crate) struct ShadowsOf {
    /// The scene: OBJ, glTF, GLB, STL, PLY or CityJSON
    scene: PathBuf,
    /// Where the light is. Lit is what it sees, on either side of a polygon
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_point, allow_hyphen_values = true)]
    light: DVec3,
    /// Write to this file; the ending decides: .obj (with its materials beside it) or .glb. Groups `polygon_K_lit` and
    /// `polygon_K_shadow` are the parts of polygon K, and parts that meet have their vertices in common. May be repeated
    #[arg(short, long, value_name = "FILE", value_parser = Output::parse)]
    output: Vec<Output>,
    #[command(flatten)]
    loading: Loading,
}

#[derive(Clone)]
enum Output {
    Obj(PathBuf),
    Glb(PathBuf),
}

impl Output {
    fn parse(text: &str) -> Result<Self, String> {
        let path = PathBuf::from(text);
        match path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).as_deref() {
            Some("obj") => Ok(Self::Obj(path)),
            Some("glb") => Ok(Self::Glb(path)),
            _ => Err("its ending is neither .obj nor .glb".to_owned()),
        }
    }

    fn path(&self) -> &Path {
        match self {
            Self::Obj(path) | Self::Glb(path) => path,
        }
    }
}

impl ShadowsOf {
    pub(crate) fn run(&self, common: &Common) -> Result<(), Failure> {
        check_once(self.output.iter().map(Output::path))?;
        let (scene, load_s) = load(&self.scene, self.output.iter().map(Output::path), &self.loading, common)?;
        for output in &self.output {
            if let Output::Glb(path) = output {
                check_glb(path, &scene)?;
            }
        }
        let start = Instant::now();
        let bvh = SceneBvh::build(&scene);
        let order_s = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let shadows = bvh.shadows(self.light, &ViewOptions::default());
        let shadows = shadows.map_err(|error| Failure::about(&self.scene, &error))?;
        let timing = Timing::new(load_s, order_s, &[start.elapsed().as_secs_f64() * 1e3]);
        let areas = self.areas(&shadows)?;
        for output in &self.output {
            match output {
                Output::Obj(path) => write_obj(path, &shadow_groups(&shadows), &scene)?,
                Output::Glb(path) => write_file(path, |out| gltf::write_glb(out, &shadow_meshes(&shadows)))?,
            }
        }
        self.tell(common, &shadows, &areas, timing)
    }

    /// The areas of all polygons, lit and in shadow, if numbers hold them and their sum.
    fn areas(&self, shadows: &Shadows) -> Result<Vec<[f64; 2]>, Failure> {
        let areas = shadows.areas();
        let sums = areas.iter().scan(0.0, |sum, [lit, dark]| {
            *sum += lit + dark;
            Some(*sum)
        });
        match sums.enumerate().find(|(_, sum)| !sum.is_finite()) {
            Some((polygon, _)) => {
                let what = "its area, or that of all up to it, is more than numbers hold; use a larger unit of length";
                Err(Failure::about(&self.scene, &format!("polygon {polygon}: {what}")))
            }
            None => Ok(areas),
        }
    }

    fn tell(&self, common: &Common, shadows: &Shadows, areas: &[[f64; 2]], timing: Timing) -> Result<(), Failure> {
        let [lit, dark] = areas.iter().fold([0.0; 2], |[lit, dark], [l, d]| [lit + l, dark + d]);
        if common.json {
            return print_json(&json!({
                "schema": "nusselt.shadows/1", "light": self.light.to_array(), "parts": shadows.parts().len(),
                "vertices": shadows.vertices().len(), "polygons": rows(shadows.scene(), areas),
                "total": { "lit": lit, "shadow": dark }, "timing": timing,
            }));
        }
        if common.quiet {
            return Ok(());
        }
        let count = |pick: fn(&[f64; 2]) -> bool| areas.iter().filter(|area| pick(area)).count();
        let partly = count(|[lit, dark]| *lit > 0.0 && *dark > 0.0);
        let wholly = count(|[lit, dark]| *lit > 0.0 && *dark == 0.0);
        let none = count(|[lit, dark]| *lit == 0.0 && *dark == 0.0);
        let none = if none > 0 { format!(", {none} without area") } else { String::new() };
        let mut lines = Lines::default();
        lines.add("light", vector(self.light));
        lines.add("polygons", format!("{}, of them {wholly} lit, {partly} in part{none}", areas.len()));
        lines.add("lit", format!("area {}", number(lit)));
        lines.add("shadow", format!("area {}", number(dark)));
        lines.add("parts", format!("{} with {} vertices", shadows.parts().len(), shadows.vertices().len()));
        lines.add("time", format!("{:.1} ms, and {:.1} ms for the boxes", timing.view_ms_mean, timing.bsp_s * 1e3));
        for output in &self.output {
            lines.add("wrote", output.path().display());
        }
        print(&lines.0)
    }
}

fn rows(scene: &Scene, areas: &[[f64; 2]]) -> Value {
    let row = |polygon: nusselt::scene::PolygonRef<'_>| {
        let [lit, dark] = areas[polygon.id().index()];
        json!({
            "polygon": polygon.id().0, "object": polygon.object_name(), "lit": lit, "shadow": dark,
        })
    };
    scene.polygons().map(row).collect()
}
