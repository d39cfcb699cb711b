//! Contour images as SVG: what is seen, in flat colours, with thin outlines.

mod brdf;
mod drawing;
mod lines;
pub(super) mod paint;

pub use brdf::{BrdfPicture, write_brdf_svg};
pub use drawing::{DrawingCounts, DrawingOptions, Fill, write_drawing};

use crate::contour::{CellId, ContourImage, Projection, Projector};
use crate::scene::PolygonId;
use glam::DVec2;
use paint::Paint;
use std::fmt::{self, Display};
use std::io::{self, BufWriter, Write};

/// How a picture is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SvgOptions {
    /// The length of the picture's longer side.
    pub size: f64,
    /// Draw the arcs of the contour tree over it, with a legend.
    pub show_tree: bool,
}

impl Default for SvgOptions {
    fn default() -> Self {
        Self { size: 1000.0, show_tree: false }
    }
}

/// Room around the picture.
const MARGIN: f64 = 20.0;
/// Room below it for the legend.
const LEGEND: f64 = 40.0;
/// How far a drawn curve may leave the true one.
const TOLERANCE: f64 = 0.1;

/// Writes a contour image as an SVG picture.
///
/// Every visible polygon is one path `polygon_K` in its material's diffuse colour, shaded by how it
/// faces the eye; emitters show the hue of what they emit; background is light blue. Thin lines mark
/// where another polygon begins, very thin ones where it looks the same.
///
/// # Errors
/// Those of `out`.
pub fn write_svg(image: &ContourImage, projector: &Projector, options: &SvgOptions, out: impl Write) -> io::Result<()> {
    let mut out = BufWriter::new(out);
    let canvas = Canvas::new(projector, options.size);
    let size = canvas.size + 2.0 * MARGIN + if options.show_tree { DVec2::Y * LEGEND } else { DVec2::ZERO };
    open(size, &mut out)?;
    let visible = cells_of_polygons(image);
    head(image, projector, &visible, &mut out)?;
    writeln!(out, "<style>\n{}</style>", lines::STYLE)?;
    paper(size, &mut out)?;
    // Pale below a tree.
    let opacity = if options.show_tree { r#" opacity="0.55""# } else { "" };
    writeln!(out, r#"<g stroke-width="1" stroke-linejoin="round"{opacity}>"#)?;
    let paint = Paint::new(image, projector.frame());
    for (polygon, cells) in &visible {
        canvas.polygon(image, *polygon, cells, &paint, &mut out)?;
    }
    writeln!(out, "</g>")?;
    lines::outlines(image, &canvas, &paint, &mut out)?;
    if options.show_tree {
        lines::tree(image, &canvas, &mut out)?;
        lines::legend(DVec2::new(MARGIN, size.y - LEGEND / 2.0), &mut out)?;
    }
    writeln!(out, "{}", canvas.frame())?;
    writeln!(out, "</svg>")?;
    out.flush()
}

type Visible = Vec<(Option<PolygonId>, Vec<CellId>)>;

/// The cells of every visible polygon, background first.
fn cells_of_polygons(image: &ContourImage) -> Visible {
    let mut cells: Vec<_> = image.cells().map(|cell| (cell.polygon(), cell.id())).collect();
    cells.sort_unstable();
    let groups = cells.chunk_by(|a, b| a.0 == b.0);
    groups.map(|group| (group[0].0, group.iter().map(|&(_, id)| id).collect())).collect()
}

/// Opens a file of that size.
fn open(size: DVec2, out: &mut impl Write) -> io::Result<()> {
    let (width, height) = (Number(size.x), Number(size.y));
    writeln!(out, r#"<?xml version="1.0" encoding="UTF-8"?>"#)?;
    writeln!(
        out,
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}">"#
    )
}

/// White, all over a picture of that size.
fn paper(size: DVec2, out: &mut impl Write) -> io::Result<()> {
    writeln!(out, r#"<rect width="{}" height="{}" fill="white"/>"#, Number(size.x), Number(size.y))
}

fn head(image: &ContourImage, projector: &Projector, visible: &Visible, out: &mut impl Write) -> io::Result<()> {
    let eye = image.viewpoint().eye();
    let name = projector.projection().name();
    writeln!(out, "<title>Contour image from ({}, {}, {}), {name} projection</title>", eye.x, eye.y, eye.z)?;
    let frame = projector.frame();
    let axis = |v: glam::DVec3| format!("({}, {}, {})", Number(v.x), Number(v.y), Number(v.z));
    let seen = visible.iter().filter(|(polygon, _)| polygon.is_some()).count();
    writeln!(
        out,
        "<desc>{seen} visible polygons in {} cells, as seen by an eye looking along {} with {} up.</desc>",
        image.cell_count(),
        axis(frame.towards()),
        axis(frame.up())
    )
}

/// From the plane of a projection to the coordinates of the file.
struct Canvas<'a> {
    projector: &'a Projector,
    scale: f64,
    size: DVec2,
}

impl<'a> Canvas<'a> {
    fn new(projector: &'a Projector, longer: f64) -> Self {
        let size = projector.window().size();
        let scale = longer / size.max_element();
        Self { projector, scale, size: size * scale }
    }

    fn tolerance(&self) -> f64 {
        TOLERANCE / self.scale
    }

    fn place(&self, p: DVec2) -> DVec2 {
        let window = self.projector.window();
        DVec2::new(p.x - window.low.x, window.high.y - p.y) * self.scale + MARGIN
    }

    fn polygon(
        &self,
        image: &ContourImage,
        polygon: Option<PolygonId>,
        cells: &[CellId],
        paint: &Paint<'_>,
        out: &mut impl Write,
    ) -> io::Result<()> {
        let mut data = PathData::default();
        let mut corners = Vec::new();
        for &id in cells {
            corners.clear();
            corners.extend(image.cell(id).boundary());
            for path in self.projector.cell(&corners, self.tolerance()) {
                data.add(path.into_iter().map(|p| self.place(p)), true);
            }
        }
        let colour = paint.of(polygon);
        match polygon {
            // It is visible in directions that the picture does not show.
            _ if data.is_empty() => Ok(()),
            None => writeln!(out, r#"<path id="background" fill="{colour}" stroke="{colour}" d="{data}"/>"#),
            Some(id) => {
                let polygon = image.scene().polygon(id);
                let (object, material) = (Escaped(polygon.object_name()), Escaped(&polygon.material().name));
                writeln!(
                    out,
                    r#"<path id="polygon_{id}" fill="{colour}" stroke="{colour}" d="{data}"><title>polygon {id}, {object}, {material}</title></path>"#
                )
            }
        }
    }

    /// The border of the picture.
    fn frame(&self) -> String {
        let round = matches!(self.projector.projection(), Projection::Nusselt | Projection::Stereographic)
            && self.projector.window().high.x <= 1.0;
        let [x, y] = [Number(self.size.x), Number(self.size.y)];
        if round {
            let middle = Number(MARGIN + self.size.x / 2.0);
            format!(r#"<circle class="border" cx="{middle}" cy="{middle}" r="{}"/>"#, Number(self.size.x / 2.0))
        } else {
            format!(r#"<rect class="border" x="{MARGIN}" y="{MARGIN}" width="{x}" height="{y}"/>"#)
        }
    }
}

/// A path's `d`, without points that fall on the one before.
#[derive(Debug, Default)]
struct PathData(String);

impl PathData {
    fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    fn add(&mut self, points: impl IntoIterator<Item = DVec2>, closed: bool) {
        let mut last = None;
        let mut count = 0;
        let start = self.0.len();
        for p in points {
            let text = format!("{},{}", Number(p.x), Number(p.y));
            if last.as_ref() != Some(&text) {
                self.0.push(if count == 0 { 'M' } else { ' ' });
                self.0.push_str(&text);
                last = Some(text);
                count += 1;
            }
        }
        if count < 2 {
            self.0.truncate(start);
        } else if closed {
            self.0.push('Z');
        }
    }

    /// Adds a contour of no area where the first one starts. Chromium fills what is one convex contour by a way of its own, which leaves out pixels inside of it if a side is
    /// a small part of a pixel long (seen in version 148).
    fn add_point(&mut self) {
        if let Some(first) = self.0.split([' ', 'Z']).next().map(str::to_owned) {
            self.0.push_str(&first);
            self.0.push('Z');
        }
    }
}

impl Display for PathData {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// A coordinate in hundredths, as short as that goes.
struct Number(f64);

impl Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        ((self.0 * 100.0).round() / 100.0 + 0.0).fmt(f)
    }
}

/// Text between tags: escaped, without characters that XML does not have.
struct Escaped<'a>(&'a str);

impl Display for Escaped<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for c in self.0.chars() {
            match c {
                '&' => f.write_str("&amp;")?,
                '<' => f.write_str("&lt;")?,
                '>' => f.write_str("&gt;")?,
                c if c.is_control() || matches!(c, '\u{FFFE}' | '\u{FFFF}') => f.write_str("\u{FFFD}")?,
                c => write!(f, "{c}")?,
            }
        }
        Ok(())
    }
}
