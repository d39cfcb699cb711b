//! `nusselt info --json`.

use super::{concave, emitters};
use crate::repairs;
use crate::summary::{Timing, counted};
use nusselt::bsp::{BspError, SceneBsp};
use nusselt::scene::{Component, Fronts, MeshReport, Orientation, PolygonId, Repair, Scene, VertexId};
use serde_json::{Value, json};
use std::path::Path;

pub(super) fn summary(
    path: &Path,
    repair: &Repair,
    scene: &Scene,
    report: &MeshReport,
    bsp: Result<&SceneBsp, &BspError>,
    timing: Timing,
) -> Value {
    let mut summary = json!({
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
        "repair": repair.to_string(),
        "repairs": repairs::as_json(scene.repairs()),
    });
    let mut rest = json!({ "bsp": null, "timing": timing });
    match bsp {
        Ok(bsp) => {
            let stats = bsp.stats();
            rest["bsp"] = json!({
                "epsilon": bsp.epsilon(), "nodes": stats.nodes, "axis_nodes": stats.axis_nodes, "depth": stats.depth,
                "splits": stats.splits, "fragments": stats.fragments, "uncut_slivers": stats.uncut_slivers,
            });
        }
        Err(error) => rest["bsp_not_built"] = json!(error.to_string()),
    }
    for part in [flaws(scene, report), surfaces(report), rest] {
        if let (Value::Object(summary), Value::Object(part)) = (&mut summary, part) {
            summary.extend(part);
        }
    }
    summary
}

fn polygon(id: PolygonId) -> Value {
    json!(id.0)
}

/// What is wrong with single polygons and edges.
fn flaws(scene: &Scene, report: &MeshReport) -> Value {
    let edge = |edge: [VertexId; 2]| json!(edge.map(|v| scene.vertex(v).to_array()));
    let first = |list: Value| list["first"].clone();
    let mut non_planar = counted(&report.non_planar, |face| polygon(face.polygon));
    non_planar["deviations"] = first(counted(&report.non_planar, |face| json!(face.deviation)));
    non_planar["largest"] = json!(report.non_planar.iter().fold(0.0, |most: f64, face| most.max(face.deviation)));
    let mut open = counted(&report.open_edges, |open| edge(open.edge));
    open["polygons"] = first(counted(&report.open_edges, |open| polygon(open.polygon)));
    open["lengths"] = first(counted(&report.open_edges, |open| json!(open.length)));
    open["longest"] = json!(report.open_edges.iter().fold(0.0, |most: f64, open| most.max(open.length)));
    let mut crowded = counted(&report.crowded_edges, |crowded| edge(crowded.edge));
    crowded["polygons"] =
        first(counted(&report.crowded_edges, |crowded| counted(&crowded.polygons, |&id| polygon(id))));
    crowded["lengths"] = first(counted(&report.crowded_edges, |crowded| json!(crowded.length)));
    let mut t_junctions = counted(&report.t_junctions, |t| {
        let vertex = scene.vertex(t.vertex).to_array();
        json!({ "vertex": vertex, "edge": edge(t.edge), "exact": t.exact, "gap": t.gap })
    });
    t_junctions["widest"] = json!(report.t_junctions.iter().fold(0.0, |most: f64, t| most.max(t.gap)));
    json!({
        "non_planar": non_planar,
        "degenerate": counted(&report.degenerate, |&id| polygon(id)),
        "duplicates": counted(&report.duplicates, |pair| json!(pair.map(|id| id.0))),
        "open_edges": open,
        "crowded_edges": crowded,
        "turned_edges": counted(&report.turned_edges, |&turned| edge(turned)),
        "t_junctions": t_junctions,
        "all_t_junctions": report.all_t_junctions,
    })
}

/// How polygons lie to each other.
fn surfaces(report: &MeshReport) -> Value {
    let those = |is: &dyn Fn(&Component) -> bool| {
        let components: Vec<_> = report.components.iter().filter(|component| is(component)).collect();
        counted(
            &components,
            |component| json!({ "polygon": component.first.0, "polygons": component.polygons, "volume": component.volume }),
        )
    };
    json!({
        "inverted": counted(&report.inverted, |&id| polygon(id)),
        "components": {
            "count": report.components.len(),
            "closed": report.components.iter().filter(|component| component.closed).count(),
            "fronts_outwards": those(&|component| component.fronts == Some(Fronts::Outwards)),
            "fronts_inwards": those(&|component| component.fronts == Some(Fronts::Inwards)),
            "some_inverted": those(&|component| component.orientation == Orientation::SomeInverted),
            "undecided": those(&|component| component.orientation == Orientation::Undecided),
            "non_orientable": those(&|component| component.orientation == Orientation::NonOrientable),
        },
        "overlaps": counted(&report.overlaps, |overlap| json!({
            "polygons": overlap.polygons.map(|id| id.0), "opposed": overlap.opposed, "area": overlap.area,
        })),
        "all_overlaps": report.all_overlaps,
    })
}
