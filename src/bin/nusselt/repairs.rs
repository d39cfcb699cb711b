//! What --repair changed, said in words and in JSON.

use crate::summary::{Lines, counted, named, number};
use nusselt::scene::{DropCause, Dropped, MovedVertex, PolygonId, Repairs};
use serde_json::{Value, json};

/// What the polygons have in common that a policy drops.
fn kind(cause: DropCause) -> &'static str {
    match cause {
        DropCause::Malformed => "malformed",
        DropCause::SelfCrossing => "self-crossing",
        DropCause::NonPlanar => "not planar",
        DropCause::Duplicate => "duplicates",
    }
}

fn dropped_for(repairs: &Repairs, cause: DropCause) -> Vec<&Dropped> {
    repairs.dropped.iter().filter(|dropped| dropped.cause == cause).collect()
}

/// What welding did to polygons.
fn side_effects(repairs: &Repairs) -> [(&'static str, &'static str, &[PolygonId]); 3] {
    [
        ("shortened", "lost corners", &repairs.shortened),
        ("collapsed", "lost their area", &repairs.collapsed),
        ("bent", "are no longer planar", &repairs.bent),
    ]
}

/// One sentence for each kind of change, with how many there are and which the first ones are.
pub(crate) fn changes(repairs: &Repairs) -> Vec<String> {
    let mut changes = Vec::new();
    for cause in DropCause::ALL {
        let dropped = dropped_for(repairs, cause);
        if !dropped.is_empty() {
            changes.push(format!(
                "--repair {}=drop dropped {} polygons ({}): {}",
                cause.name(),
                dropped.len(),
                kind(cause),
                named(&dropped, |dropped| dropped.polygon.to_string())
            ));
        }
    }
    if !repairs.moved.is_empty() {
        changes.push(format!(
            "--repair weld moved {} vertices, the farthest by {}",
            repairs.moved.len(),
            number(repairs.farthest_move())
        ));
    }
    for (_, what, polygons) in side_effects(repairs) {
        if !polygons.is_empty() {
            changes.push(format!(
                "by --repair weld {} polygons {what}: {}",
                polygons.len(),
                named(polygons, PolygonId::to_string)
            ));
        }
    }
    changes
}

/// One line for each kind of change.
pub(crate) fn tell(repairs: &Repairs, lines: &mut Lines) {
    for cause in DropCause::ALL {
        let dropped = dropped_for(repairs, cause);
        if !dropped.is_empty() {
            let show = |dropped: &&Dropped| format!("{} (size {})", dropped.polygon, number(dropped.size));
            lines.add("dropped", format!("{} {}: {}", dropped.len(), kind(cause), named(&dropped, show)));
        }
    }
    if !repairs.moved.is_empty() {
        let show = |moved: &MovedVertex| format!("{} (by {})", moved.vertex, number(moved.distance()));
        let (count, far) = (repairs.moved.len(), number(repairs.farthest_move()));
        lines.add("welded", format!("{count} vertices, the farthest by {far}: {}", named(&repairs.moved, show)));
    }
    for (_, what, polygons) in side_effects(repairs) {
        if !polygons.is_empty() {
            let first = named(polygons, PolygonId::to_string);
            lines.add("by welding", format!("{} polygons {what}: {first}", polygons.len()));
        }
    }
}

pub(crate) fn as_json(repairs: &Repairs) -> Value {
    let mut dropped = serde_json::Map::new();
    for cause in DropCause::ALL {
        let polygons = dropped_for(repairs, cause);
        let show = |dropped: &&Dropped| json!({ "polygon": dropped.polygon.0, "size": dropped.size, "problem": dropped.problem.to_string() });
        dropped.insert(cause.name().replace('-', "_"), counted(&polygons, show));
    }
    let mut json = json!({
        "dropped": dropped,
        "welded": counted(&repairs.moved, |moved| json!({
            "vertex": moved.vertex, "from": moved.from.to_array(), "to": moved.to.to_array(),
            "distance": moved.distance(),
        })),
        "farthest_move": repairs.farthest_move(),
    });
    for (key, _, polygons) in side_effects(repairs) {
        json[key] = counted(polygons, |id| json!(id.0));
    }
    json
}
