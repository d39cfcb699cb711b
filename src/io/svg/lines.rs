//! What is drawn over the colours: outlines, the contour tree, its legend.

use super::paint::Paint;
use super::{Canvas, PathData};
use crate::bsp::{LineDef, LineId};
use crate::contour::{Cell, ContourImage, Location, Splitter};
use crate::scene::{PieceRef, PolygonId, VertexId};
use glam::{DVec2, DVec3};
use std::collections::HashSet;
use std::io::{self, Write};

pub(super) const STYLE: &str = "\
.outline,.seam,.given,.edge,.crease,.horizon,.border{fill:none;stroke-linecap:round;stroke-linejoin:round}
.outline{stroke:#222;stroke-width:.7}
.seam{stroke:#222;stroke-width:.35;stroke-opacity:.5}
.border{stroke:#222;stroke-width:1.2}
.given{stroke:#1f6fd0;stroke-width:.8;stroke-dasharray:5 3}
.edge{stroke:#c62828;stroke-width:.6}
.crease{stroke:#1b8a3a;stroke-width:1;stroke-dasharray:2 2}
.horizon{stroke:#7b1fa2;stroke-width:2.4}
.legend{font:13px sans-serif;fill:#222}
";

/// How the kinds of splitters are called: class and words.
const KINDS: [(&str, &str); 4] = [
    ("given", "quadtree, or end of the domain"),
    ("edge", "edge of a polygon"),
    ("crease", "crease of two planes"),
    ("horizon", "horizon of a surface"),
];

fn kind(splitter: &Splitter) -> usize {
    match splitter {
        Splitter::Given(_) => 0,
        Splitter::Edge(_) | Splitter::Points(_) => 1,
        Splitter::Crease(_) => 2,
        Splitter::Parallel(_) => 3,
    }
}

/// Lines where another polygon begins: thin ones between polygons that look the same, so that finely
/// meshed surfaces stay light.
pub(super) fn outlines(
    image: &ContourImage,
    canvas: &Canvas<'_>,
    paint: &Paint<'_>,
    out: &mut impl Write,
) -> io::Result<()> {
    let own = own_edges(image);
    let [mut outline, mut seam] = [PathData::default(), PathData::default()];
    for cell in image.cells() {
        let Some(polygon) = cell.polygon() else { continue };
        let corners: Vec<DVec3> = cell.boundary().collect();
        for (k, (splitter, _)) in cell.splitters().enumerate() {
            let ends = [corners[k], corners[(k + 1) % corners.len()]];
            let may_end = match splitter {
                Splitter::Edge(edge) => own.contains(&(polygon, edge)),
                Splitter::Crease(_) => true,
                Splitter::Given(_) | Splitter::Points(_) | Splitter::Parallel(_) => false,
            };
            let Some(other) = (if may_end { across(cell, ends) } else { None }) else { continue };
            if other.polygon() != Some(polygon) {
                let same = paint.of(other.polygon()) == paint.of(Some(polygon));
                add_arc(canvas, ends, if same { &mut seam } else { &mut outline });
            }
        }
    }
    write_path("seam", &seam, out)?;
    write_path("outline", &outline, out)
}

fn add_arc(canvas: &Canvas<'_>, ends: [DVec3; 2], data: &mut PathData) {
    for line in canvas.projector.arc(ends, canvas.tolerance()) {
        data.add(line.into_iter().map(|p| canvas.place(p)), false);
    }
}

fn write_path(class: &str, data: &PathData, out: &mut impl Write) -> io::Result<()> {
    if data.is_empty() { Ok(()) } else { writeln!(out, r#"<path class="{class}" d="{data}"/>"#) }
}

/// The lines that the edges of visible polygons are part of, each by the edge that stands for it. A
/// polygon is not seen beyond its own edge; where another one hides it, that one's edge is drawn.
fn own_edges(image: &ContourImage) -> HashSet<(PolygonId, [VertexId; 2])> {
    let scene = image.scene();
    let skeleton = image.skeleton();
    let visible: HashSet<PolygonId> = image.cells().filter_map(Cell::polygon).collect();
    let edges = visible.into_iter().flat_map(|id| {
        let edges = scene.polygon(id).pieces().flat_map(PieceRef::edges);
        edges.filter_map(move |edge| match skeleton.line(skeleton.representative(LineId(edge.0)).0) {
            LineDef::Edge(ends) => Some((id, ends)),
            LineDef::Crease(_) => None,
        })
    });
    edges.collect()
}

/// The cell just across the middle of a side; `None` if the domain ends there.
fn across(cell: Cell<'_>, [a, b]: [DVec3; 2]) -> Option<Cell<'_>> {
    let outwards = b.cross(a).normalize_or_zero();
    match cell.image().locate((a + b).normalize_or_zero() + outwards * 1e-7) {
        Location::Cell(other) => Some(cell.image().cell(other)),
        Location::Arc { .. } | Location::Vertex { .. } | Location::Outside => None,
    }
}

/// The arcs of the contour tree, a path for every kind of splitter.
pub(super) fn tree(image: &ContourImage, canvas: &Canvas<'_>, out: &mut impl Write) -> io::Result<()> {
    let mut data: [PathData; 4] = Default::default();
    for arc in image.tree_arcs() {
        add_arc(canvas, arc.ends, &mut data[kind(&arc.splitter)]);
    }
    writeln!(out, r#"<g id="tree">"#)?;
    for ((class, _), data) in KINDS.iter().zip(&data) {
        write_path(class, data, out)?;
    }
    writeln!(out, "</g>")
}

/// A row of samples of the lines of [`tree`].
pub(super) fn legend(at: DVec2, out: &mut impl Write) -> io::Result<()> {
    writeln!(out, r#"<g id="legend">"#)?;
    let mut x = at.x;
    for (class, words) in KINDS {
        writeln!(
            out,
            r#"<path class="{class}" d="M{x},{y} {},{y}"/><text class="legend" x="{}" y="{}">{words}</text>"#,
            x + 30.0,
            x + 38.0,
            at.y + 4.0,
            y = at.y
        )?;
        // Wide fonts take 7.4 a letter at that size.
        x += 60.0 + 7.4 * words.len() as f64;
    }
    writeln!(out, "</g>")
}
