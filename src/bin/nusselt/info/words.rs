//! `nusselt info` in words.

use super::{concave, emitters};
use crate::repairs;
use crate::summary::{Lines, Timing, named, number, vector};
use nusselt::bsp::{BspError, SceneBsp};
use nusselt::scene::{
    Component, CoplanarOverlap, CrowdedEdge, Fronts, MeshReport, NonPlanarPolygon, OpenEdge, Orientation, PolygonId,
    Scene, TJunction, VertexId,
};

pub(super) fn summary(scene: &Scene, report: &MeshReport, bsp: Result<&SceneBsp, &BspError>, timing: Timing) -> String {
    let mut lines = Lines::default();
    let shapes = [
        (concave(scene), "concave"),
        (report.non_planar.len(), "not planar"),
        (report.degenerate.len(), "without area"),
        (scene.repairs().dropped.len(), "dropped"),
    ];
    let shapes = several(&shapes);
    let shapes = if shapes.is_empty() { String::new() } else { format!(" ({shapes})") };
    lines.add("polygons", format!("{}{shapes}, {} vertices", scene.polygon_count(), scene.vertices().len()));
    lines.add("objects", scene.objects().len());
    lines.add("materials", format!("{}, {} polygons emit", scene.materials().len(), emitters(scene)));
    if let Some((low, high)) = scene.bounds() {
        lines.add("bounds", format!("{} to {}", vector(low), vector(high)));
    }
    repairs::tell(scene.repairs(), &mut lines);
    flaws(scene, report, &mut lines);
    surfaces(report, &mut lines);
    match bsp {
        Ok(bsp) => tree(bsp, &mut lines),
        Err(error) => lines.add("3D BSP", format!("not built: {error}")),
    }
    lines.add("time", format!("load {:.3} s, BSP {:.3} s", timing.load_s, timing.bsp_s));
    lines.0
}

fn tree(bsp: &SceneBsp, lines: &mut Lines) {
    let stats = bsp.stats();
    lines.add(
        "3D BSP",
        format!("{} nodes, depth {}, {} splits, {} fragments", stats.nodes, stats.depth, stats.splits, stats.fragments),
    );
    if bsp.epsilon() > 0.0 {
        lines.add("epsilon", format!("{}, {} slivers left uncut", number(bsp.epsilon()), stats.uncut_slivers));
    }
}

/// Those there are any of.
fn several(counts: &[(usize, &str)]) -> String {
    let some = counts.iter().filter(|(count, _)| *count > 0);
    some.map(|(count, what)| format!("{count} {what}")).collect::<Vec<_>>().join(", ")
}

/// How many, and which the first ones are.
fn listed<T>(items: &[T], show: impl Fn(&T) -> String) -> String {
    if items.is_empty() { "0".to_owned() } else { format!("{}: {}", items.len(), named(items, show)) }
}

/// What is wrong with single polygons and edges.
fn flaws(scene: &Scene, report: &MeshReport, lines: &mut Lines) {
    let edges = several(&[
        (report.open_edges.len(), "open"),
        (report.crowded_edges.len(), "of more than two polygons"),
        (report.turned_edges.len(), "where fronts and backs meet"),
    ]);
    lines.add("edges", if edges.is_empty() { "closed".to_owned() } else { edges });
    lines.add("duplicates", listed(&report.duplicates, |[first, later]| format!("{later} of {first}")));
    let show = |edge: &[VertexId; 2]| edge.map(|v| vector(scene.vertex(v))).join(" to ");
    if !report.open_edges.is_empty() {
        let show = |open: &OpenEdge| format!("{} (length {})", open.polygon, number(open.length));
        lines.add("open edges", format!("of polygons {}", named(&report.open_edges, show)));
    }
    if !report.crowded_edges.is_empty() {
        let show = |crowded: &CrowdedEdge| {
            let polygons: Vec<_> = crowded.polygons.iter().take(8).map(PolygonId::to_string).collect();
            let more = if crowded.polygons.len() > polygons.len() { " and more" } else { "" };
            format!("{}{more} (length {})", polygons.join(" and "), number(crowded.length))
        };
        lines.add("crowded", format!("of polygons {}", named(&report.crowded_edges, show)));
    }
    if !report.turned_edges.is_empty() {
        lines.add("turned", named(&report.turned_edges, show));
    }
    let cracks = report.t_junctions.iter().filter(|t| !t.exact).count();
    let widest = report.t_junctions.iter().fold(0.0, |most: f64, t| most.max(t.gap));
    let widest = if cracks > 0 { format!(", the widest gap {}", number(widest)) } else { String::new() };
    let more = or_more(report.all_t_junctions);
    let count = report.t_junctions.len();
    let of = |t: &TJunction| {
        let gap = if t.exact { String::new() } else { format!(" (gap {})", number(t.gap)) };
        format!("{} in {}{gap}", vector(scene.vertex(t.vertex)), show(&t.edge))
    };
    let first = if count == 0 { String::new() } else { format!(": {}", named(&report.t_junctions, of)) };
    lines.add("T-junctions", format!("{count}{more}, {cracks} of them not exactly on the edge{widest}{first}"));
    if !report.non_planar.is_empty() {
        let show = |face: &NonPlanarPolygon| format!("{} (by {})", face.polygon, number(face.deviation));
        lines.add("not planar", listed(&report.non_planar, show));
    }
    if !report.degenerate.is_empty() {
        lines.add("no area", listed(&report.degenerate, PolygonId::to_string));
    }
}

fn or_more(all: bool) -> &'static str {
    if all { "" } else { " or more" }
}

/// How polygons lie to each other.
fn surfaces(report: &MeshReport, lines: &mut Lines) {
    let those = |is: &dyn Fn(&Component) -> bool| report.components.iter().filter(|component| is(component)).count();
    let closed = [
        (those(&|component| component.fronts == Some(Fronts::Outwards)), "with fronts outside"),
        (those(&|component| component.fronts == Some(Fronts::Inwards)), "with fronts inside"),
    ];
    let kinds = [
        (those(&|component| component.closed), "closed"),
        closed[0],
        closed[1],
        (those(&|component| component.orientation == Orientation::Undecided), "where which side is inverted is open"),
        (those(&|component| component.orientation == Orientation::NonOrientable), "with no two sides"),
    ];
    let kinds = several(&kinds);
    let kinds = if kinds.is_empty() { String::new() } else { format!(": {kinds}") };
    lines.add("surfaces", format!("{}{kinds}", report.components.len()));
    if !report.inverted.is_empty() {
        lines.add("inverted", listed(&report.inverted, PolygonId::to_string));
    }
    let show = |overlap: &CoplanarOverlap| {
        let [a, b] = overlap.polygons;
        format!("{a} and {b} (area {})", number(overlap.area))
    };
    let more = or_more(report.all_overlaps);
    let first = if report.overlaps.is_empty() { String::new() } else { format!(": {}", named(&report.overlaps, show)) };
    lines.add("overlaps", format!("{}{more}{first}", report.overlaps.len()));
}
