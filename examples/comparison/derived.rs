//! What follows from the tables, so that no text has to quote them.

use crate::Room;
use crate::tables::percent;
use nusselt::hemicube::{ComparisonRow, Method};
use std::fmt::Write;

/// The two ways to a contour image, as they are called in tables.
const WAYS: [(Method, &str); 2] = [(Method::Contour, "3D BSP"), (Method::ContourByBoxes, "boxes")];
/// A view by boxes is to take no longer than a hemicube of the one resolution, or if that can be done, of the other.
const GOALS: [usize; 2] = [512, 256];
/// The error for which a resolution is extrapolated.
const SMALL: f64 = 0.01;

/// Writing to a string does not fail.
macro_rules! line {
    ($text:expr, $($rest:tt)*) => { let _ = writeln!($text, $($rest)*); };
}

pub(crate) fn text(rooms: &[Room]) -> String {
    [goals(rooms), costs(rooms), finer(rooms), lost(rooms), evaluations(rooms), rays(rooms)].concat()
}

fn goals(rooms: &[Room]) -> String {
    let mut text = String::from("\n### The goals\n\n");
    let [first, second] = GOALS;
    line!(
        text,
        "A view by boxes with all form factors is to take no longer than a hemicube of {first}, in the same run, and if that can be done no longer than one of {second}.\n"
    );
    line!(
        text,
        "| polygons | times a hemicube of {first} | the goal, 1 | times one of {second} | the further goal, 1 |"
    );
    line!(text, "| ---: | ---: | --- | ---: | --- |");
    for room in rooms {
        let ratios = GOALS.map(|resolution| room.times(Method::ContourByBoxes, Method::Hemicube { resolution }));
        let [one, other] = ratios.map(|ratio| format!("{ratio:.2} | {}", if ratio <= 1.0 { "met" } else { "missed" }));
        line!(text, "| {} | {one} | {other} |", room.polygons);
    }
    text
}

fn costs(rooms: &[Room]) -> String {
    let mut text = String::from("\n### What the costs are made of\n\n");
    line!(
        text,
        "| polygons | visible | by the 3D BSP, us a visible polygon | by boxes | hemicube: ns a pixel more | ns a polygon of the scene, with few pixels |"
    );
    line!(text, "| ---: | ---: | ---: | ---: | ---: | ---: |");
    for room in rooms {
        let [bsp, boxes] = WAYS.map(|(method, _)| room.us_a_visible_polygon(method));
        let hemicubes = room.hemicubes();
        let (Some((_, coarsest)), Some((_, finest))) = (hemicubes.first(), hemicubes.last()) else { continue };
        let pixels = |row: &ComparisonRow| row.evaluations as f64 / row.view_ms.len() as f64;
        let pixel = (finest.mean_ms() - coarsest.mean_ms()) * 1e6 / (pixels(finest) - pixels(coarsest));
        let polygon = coarsest.mean_ms() * 1e6 / room.polygons as f64;
        line!(
            text,
            "| {} | {:.0} | {bsp:.2} | {boxes:.2} | {pixel:.2} | {polygon:.1} |",
            room.polygons,
            room.visible()
        );
    }
    text
}

/// Errors fall as one over the resolution at best, and time grows as its square.
fn finer(rooms: &[Room]) -> String {
    let mut text = String::from("\n### What 1% would take\n\n");
    line!(
        text,
        "For all form factors above 1e-3, extrapolated from the finest hemicube: errors that fall as one over the resolution, which they do at best, and times that grow as its square.\n"
    );
    line!(text, "| polygons | finest | its worst error > 1e-3 | resolution for 1% | ms | times the view by boxes |");
    line!(text, "| ---: | ---: | ---: | ---: | ---: | ---: |");
    for room in rooms {
        let hemicubes = room.hemicubes();
        let Some((resolution, row)) = hemicubes.last() else { continue };
        let Some(error) = row.above_1e3.quantile(1.0) else { continue };
        let times = (error / SMALL).max(1.0);
        let ms = row.mean_ms() * times * times;
        line!(
            text,
            "| {} | {resolution} | {} | {:.0} | {ms:.0} | {:.0} |",
            room.polygons,
            percent(Some(error)),
            *resolution as f64 * times,
            ms / room.mean_ms(Method::ContourByBoxes).unwrap_or(f64::NAN)
        );
    }
    text
}

fn lost(rooms: &[Room]) -> String {
    let mut text = String::from("\n### Visible polygons that hemicubes lose\n\n| polygons |");
    let resolutions: Vec<usize> =
        rooms.first().map_or(Vec::new(), |room| room.hemicubes().into_iter().map(|(size, _)| size).collect());
    for resolution in &resolutions {
        let _ = write!(text, " {resolution} |");
    }
    line!(text, "\n| ---: |{}", " ---: |".repeat(resolutions.len()));
    for room in rooms {
        let _ = write!(text, "| {} |", room.polygons);
        for (_, row) in room.hemicubes() {
            let share = 100.0 * row.above_1e4.lost() as f64 / row.above_1e4.visible() as f64;
            let _ = write!(text, " {share:.1}% |");
        }
        text.push('\n');
    }
    text
}

fn evaluations(rooms: &[Room]) -> String {
    let mut text = String::from(
        "\n### Evaluations of form factors on the z-buffer\n\nTimes those of the contour image by boxes, and by the 3D BSP.\n\n| polygons |",
    );
    let of = |room: &Room, method: Method| {
        room.rows.iter().find(|row| row.method == method).map_or(f64::NAN, |row| row.evaluations as f64)
    };
    let resolutions: Vec<usize> =
        rooms.first().map_or(Vec::new(), |room| room.hemicubes().into_iter().map(|(size, _)| size).collect());
    for resolution in &resolutions {
        let _ = write!(text, " {resolution} |");
    }
    line!(text, "\n| ---: |{}", " ---: |".repeat(resolutions.len()));
    for room in rooms {
        let _ = write!(text, "| {} |", room.polygons);
        for &resolution in &resolutions {
            let analytic = of(room, Method::Analytic { resolution });
            let [bsp, boxes] = WAYS.map(|(method, _)| analytic / of(room, method));
            let _ = write!(text, " {boxes:.2}, {bsp:.2} |");
        }
        text.push('\n');
    }
    text
}

/// Rays against the coarsest hemicube whose worst error is no larger.
fn rays(rooms: &[Room]) -> String {
    let mut text = String::from("\n### Rays against hemicubes that are no worse\n\n");
    line!(
        text,
        "| polygons | rays | worst error > 1e-3 | lost | ms | hemicube | its worst error > 1e-3 | lost | ms | times as long |"
    );
    line!(text, "| ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    for room in rooms {
        for row in &room.rows {
            let Method::Rays { rays } = row.method else { continue };
            let worst = |row: &ComparisonRow| row.above_1e3.quantile(1.0);
            let hemicubes = room.hemicubes();
            let Some((resolution, other)) = hemicubes.iter().find(|(_, other)| worst(other) <= worst(row)) else {
                continue;
            };
            let lost = |row: &ComparisonRow| row.above_1e4.lost() as f64 / row.view_ms.len() as f64;
            line!(
                text,
                "| {} | {rays} | {} | {:.1} | {:.3} | {resolution} | {} | {:.1} | {:.3} | {:.1} |",
                room.polygons,
                percent(worst(row)),
                lost(row),
                row.mean_ms(),
                percent(worst(other)),
                lost(other),
                other.mean_ms(),
                row.mean_ms() / other.mean_ms()
            );
        }
    }
    text
}

/// What README.md says of it.
pub(crate) fn summary(rooms: &[Room]) -> String {
    let list = |of: &dyn Fn(&Room) -> String| {
        let items: Vec<String> = rooms.iter().map(of).collect();
        items.split_last().map_or(String::new(), |(last, rest)| format!("{} and {last}", rest.join(", ")))
    };
    let [first, second] = GOALS;
    let boxes = Method::ContourByBoxes;
    let mut text = format!(
        "On one core a hemisphere view with all form factors of closed rooms of {} polygons takes {} ms, which is {} microseconds for each polygon that is seen.\n",
        list(&|room| room.polygons.to_string()),
        list(&|room| format!("{:.2}", room.mean_ms(boxes).unwrap_or(f64::NAN))),
        list(&|room| format!("{:.2}", room.us_a_visible_polygon(boxes))),
    );
    line!(
        text,
        "That is {} times as long as a hemicube of {first} pixels across, and {} times as long as one of {second}. The worst form factors above 1e-3 of the one are off by {}, those of the other by {}.",
        list(&|room| format!("{:.2}", room.times(boxes, Method::Hemicube { resolution: first }))),
        list(&|room| format!("{:.2}", room.times(boxes, Method::Hemicube { resolution: second }))),
        list(&|room| room.worst(first)),
        list(&|room| room.worst(second)),
    );
    text
}

impl Room {
    /// How many times as long one method takes as another one.
    fn times(&self, method: Method, other: Method) -> f64 {
        let [one, other] = [method, other].map(|method| self.mean_ms(method).unwrap_or(f64::NAN));
        one / other
    }

    /// The mean over the views.
    fn visible(&self) -> f64 {
        self.rows.first().map_or(f64::NAN, |row| row.above_1e4.visible() as f64 / row.view_ms.len() as f64)
    }

    fn us_a_visible_polygon(&self, method: Method) -> f64 {
        self.mean_ms(method).unwrap_or(f64::NAN) * 1e3 / self.visible()
    }

    /// The worst error of a hemicube's form factors above 1e-3.
    fn worst(&self, resolution: usize) -> String {
        let hemicubes = self.hemicubes();
        percent(hemicubes.iter().find(|(size, _)| *size == resolution).and_then(|(_, row)| row.above_1e3.quantile(1.0)))
    }
}
