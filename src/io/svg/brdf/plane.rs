//! The BRDF on the image plane, with the contour image over it.

use super::super::paint::Paint;
use super::super::{Canvas, MARGIN, Number, PathData, lines};
use super::bands::Field;
use super::{Seen, arrow, begin, label, short, word};
use crate::brdf::{Place, emitted};
use crate::contour::{Cell, ContourImage, Projector, ViewFrame};
use crate::scene::{PolygonId, Side};
use glam::{DVec2, DVec3};
use std::collections::BTreeSet;
use std::io::{self, Write};

/// The picture reaches so many degrees from the normal, to the middle of each side.
const REACH: f64 = 65.0;
const SIZE: f64 = 720.0;
/// Room for the title above, and for the legend to the right.
const TITLE: f64 = 30.0;
const LEGEND: f64 = 170.0;

/// From low to high.
const COLOURS: [&str; 10] =
    ["#fff8ec", "#fef0d6", "#fee3b5", "#fdd28e", "#fdbb6d", "#fc9d58", "#f57b4b", "#e6583c", "#cf3527", "#ae1417"];

const STYLE: &str = "\
.emitter{fill:#2f6fd6;fill-opacity:.22;stroke:#1c56b4;stroke-width:1.6;stroke-linejoin:round}
.mark{fill:none;stroke:#111;stroke-width:1.8}
";

pub(super) fn write(image: &ContourImage, place: &Place, seen: &Seen<'_>, out: &mut impl Write) -> io::Result<()> {
    let normal = place.to_scene(DVec3::Z);
    let projector = Projector::of_plane(ViewFrame::upright(normal), DVec2::splat(REACH.to_radians().tan()));
    let canvas = Canvas::new(&projector, SIZE);
    let field = field(&projector, place, seen);
    let size = DVec2::new(SIZE + 2.0 * MARGIN + LEGEND, SIZE + 2.0 * MARGIN + TITLE);
    let style = format!("{}{STYLE}", lines::STYLE);
    begin(size, "Contour image mapped on the projected BRDF", &style, out)?;
    writeln!(out, r#"<g transform="translate(0,{TITLE})">"#)?;
    let levels = levels(field.max());
    writeln!(out, r#"<g id="bands" fill-rule="evenodd">"#)?;
    for (&level, colour) in levels.iter().zip(COLOURS) {
        let mut data = PathData::default();
        for points in field.at_least(level) {
            data.add(points.into_iter().map(|p| canvas.place(p)), true);
        }
        if !data.is_empty() {
            writeln!(out, r#"<path fill="{colour}" d="{data}"/>"#)?;
        }
    }
    writeln!(out, "</g>")?;
    emitters(image, &canvas, out)?;
    lines::outlines(image, &canvas, &Paint::new(image, projector.frame()), out)?;
    angles(&canvas, out)?;
    marks(&canvas, place, seen, out)?;
    writeln!(out, "{}", canvas.frame())?;
    legend(&levels, field.max(), image, out)?;
    writeln!(out, "</g>")
}

/// BRDF times cosine times dw / dA = cos^3 over the picture, with lines of the grid close together about its peaks.
fn field(projector: &Projector, place: &Place, seen: &Seen<'_>) -> Field {
    let window = projector.window();
    let frame = projector.frame();
    let peaks: Vec<DVec2> = seen.axes().iter().map(|&axis| projector.point(place.to_scene(axis))).collect();
    let lines = |low: f64, high: f64, peaks: &mut dyn Iterator<Item = f64>| {
        let mut lines: Vec<f64> = (0..=120).map(|k| low + (high - low) * f64::from(k) / 120.0).collect();
        for peak in peaks {
            lines.push(peak);
            let steps = (0..36).map(|k| 5e-4 * 1.2_f64.powi(k));
            lines.extend(steps.flat_map(|step| [peak - step, peak + step]));
        }
        lines.retain(|x| (low..=high).contains(x));
        lines.sort_by(f64::total_cmp);
        lines.dedup_by(|a, b| *a - *b < 1e-4);
        lines
    };
    let x = lines(window.low.x, window.high.x, &mut peaks.iter().map(|p| p.x));
    let y = lines(window.low.y, window.high.y, &mut peaks.iter().map(|p| p.y));
    Field::new(x, y, |p| {
        let direction = (frame.right() * p.x + frame.up() * p.y + frame.towards()).normalize();
        let incoming = place.to_local(direction);
        seen.luminance(incoming) * incoming.z.max(0.0).powi(4)
    })
}

/// Closer together below, where most of the plane is.
fn levels(most: f64) -> Vec<f64> {
    let count = COLOURS.len();
    (0..count).map(|k| most * ((k as f64 + 0.3) / count as f64).powf(1.7)).filter(|&level| level > 0.0).collect()
}

/// What emits towards the surface.
fn emitters(image: &ContourImage, canvas: &Canvas<'_>, out: &mut impl Write) -> io::Result<()> {
    let polygons = emitting(image);
    if polygons.is_empty() {
        return Ok(());
    }
    let mut data = PathData::default();
    for region in canvas.projector.regions(image, canvas.tolerance()) {
        let is_emitter = region.polygon.is_some_and(|polygon| polygons.contains(&polygon));
        if is_emitter && region.side == Some(Side::Front) {
            data.add(region.exterior.iter().map(|&p| canvas.place(p)), true);
            for hole in &region.holes {
                data.add(hole.iter().map(|&p| canvas.place(p)), true);
            }
        }
    }
    if data.is_empty() {
        Ok(())
    } else {
        writeln!(out, r#"<path id="emitters" class="emitter" fill-rule="evenodd" d="{data}"/>"#)
    }
}

fn emitting(image: &ContourImage) -> BTreeSet<PolygonId> {
    let is_lit = |cell: &Cell<'_>| emitted(*cell).max_element() > 0.0;
    image.cells().filter(is_lit).filter_map(Cell::polygon).collect()
}

/// Circles of equal angles to the normal.
fn angles(canvas: &Canvas<'_>, out: &mut impl Write) -> io::Result<()> {
    let middle = canvas.place(DVec2::ZERO);
    for degrees in [15_u32, 30, 45, 60] {
        let radius = f64::from(degrees).to_radians().tan() * canvas.scale;
        let [x, y, r] = [middle.x, middle.y, radius].map(Number);
        writeln!(out, r#"<circle class="dashed" cx="{x}" cy="{y}" r="{r}"/>"#)?;
        let at = middle + DVec2::new(-0.5, 0.866) * radius;
        label(at + DVec2::new(0.0, 5.0), "middle", "small", &format!("{degrees}\u{b0}"), out)?;
    }
    Ok(())
}

/// The normal, and where a mirror would look.
fn marks(canvas: &Canvas<'_>, place: &Place, seen: &Seen<'_>, out: &mut impl Write) -> io::Result<()> {
    let middle = canvas.place(DVec2::ZERO);
    let [x, y] = [Number(middle.x), Number(middle.y)];
    writeln!(out, r#"<path class="mark" d="M{x},{y}m-6,0h12m-6,-6v12"/>"#)?;
    let mirror = canvas.projector.point(place.to_scene(seen.mirrored()));
    let what = if seen.has_mirror() { "r (a mirror: all from here)" } else { "r" };
    let at = canvas.place(mirror);
    // The viewer may look straight down.
    if at.distance(middle) < 1.0 {
        return label(middle + DVec2::new(9.0, -8.0), "start", "", &format!("n, {what}"), out);
    }
    label(middle + DVec2::new(9.0, -8.0), "start", "", "n", out)?;
    let window = canvas.projector.window();
    if mirror.cmpge(window.low).all() && mirror.cmple(window.high).all() {
        let [x, y] = [Number(at.x), Number(at.y)];
        writeln!(out, r#"<circle class="mark" cx="{x}" cy="{y}" r="6"/>"#)?;
        return label(at + DVec2::new(10.0, -9.0), "start", "", what, out);
    }
    // Beyond the picture: that way.
    let way = mirror.normalize_or_zero() * DVec2::new(1.0, -1.0);
    let at = middle + way * (SIZE / 2.0 - 12.0) / way.abs().max_element().max(1e-9);
    arrow(at - way * 36.0, at, "arrow", out)?;
    label(at - way * 48.0, "middle", "", what, out)
}

fn legend(levels: &[f64], most: f64, image: &ContourImage, out: &mut impl Write) -> io::Result<()> {
    let left = SIZE + MARGIN + 24.0;
    let (top, height) = (MARGIN + 64.0, 34.0);
    word(DVec2::new(left, MARGIN + 14.0), "start", "", "BRDF \u{d7} cos\u{2074}\u{3b8}", out)?;
    word(DVec2::new(left, MARGIN + 32.0), "start", "small", "per unit of the plane, sr\u{207b}\u{b9}", out)?;
    let bottom = top + height * levels.len() as f64;
    for (k, (&level, colour)) in levels.iter().zip(COLOURS).enumerate() {
        let y = bottom - height * (k as f64 + 1.0);
        let [x, y] = [left, y].map(Number);
        writeln!(
            out,
            r##"<rect x="{x}" y="{y}" width="26" height="{height}" fill="{colour}" stroke="#777" stroke-width=".5"/>"##
        )?;
        word(DVec2::new(left + 34.0, bottom - height * k as f64 + 4.0), "start", "small", &short(level), out)?;
    }
    if most > 0.0 {
        word(DVec2::new(left + 34.0, top + 4.0), "start", "small", &format!("{} (most)", short(most)), out)?;
    }
    let mut y = bottom + 44.0;
    if !emitting(image).is_empty() {
        writeln!(out, r#"<rect class="emitter" x="{left}" y="{}" width="26" height="16"/>"#, Number(y - 12.0))?;
        word(DVec2::new(left + 34.0, y + 1.0), "start", "small", "emits", out)?;
        y += 28.0;
    }
    for (symbol, text) in [("n", "normal"), ("r", "mirror direction")] {
        word(DVec2::new(left + 13.0, y), "middle", "", symbol, out)?;
        word(DVec2::new(left + 34.0, y), "start", "small", text, out)?;
        y += 24.0;
    }
    Ok(())
}
