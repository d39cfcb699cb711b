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

/// Below the one resolution the report's hemicube was faster than its analytic method, above the other it was slower.
const CROSSOVER_OF_THE_REPORT: [f64; 2] = [128.0, 512.0];
/// The largest relative error of the report's hemicube at the higher resolution.
const ERROR_OF_THE_REPORT: f64 = 0.01;

const WIDTH: u32 = 1140;
const HEIGHT: u32 = 420;

pub(crate) fn draw(rooms: &[Room], folder: &Path) -> Outcome {
    std::fs::create_dir_all(folder)?;
    figure(&folder.join("comparison-time.svg"), rooms, &time())?;
    figure(&folder.join("comparison-error.svg"), rooms, &error())?;
    figure(&folder.join("comparison-error-by-time.svg"), rooms, &error_by_time())
}

/// What a figure shows in each of its panels.
struct Plot {
    x: Axis,
    y: Axis,
    /// Straight lines for the contour images.
    contours: Contours,
}

struct Axis {
    title: &'static str,
    range: (f64, f64),
    /// Where its labels are.
    labels: Vec<f64>,
    value: fn(&ComparisonRow) -> f64,
    label: fn(&f64) -> String,
}

/// Which lines stand for the contour images.
enum Contours {
    /// Their times, across, with circles where hemicubes take as long.
    TimesAcross,
    /// Their times, upright.
    TimesUpright,
    /// The resolutions of hemicubes that take as long.
    Crossovers,
}

fn resolution() -> Axis {
    Axis {
        title: "resolution (rays: of as many pixels)",
        range: (14.0, 2600.0),
        labels: vec![16.0, 32.0, 64.0, 128.0, 256.0, 512.0, 1024.0, 2048.0],
        value: pixels_across,
        label: |x| format!("{x:.0}"),
    }
}

fn milliseconds() -> Axis {
    Axis {
        title: "milliseconds a view (mean)",
        range: (0.03, 200.0),
        labels: vec![0.1, 1.0, 10.0, 100.0],
        value: ComparisonRow::mean_ms,
        label: |x| format!("{x}"),
    }
}

fn worst() -> Axis {
    Axis {
        title: "worst relative error of factors > 1e-3",
        range: (0.005, 20.0),
        labels: vec![0.01, 0.1, 1.0, 10.0],
        value: |row| row.above_1e3.quantile(1.0).unwrap_or(f64::NAN),
        label: |x| format!("{:.0}%", 100.0 * x),
    }
}

fn time() -> Plot {
    Plot { x: resolution(), y: milliseconds(), contours: Contours::TimesAcross }
}

fn error() -> Plot {
    Plot { x: resolution(), y: worst(), contours: Contours::Crossovers }
}

fn error_by_time() -> Plot {
    Plot { x: milliseconds(), y: worst(), contours: Contours::TimesUpright }
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
    let Plot { x, y, contours } = plot;
    let [on_x, on_y] = [x, y].map(|axis| (axis.range.0..axis.range.1).log_scale().with_key_points(axis.labels.clone()));
    let mut chart = ChartBuilder::on(panel)
        .caption(format!("room of {} polygons", grouped(room.polygons)), ("sans-serif", 17))
        .margin(8)
        .x_label_area_size(42)
        .y_label_area_size(62)
        .build_cartesian_2d(on_x, on_y)?;
    let across = |at: f64| [(x.range.0, at), (x.range.1, at)];
    let upright = |at: f64| [(at, y.range.0), (at, y.range.1)];
    if !matches!(contours, Contours::TimesUpright) {
        let [low, high] = CROSSOVER_OF_THE_REPORT;
        chart.draw_series([Rectangle::new([(low, y.range.0), (high, y.range.1)], BLACK.mix(0.07).filled())])?;
    }
    chart
        .configure_mesh()
        .x_desc(x.title)
        .y_desc(y.title)
        .x_label_formatter(&x.label)
        .y_label_formatter(&y.label)
        .bold_line_style(BLACK.mix(0.15))
        .light_line_style(TRANSPARENT)
        .label_style(("sans-serif", 13))
        .draw()?;
    if !matches!(contours, Contours::TimesAcross) {
        chart.draw_series(DashedLineSeries::new(across(ERROR_OF_THE_REPORT), 3, 4, BLACK.mix(0.6).into()))?;
    }
    for (method, colour) in [(Method::Contour, CONTOUR), (Method::ContourByBoxes, BOXES)] {
        let Some(ms) = room.mean_ms(method) else { continue };
        let crossover = room.crossover(method);
        let ends = match contours {
            Contours::TimesAcross => Some(across(ms)),
            Contours::TimesUpright => Some(upright(ms)),
            Contours::Crossovers => crossover.map(upright),
        };
        if let Some(ends) = ends {
            chart.draw_series(LineSeries::new(ends, colour.stroke_width(2)))?;
        }
        if let (Contours::TimesAcross, Some(resolution)) = (contours, crossover) {
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
    let contours = match plot.contours {
        Contours::TimesAcross | Contours::TimesUpright => ["contour by 3D BSP (exact)", "contour by boxes (exact)"],
        Contours::Crossovers => ["as fast as contour by 3D BSP", "as fast as contour by boxes"],
    };
    let mut entries = vec![
        (contours[0], CONTOUR.stroke_width(4)),
        (contours[1], BOXES.stroke_width(4)),
        ("hemicube", HEMICUBE.stroke_width(4)),
        ("analytic, z-buffer", ANALYTIC.stroke_width(4)),
        ("rays", RAYS.stroke_width(4)),
    ];
    if !matches!(plot.contours, Contours::TimesUpright) {
        entries.push(("crossover in the report", BLACK.mix(0.1).stroke_width(12)));
    }
    if !matches!(plot.contours, Contours::TimesAcross) {
        entries.push(("1%: error in the report", BLACK.mix(0.6).stroke_width(1)));
    }
    let mut left = 66;
    for (name, line) in entries {
        legend.draw(&PathElement::new([(left, 14), (left + 22, 14)], line))?;
        legend.draw(&Text::new(name, (left + 28, 8), ("sans-serif", 13)))?;
        left += 46 + 56 * name.len() as i32 / 10;
    }
    Ok(())
}

/// With a comma before each three digits.
fn grouped(number: usize) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (k, digit) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}
