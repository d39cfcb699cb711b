//! The measured part of docs/comparison.md.

use crate::{ROUNDS, Room, VIEWS};
use nusselt::hemicube::{ComparisonRow, Method};
use std::fmt::Write;

const BEGIN: &str = "<!-- measured: begin -->\n";
const END: &str = "<!-- measured: end -->";

/// A page with another text between its marks.
pub(crate) fn between_marks(page: &str, text: &str) -> Option<String> {
    let (before, rest) = page.split_once(BEGIN)?;
    let (_, after) = rest.split_once(END)?;
    Some(format!("{before}{BEGIN}\n{text}\n{END}{after}"))
}

/// Writing to a string does not fail.
macro_rules! line {
    ($text:expr, $($rest:tt)*) => { let _ = writeln!($text, $($rest)*); };
}

pub(crate) fn text(rooms: &[Room]) -> String {
    let mut text = String::new();
    line!(text, "Views of each room: {VIEWS}; times each: {ROUNDS}.\n");
    line!(text, "### The crossover\n");
    line!(
        text,
        "| polygons | contour by | ms | as fast as a hemicube of | whose worst error > 1e-3 is | worst > 1e-4 | lost |"
    );
    line!(text, "| ---: | --- | ---: | ---: | ---: | ---: | ---: |");
    for room in rooms {
        for (method, name) in [(Method::Contour, "3D BSP"), (Method::ContourByBoxes, "boxes")] {
            crossover(&mut text, room, method, name);
        }
    }
    line!(text, "\n### All methods\n");
    line!(
        text,
        "| polygons | method | ms | median | longest | worst error > 1e-3 | worst > 1e-4 | 99% | median | lost | of | evaluations |"
    );
    line!(text, "| ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    for room in rooms {
        for row in &room.rows {
            one_row(&mut text, room.polygons, row);
        }
    }
    line!(text, "\nMade once for a scene, in milliseconds:\n");
    line!(text, "| polygons | 3D BSP | hierarchy of boxes | hemicube 512 | hierarchy for rays |");
    line!(text, "| ---: | ---: | ---: | ---: | ---: |");
    for room in rooms {
        let setup = |is_wanted: fn(&Method) -> bool| {
            room.rows.iter().find(|row| is_wanted(&row.method)).map_or(0.0, |row| row.setup_s * 1e3)
        };
        line!(
            text,
            "| {} | {:.1} | {:.1} | {:.1} | {:.1} |",
            room.polygons,
            room.bsp_s * 1e3,
            setup(|method| *method == Method::ContourByBoxes),
            setup(|method| *method == Method::Hemicube { resolution: 512 }),
            setup(|method| matches!(method, Method::Rays { .. }))
        );
    }
    text.trim_end().to_owned() + "\n"
}

fn one_row(text: &mut String, polygons: usize, row: &ComparisonRow) {
    let views = row.view_ms.len();
    let [large, small] = [&row.above_1e3, &row.above_1e4];
    line!(
        text,
        "| {polygons} | {} | {:.3} | {:.3} | {:.2} | {:.2e} | {:.2e} | {:.2e} | {:.2e} | {} | {} | {} |",
        row.method,
        row.mean_ms(),
        row.median_ms(),
        row.max_ms(),
        large.quantile(1.0),
        small.quantile(1.0),
        small.quantile(0.99),
        small.quantile(0.5),
        small.lost() / views,
        small.visible() / views,
        row.evaluations / views
    );
}

/// Where the line of the hemicubes crosses the time of a contour image.
fn crossover(text: &mut String, room: &Room, method: Method, name: &str) {
    let Some(ms) = room.median_ms(method) else { return };
    let hemicubes = room.hemicubes();
    let (resolution, errors) = match room.crossover(method) {
        Some(resolution) => (
            format!("{resolution:.0}"),
            // Those of the next resolution that was measured: the error at the crossover is no less.
            hemicubes.iter().find(|(size, _)| *size as f64 >= resolution).map(|(_, row)| *row),
        ),
        None if hemicubes.first().is_some_and(|(_, row)| row.median_ms() > ms) => {
            (format!("less than {}", hemicubes[0].0), hemicubes.first().map(|(_, row)| *row))
        }
        None => {
            let last = hemicubes.last();
            (format!("more than {}", last.map_or(0, |(size, _)| *size)), last.map(|(_, row)| *row))
        }
    };
    let Some(row) = errors else { return };
    let at = row.method.resolution().unwrap_or_default();
    let percent = |error: f64| format!("{:.1}% at {at}", 100.0 * error);
    let lost = 100.0 * row.above_1e4.lost() as f64 / row.above_1e4.visible() as f64;
    line!(
        text,
        "| {} | {name} | {ms:.3} | {resolution} | {} | {} | {lost:.1}% at {at} |",
        room.polygons,
        percent(row.above_1e3.quantile(1.0)),
        percent(row.above_1e4.quantile(1.0))
    );
}

impl Room {
    /// The median time of a view.
    pub(crate) fn median_ms(&self, method: Method) -> Option<f64> {
        self.rows.iter().find(|row| row.method == method).map(ComparisonRow::median_ms)
    }

    /// By ascending resolution.
    pub(crate) fn hemicubes(&self) -> Vec<(usize, &ComparisonRow)> {
        let hemicubes = self.rows.iter().filter_map(|row| match row.method {
            Method::Hemicube { resolution } => Some((resolution, row)),
            _ => None,
        });
        hemicubes.collect()
    }

    /// The resolution at which a hemicube takes as long as that method, by medians, between those measured: time is taken to be a power of
    /// the resolution there.
    pub(crate) fn crossover(&self, method: Method) -> Option<f64> {
        let ms = self.median_ms(method)?;
        self.hemicubes().windows(2).rev().find_map(|pair| {
            let [(a, low), (b, high)] = [pair[0], pair[1]].map(|(size, row)| (size as f64, row.median_ms()));
            (low <= ms && ms < high).then(|| a * (b / a).powf((ms / low).ln() / (high / low).ln()))
        })
    }
}
