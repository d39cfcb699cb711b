//! The measured part of docs/comparison.md.

use crate::{ROUNDS, Room, VIEWS, derived};
use nusselt::hemicube::{ComparisonRow, Method};
use std::fmt::Write;

/// Above this resolution the report's analytic method was faster than the hemicube.
const REPORT: usize = 512;
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
        "| polygons | contour by | ms | times a hemicube of {REPORT} | as fast as one of | its worst error > 1e-3 | worst > 1e-4 | lost |"
    );
    line!(text, "| ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: |");
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
    text + &derived::text(rooms)
}

fn one_row(text: &mut String, polygons: usize, row: &ComparisonRow) {
    let views = row.view_ms.len() as f64;
    let [large, small] = [&row.above_1e3, &row.above_1e4];
    let [worst_large, worst, most, median] = [(large, 1.0), (small, 1.0), (small, 0.99), (small, 0.5)]
        .map(|(errors, share)| percent(errors.quantile(share)));
    line!(
        text,
        "| {polygons} | {} | {:.3} | {:.3} | {:.3} | {worst_large} | {worst} | {most} | {median} | {:.1} | {:.0} | {:.0} |",
        row.method,
        row.mean_ms(),
        row.median_ms(),
        row.max_ms(),
        small.lost() as f64 / views,
        small.visible() as f64 / views,
        row.evaluations as f64 / views
    );
}

/// `-` where there are no form factors to compare.
pub(crate) fn percent(error: Option<f64>) -> String {
    let Some(error) = error else { return "-".to_owned() };
    match 100.0 * error {
        0.0 => "0".to_owned(),
        rounding if rounding < 1e-6 => "rounding".to_owned(),
        small if small < 10.0 => format!("{small:.2}%"),
        large => format!("{large:.0}%"),
    }
}

/// Where the line of the hemicubes crosses the time of a contour image.
fn crossover(text: &mut String, room: &Room, method: Method, name: &str) {
    let (Some(ms), Some(reported)) = (room.mean_ms(method), room.mean_ms(Method::Hemicube { resolution: REPORT }))
    else {
        return;
    };
    let hemicubes = room.hemicubes();
    // The errors are those of the next resolution that was measured: those at the crossover are larger.
    let (Some(first), Some(last)) = (hemicubes.first(), hemicubes.last()) else { return };
    let (as_fast, (at, row)) = match room.crossover(method) {
        Some(resolution) => {
            let next = hemicubes.iter().find(|(size, _)| *size as f64 >= resolution).unwrap_or(last);
            (format!("{resolution:.0}"), next)
        }
        None if first.1.mean_ms() > ms => (format!("less than {}", first.0), first),
        None => (format!("more than {}", last.0), last),
    };
    let errors = [&row.above_1e3, &row.above_1e4].map(|errors| percent(errors.quantile(1.0)));
    let lost = 100.0 * row.above_1e4.lost() as f64 / row.above_1e4.visible() as f64;
    line!(
        text,
        "| {} | {name} | {ms:.2} | {:.2} | {as_fast} | {} at {at} | {} at {at} | {lost:.1}% at {at} |",
        room.polygons,
        ms / reported,
        errors[0],
        errors[1]
    );
}

impl Room {
    /// The mean time of a view.
    pub(crate) fn mean_ms(&self, method: Method) -> Option<f64> {
        self.rows.iter().find(|row| row.method == method).map(ComparisonRow::mean_ms)
    }

    /// By ascending resolution.
    pub(crate) fn hemicubes(&self) -> Vec<(usize, &ComparisonRow)> {
        let hemicubes = self.rows.iter().filter_map(|row| match row.method {
            Method::Hemicube { resolution } => Some((resolution, row)),
            _ => None,
        });
        hemicubes.collect()
    }

    /// The resolution at which a hemicube takes as long as that method, by means, between those measured: time is taken to be a power of
    /// the resolution there.
    pub(crate) fn crossover(&self, method: Method) -> Option<f64> {
        let ms = self.mean_ms(method)?;
        self.hemicubes().windows(2).rev().find_map(|pair| {
            let [(a, low), (b, high)] = [pair[0], pair[1]].map(|(size, row)| (size as f64, row.mean_ms()));
            (low <= ms && ms < high).then(|| a * (b / a).powf((ms / low).ln() / (high / low).ln()))
        })
    }
}
