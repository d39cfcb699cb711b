//! `nusselt info`: what a scene consists of, and what may be wrong with it.

use crate::args::{Common, Order, Reading};
use crate::failure::Failure;
use crate::input::{build, load};
use crate::output::{print, print_json, write_obj};
use crate::summary::{Lines, Timing, number, vector};
use nusselt::bsp::SceneBsp;
use nusselt::io::fragment_groups;
use nusselt::scene::{MeshReport, PolygonId, Scene, Shape};
use serde_json::{Value, json};
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
    #[command(flatten)]
    reading: Reading,
    /// Write the fragments into which the 3D BSP cuts the scene
    #[arg(long)]
    fragments: bool,
    /// Where to write the fragments; their materials go beside, with the ending .mtl
    #[arg(short, long, value_name = "FILE.obj", requires = "fragments", value_parser = parse_obj)]
    output: Option<PathBuf>,
    #[command(flatten)]
    order: Order,
}

fn parse_obj(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let is_obj = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("obj"));
    if is_obj { Ok(path) } else { Err("fragments are written as .obj".to_owned()) }
}

/// So many of each kind of flaw are named, the rest is only counted.
const NAMED: usize = 20;

impl Info {
    pub(crate) fn run(&self, common: &Common) -> Result<(), Failure> {
        let output = match (&self.output, self.fragments) {
            (None, true) => return Err(Failure::Usage("--fragments takes -o FILE.obj: say where to write".to_owned())),
            (output, _) => output.as_deref(),
        };
        let (scene, load_s) = load(&self.scene, &self.reading, output.into_iter(), common)?;
        let report = scene.report();
        let (bsp, bsp_s) = build(&self.scene, &scene, &self.order)?;
        if let Some(output) = output {
            write_obj(output, &fragment_groups(&bsp), &scene)?;
        }
        let timing = Timing::new(load_s, bsp_s, &[]);
        if common.json {
            return print_json(&as_json(&self.scene, &scene, &report, &bsp, timing));
        }
        if common.quiet { Ok(()) } else { print(&in_words(&scene, &report, &bsp, timing)) }
    }
}

fn emitters(scene: &Scene) -> usize {
    scene.polygons().filter(|polygon| polygon.material().is_emitter()).count()
}

fn concave(scene: &Scene) -> usize {
    scene.polygons().filter(|polygon| polygon.shape() == Shape::Concave).count()
}

fn counted<T>(items: &[T], show: impl Fn(&T) -> Value) -> Value {
    json!({ "count": items.len(), "first": items.iter().take(NAMED).map(show).collect::<Vec<_>>() })
}

fn as_json(path: &Path, scene: &Scene, report: &MeshReport, bsp: &SceneBsp, timing: Timing) -> Value {
    let edge = |edge: &[nusselt::scene::VertexId; 2]| json!(edge.map(|v| scene.vertex(v).to_array()));
    let polygon = |id: &PolygonId| json!(id.0);
    let stats = bsp.stats();
    json!({
        "schema": "nusselt.info/1",
        "scene": path.display().to_string(),
        "polygons": scene.polygon_count(),
        "vertices": scene.vertices().len(),
        "pieces": scene.piece_count(),
        "objects": scene.objects(),
        "materials": scene.materials().iter().map(|material| &material.name).collect::<Vec<_>>(),
        "emitters": emitters(scene),
        "bounds": scene.bounds().map(|(low, high)| json!({ "low": low.to_array(), "high": high.to_array() })),
        "concave": concave(scene),
        "non_planar": counted(&report.non_planar, polygon),
        "degenerate": counted(&report.degenerate, polygon),
        "duplicates": counted(&report.duplicates, |pair| json!(pair.map(|id| id.0))),
        "open_edges": counted(&report.open_edges, edge),
        "crowded_edges": counted(&report.crowded_edges, edge),
        "turned_edges": counted(&report.turned_edges, edge),
        "t_junctions": counted(&report.t_junctions, |t| json!({
            "vertex": scene.vertex(t.vertex).to_array(), "edge": edge(&t.edge), "exact": t.exact,
        })),
        "all_t_junctions": report.all_t_junctions,
        "bsp": {
            "epsilon": bsp.epsilon(), "nodes": stats.nodes, "axis_nodes": stats.axis_nodes, "depth": stats.depth,
            "splits": stats.splits, "fragments": stats.fragments, "uncut_slivers": stats.uncut_slivers,
        },
        "timing": timing,
    })
}

fn in_words(scene: &Scene, report: &MeshReport, bsp: &SceneBsp, timing: Timing) -> String {
    let mut lines = Lines::default();
    let shapes = [
        (concave(scene), "concave"),
        (report.non_planar.len(), "not planar"),
        (report.degenerate.len(), "without area"),
    ];
    let shapes: Vec<_> = shapes.iter().filter(|s| s.0 > 0).map(|(n, what)| format!("{n} {what}")).collect();
    let shapes = if shapes.is_empty() { String::new() } else { format!(" ({})", shapes.join(", ")) };
    lines.add("polygons", format!("{}{shapes}, {} vertices", scene.polygon_count(), scene.vertices().len()));
    lines.add("objects", scene.objects().len());
    lines.add("materials", format!("{}, {} polygons emit", scene.materials().len(), emitters(scene)));
    if let Some((low, high)) = scene.bounds() {
        lines.add("bounds", format!("{} to {}", vector(low), vector(high)));
    }
    let edges = [
        (report.open_edges.len(), "open"),
        (report.crowded_edges.len(), "of more than two polygons"),
        (report.turned_edges.len(), "where fronts and backs meet"),
    ];
    let edges: Vec<_> = edges.iter().filter(|s| s.0 > 0).map(|(n, what)| format!("{n} {what}")).collect();
    lines.add("edges", if edges.is_empty() { "closed".to_owned() } else { edges.join(", ") });
    lines.add("duplicates", named(&report.duplicates, |[first, later]| format!("{later} of {first}")));
    let cracks = report.t_junctions.iter().filter(|t| !t.exact).count();
    let more = if report.all_t_junctions { "" } else { " or more" };
    lines.add("T-junctions", format!("{}{more}, {cracks} of them not exactly on the edge", report.t_junctions.len()));
    if !report.non_planar.is_empty() {
        lines.add("not planar", named(&report.non_planar, PolygonId::to_string));
    }
    if !report.degenerate.is_empty() {
        lines.add("no area", named(&report.degenerate, PolygonId::to_string));
    }
    let stats = bsp.stats();
    lines.add(
        "3D BSP",
        format!("{} nodes, depth {}, {} splits, {} fragments", stats.nodes, stats.depth, stats.splits, stats.fragments),
    );
    if bsp.epsilon() > 0.0 {
        lines.add("epsilon", format!("{}, {} slivers left uncut", number(bsp.epsilon()), stats.uncut_slivers));
    }
    lines.add("time", format!("load {:.3} s, BSP {:.3} s", timing.load_s, timing.bsp_s));
    lines.0
}

/// How many, and which the first ones are.
fn named<T>(items: &[T], show: impl Fn(&T) -> String) -> String {
    let first: Vec<_> = items.iter().take(NAMED).map(show).collect();
    let more = if items.len() > NAMED { ", ..." } else { "" };
    if items.is_empty() { "0".to_owned() } else { format!("{}: {}{more}", items.len(), first.join(", ")) }
}
