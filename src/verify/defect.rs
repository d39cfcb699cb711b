//! What is wrong with a claimed contour image, and where.

use super::evidence::{Evidence, EvidenceDomain, EvidenceHorizon, EvidencePane};
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
        circle: Box<Splitter>,
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
                    Some(Splitter::Given(_) | Splitter::Points(_)) | None => {}
                }
            }
        }
        match self {
            Self::BehindSurface { piece } | Self::NotBackground { piece, .. } => pieces.extend([*piece]),
            Self::Hidden { by, .. } => pieces.extend([*by]),
            _ => {}
        }
        if let Some(EvidenceHorizon::Above(piece, _)) = evidence.domain.horizon() {
            pieces.insert(piece);
        }
        if let EvidenceDomain::Window { panes, .. } = &evidence.domain {
            let polygons = panes.iter().filter_map(|pane| match pane {
                EvidencePane::Polygon(polygon) if polygon.index() < scene.polygon_count() => Some(*polygon),
                EvidencePane::Polygon(_) | EvidencePane::Ring(_) => None,
            });
            pieces.extend(polygons.flat_map(|polygon| scene.polygon(polygon).pieces().map(PieceRef::id)));
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
        let horizon = evidence.domain.horizon().map(|horizon| match horizon {
            EvidenceHorizon::Normal(normal) => format!("the hemisphere about {}", point(normal)),
            EvidenceHorizon::Above(piece, side) if piece.index() < scene.piece_count() => {
                format!("above the {side:?} of polygon {}", scene.piece(piece).polygon())
            }
            EvidenceHorizon::Above(piece, side) => format!("above the {side:?} of piece {piece}, which does not exist"),
        });
        let domain = match &evidence.domain {
            EvidenceDomain::Frustum(normals) => format!("the frustum {}", normals.map(point).join(", ")),
            EvidenceDomain::Window { panes, .. } => {
                let panes = panes.iter().map(|pane| match pane {
                    EvidencePane::Polygon(polygon) => format!("polygon {polygon}"),
                    EvidencePane::Ring(ring) => {
                        format!("[{}]", ring.iter().map(|&p| point(p)).collect::<Vec<_>>().join(", "))
                    }
                });
                let panes = panes.collect::<Vec<_>>().join(", ");
                format!("the windows {panes} within {}", horizon.unwrap_or_else(|| "all directions".to_owned()))
            }
            _ => horizon.unwrap_or_else(|| "all directions".to_owned()),
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
        Splitter::Points([a, b]) => format!("through {} and {}", show(*a), show(*b)),
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
#[inline]
pub(super) fn rounded_crossing(normals: [DVec3; 2], signs: [Sign; 2]) -> DVec3 {
    let [a, b] = normals.map(DVec3::normalize_or_zero);
    let d = a.cross(b).normalize_or_zero();
    if signs[0] * signs[1] == Sign::Negative { -d } else { d }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Axis, Material, Side};
    use crate::verify::{EvidenceCell, HalfSphere};

    /// Two triangles of one vertex each off the plane z = 0, and a third one apart from both.
    fn three_triangles() -> Scene {
        let vertices = [
            [0.0, 0.0, 1.0],
            [1.0, 0.0, 1.0],
            [0.0, 1.0, 1.0],
            [1.0, 1.0, 1.5],
            [5.0, 5.0, 2.0],
            [6.0, 5.0, 2.0],
            [5.0, 6.0, 2.5],
        ];
        let faces = [vec![0, 1, 2], vec![2, 1, 3], vec![4, 5, 6]];
        Scene::builder().mesh(&vertices, &faces, Material::new("grey")).build().expect("three triangles")
    }

    fn edge(a: u32, b: u32) -> Splitter {
        Splitter::Edge([a, b].map(VertexId))
    }

    fn flat(a: u32, b: u32, c: u32) -> SupportingPlane {
        SupportingPlane::Points([a, b, c].map(VertexId))
    }

    /// Evidence of one cell of background, bounded by one splitter.
    fn bounded_by(splitter: Splitter) -> Evidence {
        Evidence {
            eye: DVec3::new(0.5, 0.25, 0.0),
            domain: EvidenceDomain::Sphere,
            epsilon: 0.0,
            slivers: Vec::new(),
            splitters: vec![splitter],
            cells: vec![EvidenceCell {
                piece: None,
                sides: vec![
                    HalfSphere { splitter: 0, inside: Sign::Positive },
                    HalfSphere { splitter: 9, inside: Sign::Positive },
                ],
            }],
        }
    }

    fn not_convex(cell: u32) -> Defect {
        Defect::NotConvex { cell, corner: 2, side: 1 }
    }

    fn unbalanced(circle: Splitter, cells: Vec<u32>) -> Defect {
        Defect::Unbalanced { circle: Box::new(circle), stretch: [DVec3::X, DVec3::Y], count: -1, expected: 1, cells }
    }

    #[test]
    fn every_defect_tells_its_rule_its_cells_and_where_it_is() {
        let (piece, by, towards) = (PieceId(4), PieceId(5), DVec3::new(0.5, -1.0, 0.0));
        let place = "splitter 3".to_owned();
        let all: [(Defect, Rule, &[u32], &str); 9] = [
            (
                Defect::Malformed { place, what: "a number is not finite" },
                Rule::Form,
                &[],
                "splitter 3: a number is not finite; the evidence is damaged, or was made for another scene",
            ),
            (
                Defect::BehindSurface { piece },
                Rule::Form,
                &[],
                "the eye lies behind piece 4, which it is said to be on",
            ),
            (
                not_convex(7),
                Rule::Convex,
                &[7],
                "cell 7 is not a convex cone: its corner 2 is not strictly inside of its side 1",
            ),
            (
                unbalanced(edge(3, 1), vec![2, 6]),
                Rule::Balance,
                &[2, 6],
                "there is a gap or an overlap from (1, 0, 0) to (0, 1, 0) along the great circle through vertices 3 and 1: \
                 the cells on its left less those on its right are -1, not 1; cells there: 2, 6",
            ),
            (
                Defect::Covered { direction: towards, cells: vec![8, 9], expected: 1 },
                Rule::Witness,
                &[8, 9],
                "direction (0.5, -1, 0) lies in 2 cells, not in 1: 8, 9",
            ),
            (Defect::EdgeOn { cell: 7, piece }, Rule::Cone, &[7], "cell 7 shows piece 4, which is seen edge-on"),
            (
                Defect::OutsideCone { cell: 7, piece, towards },
                Rule::Cone,
                &[7],
                "cell 7 reaches beyond an edge of piece 4, which it shows, towards (0.5, -1, 0)",
            ),
            (
                Defect::NotBackground { cell: 7, piece, towards },
                Rule::Cone,
                &[7],
                "cell 7 shows background where piece 4 is seen, towards (0.5, -1, 0)",
            ),
            (
                Defect::Hidden { cell: 7, piece, by, towards },
                Rule::Depth,
                &[7],
                "cell 7 shows piece 4, which piece 5 hides, towards (0.5, -1, 0)",
            ),
        ];
        for (defect, rule, cells, words) in all {
            assert_eq!(defect.rule(), rule, "{words}");
            assert_eq!(defect.cells(), cells, "{words}");
            assert_eq!(defect.to_string(), words);
        }
    }

    #[test]
    fn great_circles_are_named_by_what_they_are_defined_from() {
        let level = SupportingPlane::Axis { axis: Axis::Y, value: 2.5 };
        for (circle, words) in [
            (
                Splitter::Crease([level, flat(0, 1, 2)]),
                "along the great circle through the crease of plane y = 2.5 and the plane of vertices 0, 1 and 2: ",
            ),
            (Splitter::Given(DVec3::new(0.0, 0.5, -3.0)), "along the great circle with normal (0, 0.5, -3): "),
            (Splitter::Parallel(level), "along the great circle parallel to plane y = 2.5: "),
        ] {
            let message = unbalanced(circle, vec![]).to_string();
            assert!(message.contains(words), "{message}");
            assert!(message.ends_with("cells there: none"), "{message}");
        }
    }

    #[test]
    fn long_lists_of_cells_are_cut_short_and_say_so() {
        let lists = |n: u32| unbalanced(edge(0, 1), (0..n).collect()).to_string();
        assert!(lists(12).ends_with(": 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11"), "{}", lists(12));
        assert!(lists(13).ends_with(" 10, 11 and 1 more"), "{}", lists(13));
    }

    #[test]
    fn polygons_that_bound_a_cell_or_are_named_take_part() {
        const NONE: [u32; 0] = [];
        let scene = three_triangles();
        let level = SupportingPlane::Axis { axis: Axis::Z, value: 1.0 };
        let take_part = |splitter, defect: &Defect| {
            let polygons = defect.polygons(&bounded_by(splitter), &scene);
            polygons.into_iter().map(|polygon| polygon.0).collect::<Vec<_>>()
        };
        // The edge that two triangles share, whichever way; an edge of one; the planes of pieces.
        assert_eq!(take_part(edge(2, 1), &not_convex(0)), [0, 1]);
        assert_eq!(take_part(edge(1, 2), &not_convex(0)), [0, 1]);
        assert_eq!(take_part(edge(5, 4), &not_convex(0)), [2]);
        let planes = scene.planes();
        let plane = |polygon: u32| scene.pieces().find(|p| p.polygon().0 == polygon).expect("one piece each").plane();
        assert!(planes.contains(&plane(1)));
        assert_eq!(take_part(Splitter::Parallel(plane(2)), &not_convex(0)), [2]);
        assert_eq!(take_part(Splitter::Crease([plane(2), level]), &not_convex(0)), [2]);
        // A number names nothing in the scene; nor does a cell that does not exist.
        assert_eq!(take_part(Splitter::Given(DVec3::Z), &not_convex(0)), NONE);
        assert_eq!(take_part(edge(2, 1), &not_convex(1)), NONE);
        // What is in front, what is there, and what the eye is on; a piece that does not exist is left out.
        let (towards, given) = (DVec3::Z, Splitter::Given(DVec3::Z));
        let hidden = |by| Defect::Hidden { cell: 0, piece: PieceId(0), by, towards };
        assert_eq!(take_part(given, &hidden(PieceId(2))), [2]);
        assert_eq!(take_part(given, &hidden(PieceId(3))), NONE);
        assert_eq!(take_part(given, &Defect::NotBackground { cell: 0, piece: PieceId(1), towards }), [1]);
        assert_eq!(take_part(given, &Defect::BehindSurface { piece: PieceId(1) }), [1]);
        let mut evidence = bounded_by(given);
        evidence.domain = EvidenceDomain::Above(PieceId(2), Side::Back);
        assert_eq!(not_convex(0).polygons(&evidence, &scene), [PolygonId(2)]);
        evidence.cells[0].piece = Some(PieceId(0));
        assert_eq!(not_convex(0).polygons(&evidence, &scene), [PolygonId(0), PolygonId(2)]);
    }

    #[test]
    fn the_rust_text_holds_the_domain_the_eye_and_the_polygons() {
        let scene = three_triangles();
        let text = |domain| {
            let evidence = Evidence { domain, ..bounded_by(edge(4, 5)) };
            not_convex(0).to_rust(&evidence, &scene)
        };
        let triangle =
            "    &[DVec3::new(5.0, 5.0, 2.0), DVec3::new(6.0, 5.0, 2.0), DVec3::new(5.0, 6.0, 2.5)], // polygon 2\n";
        let whole = format!(
            "// {}\n// domain: all directions\n// epsilon: 0.0\nlet eye = DVec3::new(0.5, 0.25, 0.0);\n\
             let polygons: &[&[DVec3]] = &[\n{triangle}];\n",
            not_convex(0)
        );
        assert_eq!(text(EvidenceDomain::Sphere), whole);
        for (domain, words) in [
            (EvidenceDomain::Hemisphere(DVec3::Z), "// domain: the hemisphere about DVec3::new(0.0, 0.0, 1.0)\n"),
            (EvidenceDomain::Above(PieceId(2), Side::Back), "// domain: above the Back of polygon 2\n"),
            (
                EvidenceDomain::Above(PieceId(3), Side::Front),
                "// domain: above the Front of piece 3, which does not exist\n",
            ),
        ] {
            let text = text(domain);
            assert!(text.contains(words) && text.contains(triangle), "{text}");
        }
    }

    #[test]
    fn great_circles_cross_to_the_side_that_their_signs_say() {
        let normals = [DVec3::X * 3.0, DVec3::Y * 0.25];
        let crossing = |a, b| rounded_crossing(normals, [a, b]);
        assert_eq!(crossing(Sign::Positive, Sign::Positive), DVec3::Z);
        assert_eq!(crossing(Sign::Negative, Sign::Negative), DVec3::Z);
        assert_eq!(crossing(Sign::Negative, Sign::Positive), -DVec3::Z);
        assert_eq!(crossing(Sign::Positive, Sign::Negative), -DVec3::Z);
    }
}
