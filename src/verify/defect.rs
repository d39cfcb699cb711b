//! What is wrong with a claimed contour image, and where.

use super::evidence::{Evidence, EvidenceDomain};
use crate::exact::Sign;
use crate::scene::{PieceId, PieceRef, PolygonId, Scene, Splitter, SupportingPlane, VertexId};
use glam::DVec3;
use rustc_hash::FxHashSet;
use std::collections::BTreeSet;
use std::fmt::Write;

/// What a certificate proves, rule by rule (docs/verification.md).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Rule {
    /// What is claimed can be read at all: ids exist, numbers are finite.
    Form,
    /// A: every cell is a convex cone.
    Convex,
    /// B: the boundaries of the cells cancel, but for that of the domain.
    Balance,
    /// C: one direction lies in as many cells as it should.
    Witness,
    /// D: cells lie in the cone of what they show; background meets no cone.
    Cone,
    /// E: nothing is in front of what a cell shows.
    Depth,
}

/// The first defect found. Cells are numbered as in [`Evidence::cells`].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Defect {
    /// Something that is named does not exist, or is not finite.
    #[error("{place}: {what}; the evidence is damaged, or was made for another scene")]
    Malformed {
        /// Where.
        place: String,
        /// What is wrong.
        what: &'static str,
    },
    /// The eye lies behind the surface that it is said to be on.
    #[error("the eye lies behind piece {piece}, which it is said to be on")]
    BehindSurface {
        /// The surface.
        piece: PieceId,
    },
    /// A cell is not a convex cone (rule A).
    #[error("cell {cell} is not a convex cone: its corner {corner} is not strictly inside of its side {side}")]
    NotConvex {
        /// The cell.
        cell: u32,
        /// The corner where side `corner - 1` ends and side `corner` begins, of its sides without those that
        /// go on along the great circle of the one before.
        corner: u32,
        /// The side, numbered likewise.
        side: u32,
    },
    /// Along a stretch of a great circle the cells on the two sides do not balance (rule B).
    #[error(
        "there is a gap or an overlap from {} to {} along the great circle {}: the cells on its left less those on its \
         right are {count}, not {expected}; cells there: {}",
        show(stretch[0]), show(stretch[1]), show_circle(circle), list(cells)
    )]
    Unbalanced {
        /// The great circle; left is its positive side.
        circle: Splitter,
        /// From where to where, counter-clockwise about its normal; rounded.
        stretch: [DVec3; 2],
        /// Cells on the left less cells on the right.
        count: i64,
        /// What it should be: 0 but on the boundary of the domain.
        expected: i64,
        /// The cells with a side on that stretch.
        cells: Vec<u32>,
    },
    /// A direction lies in the wrong number of cells (rule C).
    #[error("direction {} lies in {} cells, not in {expected}: {}", show(*direction), cells.len(), list(cells))]
    Covered {
        /// The direction; exact.
        direction: DVec3,
        /// The cells it lies in.
        cells: Vec<u32>,
        /// In how many it should lie.
        expected: usize,
    },
    /// A cell shows a piece whose plane holds the eye (rule D).
    #[error("cell {cell} shows piece {piece}, which is seen edge-on")]
    EdgeOn {
        /// The cell.
        cell: u32,
        /// What it shows.
        piece: PieceId,
    },
    /// A cell reaches beyond what it shows (rule D).
    #[error("cell {cell} reaches beyond an edge of piece {piece}, which it shows, towards {}", show(*towards))]
    OutsideCone {
        /// The cell.
        cell: u32,
        /// What it shows.
        piece: PieceId,
        /// The corner that is outside; rounded.
        towards: DVec3,
    },
    /// A cell shows background where there is a polygon (rule D).
    #[error("cell {cell} shows background where piece {piece} is seen, towards {}", show(*towards))]
    NotBackground {
        /// The cell.
        cell: u32,
        /// What is there.
        piece: PieceId,
        /// A direction in which it is seen; rounded.
        towards: DVec3,
    },
    /// Something is in front of what a cell shows (rule E).
    #[error("cell {cell} shows piece {piece}, which piece {by} hides, towards {}", show(*towards))]
    Hidden {
        /// The cell.
        cell: u32,
        /// What it shows.
        piece: PieceId,
        /// What is in front of that.
        by: PieceId,
        /// A direction in which it is; rounded.
        towards: DVec3,
    },
}

impl Defect {
    /// The rule that is broken.
    pub fn rule(&self) -> Rule {
        match self {
            Self::Malformed { .. } | Self::BehindSurface { .. } => Rule::Form,
            Self::NotConvex { .. } => Rule::Convex,
            Self::Unbalanced { .. } => Rule::Balance,
            Self::Covered { .. } => Rule::Witness,
            Self::EdgeOn { .. } | Self::OutsideCone { .. } | Self::NotBackground { .. } => Rule::Cone,
            Self::Hidden { .. } => Rule::Depth,
        }
    }

    /// The cells that it names.
    pub fn cells(&self) -> &[u32] {
        match self {
            Self::Malformed { .. } | Self::BehindSurface { .. } => &[],
            Self::NotConvex { cell, .. }
            | Self::EdgeOn { cell, .. }
            | Self::OutsideCone { cell, .. }
            | Self::NotBackground { cell, .. }
            | Self::Hidden { cell, .. } => std::slice::from_ref(cell),
            Self::Unbalanced { cells, .. } | Self::Covered { cells, .. } => cells,
        }
    }

    /// The polygons that take part: what is seen in the cells it names, what bounds them, what is in front of
    /// them; ascending.
    pub fn polygons(&self, evidence: &Evidence, scene: &Scene) -> Vec<PolygonId> {
        let mut pieces = BTreeSet::new();
        let mut vertices: BTreeSet<VertexId> = BTreeSet::new();
        let mut note_plane = |plane: &SupportingPlane| match plane {
            SupportingPlane::Points(points) => vertices.extend(*points),
            SupportingPlane::Axis { .. } => {}
        };
        let mut edges = FxHashSet::default();
        for cell in self.cells().iter().filter_map(|&cell| evidence.cells.get(cell as usize)) {
            pieces.extend(cell.piece);
            for side in &cell.sides {
                match evidence.splitters.get(side.splitter as usize) {
                    Some(Splitter::Edge([a, b])) => {
                        edges.insert([*a.min(b), *a.max(b)]);
                    }
                    Some(Splitter::Crease(planes)) => planes.iter().for_each(&mut note_plane),
                    Some(Splitter::Parallel(plane)) => note_plane(plane),
                    Some(Splitter::Given(_)) | None => {}
                }
            }
        }
        match self {
            Self::BehindSurface { piece } | Self::NotBackground { piece, .. } => pieces.extend([*piece]),
            Self::Hidden { by, .. } => pieces.extend([*by]),
            _ => {}
        }
        if let EvidenceDomain::Above(piece, _) = evidence.domain {
            pieces.insert(piece);
        }
        let bounding = scene.pieces().filter(|piece| {
            let has_edge = piece.edges().iter().any(|edge| edges.contains(&scene.edges()[edge.index()]));
            has_edge || piece.plane().points().is_some_and(|points| points.iter().all(|v| vertices.contains(v)))
        });
        let named = pieces.iter().filter(|piece| piece.index() < scene.piece_count()).map(|&piece| scene.piece(piece));
        let polygons: BTreeSet<PolygonId> = bounding.chain(named).map(PieceRef::polygon).collect();
        polygons.into_iter().collect()
    }

    /// The eye and the polygons that take part as Rust, to paste into a test.
    pub fn to_rust(&self, evidence: &Evidence, scene: &Scene) -> String {
        let domain = match evidence.domain {
            EvidenceDomain::Sphere => "all directions".to_owned(),
            EvidenceDomain::Hemisphere(normal) => format!("the hemisphere about {}", point(normal)),
            EvidenceDomain::Above(piece, side) if piece.index() < scene.piece_count() => {
                format!("above the {side:?} of polygon {}", scene.piece(piece).polygon())
            }
            EvidenceDomain::Above(piece, side) => format!("above the {side:?} of piece {piece}, which does not exist"),
        };
        let mut text = format!("// {self}\n// domain: {domain}\n// epsilon: {:?}\n", evidence.epsilon);
        let _ = writeln!(text, "let eye = {};\nlet polygons: &[&[DVec3]] = &[", point(evidence.eye));
        for polygon in self.polygons(evidence, scene) {
            let polygon = scene.polygon(polygon);
            for ring in polygon.rings() {
                let corners: Vec<String> = ring.iter().map(|&v| point(scene.vertex(v))).collect();
                let _ = writeln!(text, "    &[{}], // polygon {}", corners.join(", "), polygon.id());
            }
        }
        text.push_str("];\n");
        text
    }
}

fn point(p: DVec3) -> String {
    format!("DVec3::new({:?}, {:?}, {:?})", p.x, p.y, p.z)
}

fn show(d: DVec3) -> String {
    format!("({}, {}, {})", d.x, d.y, d.z)
}

/// So many cells of a list are shown.
const LISTED: usize = 12;

fn list(cells: &[u32]) -> String {
    if cells.is_empty() {
        return "none".to_owned();
    }
    let shown: Vec<String> = cells.iter().take(LISTED).map(u32::to_string).collect();
    let more = cells.len() - shown.len();
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    shown.join(", ") + &more
}

fn show_circle(circle: &Splitter) -> String {
    match circle {
        Splitter::Edge([a, b]) => format!("through vertices {a} and {b}"),
        Splitter::Crease([p, q]) => format!("through the crease of {} and {}", show_plane(p), show_plane(q)),
        Splitter::Given(normal) => format!("with normal {}", show(*normal)),
        Splitter::Parallel(plane) => format!("parallel to {}", show_plane(plane)),
    }
}

fn show_plane(plane: &SupportingPlane) -> String {
    match plane {
        SupportingPlane::Axis { axis, value } => format!("plane {} = {value}", ["x", "y", "z"][*axis as usize]),
        SupportingPlane::Points([a, b, c]) => format!("the plane of vertices {a}, {b} and {c}"),
    }
}

/// The unit direction in which two half spheres' great circles cross, counter-clockwise from the first.
pub(super) fn rounded_crossing(normals: [DVec3; 2], signs: [Sign; 2]) -> DVec3 {
    let [a, b] = normals.map(DVec3::normalize_or_zero);
    let d = a.cross(b).normalize_or_zero();
    if signs[0] * signs[1] == Sign::Negative { -d } else { d }
}
