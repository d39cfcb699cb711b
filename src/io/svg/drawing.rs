//! Line drawings: visible surfaces as filled regions, and visible edges by kind over them.

use super::paint::{Paint, hex};
use super::{Canvas, Escaped, MARGIN, PathData, open, paper};
use crate::contour::{ContourImage, EdgeTracer, Projector, RegionLoop, VisibleRegion};
use crate::exact::Sign;
use crate::scene::{EdgeId, PieceId, PolygonId, Scene, Side};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;
use std::io::{self, BufWriter, Write};

/// How surfaces are filled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Fill {
    /// In the diffuse colour of their material, shaded by how they face a light over the eye's left shoulder.
    #[default]
    Shaded,
    /// In the diffuse colour of their material.
    Flat,
    /// In white: lines only.
    White,
}

/// How a drawing is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrawingOptions {
    /// The length of the picture's longer side.
    pub size: f64,
    /// How surfaces are filled.
    pub fill: Fill,
    /// Dash the edges that are hidden.
    pub hidden: bool,
    /// Edges between two polygons of one material are drawn where the surface turns by more than this, in radians.
    pub crease: f64,
}

impl Default for DrawingOptions {
    fn default() -> Self {
        Self { size: 1000.0, fill: Fill::Shaded, hidden: false, crease: 20.0 / 180.0 * PI }
    }
}

/// What a drawing shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DrawingCounts {
    /// Filled regions.
    pub regions: usize,
    /// Stretches of visible silhouettes, borders, creases, and lines where polygons pass through each other.
    pub silhouettes: usize,
    /// See there.
    pub borders: usize,
    /// See there.
    pub creases: usize,
    /// See there.
    pub crossings: usize,
    /// Stretches of hidden edges.
    pub hidden: usize,
}

/// The kind of an edge from where the eye is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    /// Between polygons whose surface turns there, or of two materials, or of more than two polygons.
    Crease,
    /// Of one polygon only.
    Border,
    /// All polygons that have it are seen on one side of it: of two, one shows its front and one its back.
    Silhouette,
}

const STYLE: &str = "\
path{stroke-linejoin:round;stroke-linecap:round}
#fills path{vector-effect:non-scaling-stroke}
.hidden,.crease,.crossing,.border,.silhouette{fill:none;stroke:#1a1a1a}
.hidden{stroke-width:.5;stroke-dasharray:4 3;stroke-opacity:.6}
.crease,.crossing{stroke-width:.8}
.border{stroke-width:1.2}
.silhouette{stroke-width:1.8}
.frame{fill:none;stroke:#1a1a1a;stroke-width:1}
";

/// Writes a drawing of a contour image as SVG, the visible parts of polygons cut out exactly: each region of a polygon is one path of the class of its kind,
/// neighbouring cells merged; over them are the visible edges by kind, each stretch as long as it can be: silhouettes
/// (between a front and a back), borders (of one polygon), creases (where a surface turns, or where two materials meet),
/// and lines where polygons pass through each other.
///
/// Regions are stroked in their own colour, as wide at any scale, so that no viewer shows a gap between neighbours.
///
/// # Errors
/// Those of `out`.
pub fn write_drawing(
    image: &ContourImage,
    projector: &Projector,
    options: &DrawingOptions,
    out: impl Write,
) -> io::Result<DrawingCounts> {
    let mut out = BufWriter::new(out);
    let canvas = Canvas::new(projector, options.size);
    let size = canvas.size + 2.0 * MARGIN;
    open(size, &mut out)?;
    let eye = image.viewpoint().eye();
    writeln!(out, "<title>Drawing from ({}, {}, {})</title>", eye.x, eye.y, eye.z)?;
    writeln!(out, "<style>\n{STYLE}</style>")?;
    writeln!(out, r#"<clipPath id="picture"><path d="{}"/></clipPath>"#, canvas.border())?;
    paper(size, &mut out)?;
    writeln!(out, r#"<g clip-path="url(#picture)">"#)?;
    let mut counts = DrawingCounts { regions: fills(image, &canvas, options, &mut out)?, ..DrawingCounts::default() };
    let lines = Lines::new(image, &canvas, options, &mut counts);
    lines.write(&mut out)?;
    writeln!(out, "</g>")?;
    writeln!(out, r#"<path class="frame" d="{}"/>"#, canvas.border())?;
    writeln!(out, "</svg>")?;
    out.flush()?;
    Ok(counts)
}

/// The regions; gives how many there are.
fn fills(
    image: &ContourImage,
    canvas: &Canvas<'_>,
    options: &DrawingOptions,
    out: &mut impl Write,
) -> io::Result<usize> {
    let paint = Paint::new(image, canvas.projector.frame());
    let regions = canvas.projector.regions(image, canvas.tolerance());
    writeln!(out, r#"<g id="fills" stroke-width="1.2" fill-rule="evenodd">"#)?;
    for region in &regions {
        let mut data = PathData::default();
        for ring in std::iter::once(&region.exterior).chain(&region.holes) {
            data.add(ring.iter().map(|&p| canvas.place(p)), true);
        }
        if region.holes.is_empty() && !data.is_empty() {
            data.add_point();
        }
        let colour = match (options.fill, region.polygon) {
            (Fill::White, _) => "#ffffff".to_owned(),
            (Fill::Shaded, polygon) => paint.of(polygon),
            (Fill::Flat, None) => paint.of(None),
            (Fill::Flat, Some(polygon)) => {
                let material = image.scene().polygon(polygon).material();
                if material.is_emitter() { paint.of(region.polygon) } else { hex(DVec3::from(material.diffuse)) }
            }
        };
        write!(out, r#"<path fill="{colour}" stroke="{colour}" d="{data}""#)?;
        match region.polygon {
            None => writeln!(out, r#" class="background"/>"#)?,
            Some(id) => {
                let name = Escaped(image.scene().polygon(id).object_name());
                writeln!(out, r#" class="polygon_{id}"><title>polygon {id}, {name}</title></path>"#)?;
            }
        }
    }
    writeln!(out, "</g>")?;
    Ok(regions.len())
}

/// The lines of all kinds.
#[derive(Default)]
struct Lines {
    hidden: PathData,
    creases: PathData,
    crossings: PathData,
    borders: PathData,
    silhouettes: PathData,
}

impl Lines {
    fn new(image: &ContourImage, canvas: &Canvas<'_>, options: &DrawingOptions, counts: &mut DrawingCounts) -> Self {
        let mut lines = Self::default();
        let mut tracer = image.edge_tracer();
        for edge in (0..image.scene().edges().len() as u32).map(EdgeId) {
            let Some(kind) = kind(image, &tracer, edge, options.crease) else { continue };
            for stretch in tracer.trace(edge) {
                let (data, count) = match (kind, stretch.is_visible) {
                    (_, false) if !options.hidden => continue,
                    (_, false) => (&mut lines.hidden, &mut counts.hidden),
                    (Kind::Crease, true) => (&mut lines.creases, &mut counts.creases),
                    (Kind::Border, true) => (&mut lines.borders, &mut counts.borders),
                    (Kind::Silhouette, true) => (&mut lines.silhouettes, &mut counts.silhouettes),
                };
                *count += 1;
                add_arc(canvas, stretch.ends, data);
            }
        }
        for sides in image.regions().iter().flat_map(VisibleRegion::loops).map(RegionLoop::sides) {
            for (side, next) in sides.iter().zip(sides.iter().cycle().skip(1)) {
                // Both regions beside it have it.
                if side.is_crossing && side.inside == Sign::Positive {
                    counts.crossings += 1;
                    add_arc(canvas, [side.from, next.from], &mut lines.crossings);
                }
            }
        }
        lines
    }

    fn write(&self, out: &mut impl Write) -> io::Result<()> {
        for (class, data) in [
            ("hidden", &self.hidden),
            ("crossing", &self.crossings),
            ("crease", &self.creases),
            ("border", &self.borders),
            ("silhouette", &self.silhouettes),
        ] {
            if !data.is_empty() {
                writeln!(out, r#"<path class="{class}" d="{data}"/>"#)?;
            }
        }
        Ok(())
    }
}

fn add_arc(canvas: &Canvas<'_>, ends: [DVec3; 2], data: &mut PathData) {
    for line in canvas.projector.arc(ends, canvas.tolerance()) {
        data.add(line.into_iter().map(|p| canvas.place(p)), false);
    }
}

/// The kind of an edge; `None` for what is not drawn: edges inside of a polygon, and those where a surface of one material goes on smoothly.
fn kind(image: &ContourImage, tracer: &EdgeTracer<'_>, edge: EdgeId, crease: f64) -> Option<Kind> {
    let scene = image.scene();
    let pieces = tracer.pieces_beside(edge);
    let polygon = |piece: PieceId| scene.piece(piece).polygon();
    let &first = pieces.first()?;
    if pieces.iter().all(|&piece| polygon(piece) == polygon(first)) {
        return (pieces.len() == 1).then_some(Kind::Border);
    }
    let eye = image.viewpoint().eye();
    // None of what is seen edge on.
    let is_left = |piece: PieceId| {
        let shown = image.skeleton().shown_side(scene.piece(piece), eye)?;
        Some((shown == Side::Front) == runs_forward(scene, piece, edge))
    };
    let mut sides = pieces.iter().filter_map(|&piece| is_left(piece));
    let side = sides.next();
    if sides.all(|other| Some(other) == side) {
        return Some(Kind::Silhouette);
    }
    let &[a, b] = pieces else { return Some(Kind::Crease) };
    // Of a surface that is turned one way the two run along the edge in opposite ways.
    let is_turned = runs_forward(scene, a, edge) == runs_forward(scene, b, edge);
    let [n, m] = [a, b].map(|piece| normal(scene, piece));
    let cosine = if is_turned { -n.dot(m) } else { n.dot(m) };
    let differs = |a: PolygonId, b: PolygonId| scene.polygon(a).material_id() != scene.polygon(b).material_id();
    (cosine < crease.cos() || differs(polygon(a), polygon(b))).then_some(Kind::Crease)
}

/// True if the front of a piece has the edge run from its first vertex to its second.
fn runs_forward(scene: &Scene, piece: PieceId, edge: EdgeId) -> bool {
    let piece = scene.piece(piece);
    let at = piece.edges().iter().position(|&other| other == edge);
    at.is_some_and(|at| piece.vertices()[at] == scene.edges()[edge.index()][0])
}

/// The unit normal of a piece's front.
fn normal(scene: &Scene, piece: PieceId) -> DVec3 {
    let p: Vec<DVec3> = scene.piece(piece).points().collect();
    let size = p.iter().fold(0.0, |size: f64, &q| size.max((q - p[0]).abs().max_element()));
    let sum: DVec3 = (1..p.len() - 1).map(|k| ((p[k] - p[0]) / size).cross((p[k + 1] - p[0]) / size)).sum();
    sum.normalize_or_zero()
}

impl Canvas<'_> {
    /// The border of the picture, as a path.
    fn border(&self) -> PathData {
        let window = self.projector.window();
        let corners =
            [window.low, DVec2::new(window.high.x, window.low.y), window.high, DVec2::new(window.low.x, window.high.y)];
        let mut data = PathData::default();
        data.add(corners.map(|p| self.place(p)), true);
        data
    }
}
