//! The figures of docs/comparison.md.

use crate::Room;
use nusselt::hemicube::{ComparisonRow, Method};
use nusselt::io::atomic_write;
use plotters::coord::Shift;
use plotters::prelude::*;
use std::error::Error;
use std::io::Write;
use std::path::Path;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Outcome = Result<(), Box<dyn Error>>;

/// Colours that stay apart for the colour-blind (Okabe and Ito 2008).
const CONTOUR: RGBColor = RGBColor(213, 94, 0);
const BOXES: RGBColor = RGBColor(204, 121, 167);
const HEMICUBE: RGBColor = RGBColor(0, 114, 178);
const ANALYTIC: RGBColor = RGBColor(0, 158, 115);
const RAYS: RGBColor = RGBColor(120, 120, 120);

const WIDTH: u32 = 1140;
const HEIGHT: u32 = 420;

pub(crate) fn draw(rooms: &[Room], folder: &Path) -> Outcome {
    std::fs::create_dir_all(folder)?;
    figure(&folder.join("time.svg"), rooms, &time())?;
    figure(&folder.join("error.svg"), rooms, &error())?;
    figure(&folder.join("error-time.svg"), rooms, &error_by_time())
}

/// What a figure shows in each of its panels.
struct Plot {
    x: Axis,
    y: Axis,
    /// Straight lines for the contour images: by their times, or where hemicubes take as long.
    level: Level,
    /// An error to compare with.
    report: bool,
}

struct Axis {
    title: &'static str,
    range: (f64, f64),
    value: fn(&ComparisonRow) -> f64,
    label: fn(&f64) -> String,
}

enum Level {
    TimeAcross,
    TimeUpright,
    CrossoverUpright,
}

fn resolution() -> Axis {
    Axis {
        title: "resolution (rays: of as many pixels)",
        range: (14.0, 2600.0),
        value: pixels_across,
        label: |x| format!("{x:.0}"),
    }
}

fn milliseconds(title: &'static str) -> Axis {
    Axis { title, range: (0.03, 200.0), value: ComparisonRow::median_ms, label: |x| format!("{x}") }
}

fn worst() -> Axis {
    Axis {
        title: "worst relative error of factors > 1e-3",
        range: (0.005, 20.0),
        value: |row| row.above_1e3.quantile(1.0),
        label: |x| format!("{}%", 100.0 * x),
    }
}

fn time() -> Plot {
    Plot { x: resolution(), y: milliseconds("ms a view (median)"), level: Level::TimeAcross, report: false }
}

fn error() -> Plot {
    Plot { x: resolution(), y: worst(), level: Level::CrossoverUpright, report: true }
}

fn error_by_time() -> Plot {
    Plot { x: milliseconds("ms a view (median)"), y: worst(), level: Level::TimeUpright, report: true }
}

/// A hemicube of resolution r has 3 r^2 pixels; rays are put where it has as many.
fn pixels_across(row: &ComparisonRow) -> f64 {
    let resolution = row.method.resolution().unwrap_or(0) as f64;
    if matches!(row.method, Method::Rays { .. }) { (resolution / 3.0).sqrt() } else { resolution }
}

fn figure(path: &Path, rooms: &[Room], plot: &Plot) -> Outcome {
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, (WIDTH, HEIGHT)).into_drawing_area();
        root.fill(&WHITE)?;
        let (panels, legend) = root.split_vertically(HEIGHT as i32 - 40);
        for (panel, room) in panels.split_evenly((1, rooms.len())).iter().zip(rooms) {
            draw_panel(panel, room, plot)?;
        }
        draw_legend(&legend, plot)?;
        root.present()?;
    }
    Ok(atomic_write(path, |file| file.write_all(svg.as_bytes()))?)
}

fn draw_panel(panel: &Area<'_>, room: &Room, plot: &Plot) -> Outcome {
    let Plot { x, y, .. } = plot;
    let mut chart = ChartBuilder::on(panel)
        .caption(format!("{} polygons", room.polygons), ("sans-serif", 18))
        .margin(8)
        .x_label_area_size(42)
        .y_label_area_size(62)
        .build_cartesian_2d((x.range.0..x.range.1).log_scale(), (y.range.0..y.range.1).log_scale())?;
    chart
        .configure_mesh()
        .x_desc(x.title)
        .y_desc(y.title)
        .x_label_formatter(&x.label)
        .y_label_formatter(&y.label)
        .bold_line_style(BLACK.mix(0.15))
        .light_line_style(BLACK.mix(0.05))
        .label_style(("sans-serif", 13))
        .draw()?;
    let across = |at: f64| [(x.range.0, at), (x.range.1, at)];
    let upright = |at: f64| [(at, y.range.0), (at, y.range.1)];
    if plot.report {
        chart.draw_series(DashedLineSeries::new(across(0.01), 3, 4, BLACK.mix(0.6).into()))?;
    }
    for (method, colour) in [(Method::Contour, CONTOUR), (Method::ContourByBoxes, BOXES)] {
        let Some(ms) = room.median_ms(method) else { continue };
        let ends = match plot.level {
            Level::TimeAcross => Some(across(ms)),
            Level::TimeUpright => Some(upright(ms)),
            Level::CrossoverUpright => room.crossover(method).map(upright),
        };
        if let Some(ends) = ends {
            chart.draw_series(LineSeries::new(ends, colour.stroke_width(2)))?;
        }
        if let (Level::TimeAcross, Some(resolution)) = (&plot.level, room.crossover(method)) {
            chart.draw_series([Circle::new((resolution, ms), 6, colour.stroke_width(2))])?;
        }
    }
    for (is_wanted, colour) in series() {
        let rows = room.rows.iter().filter(|row| is_wanted(&row.method));
        // What is beyond the plot is left out, not moved into it.
        let points: Vec<_> = rows
            .map(|row| ((x.value)(row), (y.value)(row)))
            .filter(|p| (x.range.0..=x.range.1).contains(&p.0) && (y.range.0..=y.range.1).contains(&p.1))
            .collect();
        chart.draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(2)))?;
        chart.draw_series(points.iter().map(|&point| Circle::new(point, 3, colour.filled())))?;
    }
    Ok(())
}

type Wanted = fn(&Method) -> bool;

fn series() -> [(Wanted, RGBColor); 3] {
    [
        (|method| matches!(method, Method::Hemicube { .. }), HEMICUBE),
        (|method| matches!(method, Method::Analytic { .. }), ANALYTIC),
        (|method| matches!(method, Method::Rays { .. }), RAYS),
    ]
}

fn draw_legend(legend: &Area<'_>, plot: &Plot) -> Outcome {
    let contour = match plot.level {
        Level::TimeAcross | Level::TimeUpright => ["contour by 3D BSP (exact)", "contour by boxes (exact)"],
        Level::CrossoverUpright => ["as fast as the contour by 3D BSP", "as fast as the contour by boxes"],
    };
    let mut entries = vec![
        (contour[0], CONTOUR.to_rgba()),
        (contour[1], BOXES.to_rgba()),
        ("hemicube", HEMICUBE.to_rgba()),
        ("analytic, z-buffer", ANALYTIC.to_rgba()),
        ("rays", RAYS.to_rgba()),
    ];
    if plot.report {
        entries.push(("1%, the report's", BLACK.mix(0.6)));
    }
    let mut left = 70;
    for (name, colour) in entries {
        legend.draw(&PathElement::new([(left, 14), (left + 26, 14)], colour.stroke_width(3)))?;
        legend.draw(&Text::new(name, (left + 34, 8), ("sans-serif", 14)))?;
        left += 60 + 7 * name.len() as i32;
    }
    Ok(())
}
