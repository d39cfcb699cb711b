//! The summary of a contour image, as JSON and in words.

use crate::summary::{Lines, Timing, number, vector};
use nusselt::contour::{ContourImage, Domain, Horizon, Pane, ViewStats, Windows};
use nusselt::exact::PredicateStats;
use nusselt::io::{ContourSummary, Share};
use nusselt::scene::Side;
use serde::Serialize;

/// What `--json` prints.
#[derive(Serialize)]
pub(super) struct Printed<'a> {
    #[serde(flatten)]
    summary: &'a ContourSummary<'a>,
    cell_count: usize,
    timing: Timing,
    work: Work,
    predicates: Predicates,
}

/// What the view took.
#[derive(Serialize)]
struct Work {
    inserted_fragments: usize,
    skipped_subtrees: usize,
    visited_nodes: u64,
}

/// The exact decisions that the view took, and what decided them.
#[derive(Serialize)]
struct Predicates {
    calls: u64,
    filter: u64,
    identity: u64,
    fixed: u64,
    arbitrary: u64,
}

impl<'a> Printed<'a> {
    pub(super) fn new(summary: &'a ContourSummary<'a>, timing: Timing, image: &ContourImage) -> Self {
        let ViewStats { inserted, skipped_subtrees, visited_nodes, predicates, .. } = *image.stats();
        let work = Work { inserted_fragments: inserted, skipped_subtrees, visited_nodes };
        let PredicateStats { filter, identity, fixed, arbitrary } = predicates;
        let predicates = Predicates { calls: predicates.calls(), filter, identity, fixed, arbitrary };
        Self { summary, cell_count: image.cell_count(), timing, work, predicates }
    }
}

/// So many objects are listed.
const LISTED: usize = 20;

pub(super) fn in_words(image: &ContourImage, summary: &ContourSummary<'_>, timing: Timing) -> Lines {
    let mut lines = Lines::default();
    let eye = vector(image.viewpoint().eye());
    let on = image.viewpoint().surface().map(|(polygon, side)| {
        let side = if side == Side::Front { "front" } else { "back" };
        let object = image.scene().polygon(polygon).object_name();
        format!(", on the {side} of polygon {polygon} ({object})")
    });
    lines.add("eye", format!("{eye}{}", on.unwrap_or_default()));
    match image.domain() {
        Domain::Sphere => lines.add("domain", "sphere"),
        Domain::Above => lines.add("domain", "hemisphere above the polygon"),
        Domain::Hemisphere(normal) => lines.add("domain", format!("hemisphere about {}", vector(*normal))),
        Domain::Frustum(frustum) => {
            let towards = vector(frustum.frame().towards());
            let [degrees, aspect] = [frustum.degrees(), frustum.aspect()].map(number);
            lines.add("domain", format!("camera towards {towards}, {degrees} degrees high, aspect {aspect}"));
        }
        Domain::Window(windows) => lines.add("domain", windows_in_words(windows)),
        _ => lines.add("domain", "other"),
    }
    let [polygons, objects] = [summary.polygons.len(), summary.objects.len()];
    lines.add("seen", format!("{polygons} polygons of {objects} objects, in {} cells", image.cell_count()));
    let title = match summary.total.form_factor {
        Some(_) => format!("{:>12} {:>14}", "form factor", "solid angle"),
        None => format!("{:>14}", "solid angle"),
    };
    lines.add("", title);
    let mut shares: Vec<_> = summary.objects.iter().map(|row| (row.object, row.share)).collect();
    let weight = |share: Share| share.form_factor.unwrap_or(share.solid_angle);
    // Stable: equal ones stay in the order of the file.
    shares.sort_by(|a, b| weight(b.1).total_cmp(&weight(a.1)));
    for &(name, share) in shares.iter().take(LISTED) {
        lines.add(&short(name), numbers(share));
    }
    if objects > LISTED {
        let rest = objects - LISTED;
        lines.add("...", format!("and {rest} more objects"));
    }
    lines.add("background", numbers(summary.background));
    lines.add("total", numbers(summary.total));
    lines.add(
        "time",
        format!("load {:.3} s, order {:.3} s, view {:.3} ms", timing.load_s, timing.bsp_s, timing.view_ms_max),
    );
    lines
}

fn windows_in_words(windows: &Windows) -> String {
    let panes: Vec<String> = windows
        .panes()
        .iter()
        .take(LISTED)
        .map(|pane| match pane {
            Pane::Polygon(polygon) => polygon.to_string(),
            Pane::Ring(_) => "other".to_owned(),
        })
        .collect();
    let more = if windows.panes().len() > LISTED {
        format!(" and {} more", windows.panes().len() - LISTED)
    } else {
        String::new()
    };
    let within = match windows.horizon() {
        None => String::new(),
        Some(Horizon::Surface) => ", above the polygon".to_owned(),
        Some(Horizon::Normal(normal)) => format!(", within the hemisphere about {}", vector(normal)),
    };
    format!("windows {}{more}{within}", panes.join(", "))
}

fn numbers(share: Share) -> String {
    match share.form_factor {
        Some(factor) => format!("{factor:>12.8} {:>11.8} sr", share.solid_angle),
        None => format!("{:>11.8} sr", share.solid_angle),
    }
}

/// A name that leaves the columns straight.
fn short(name: &str) -> String {
    let clean = name.chars().map(|c| if c.is_control() { '_' } else { c });
    if name.chars().count() > 12 { clean.take(11).chain(['~']).collect() } else { clean.collect() }
}
