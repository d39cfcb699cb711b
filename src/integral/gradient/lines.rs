//! The lines of a scene behind the sides of visible regions.

use super::{GradientError, Line};
use crate::bsp::LineId;
use crate::contour::{ContourImage, Horizon, RegionSide, Splitter};
use crate::exact::{self, CircleRelation, Kernel, Plane, Sign};
use crate::scene::{EdgeId, PieceRef, PolygonId, Shape, VertexId};
use glam::DVec3;
use std::collections::HashSet;
use std::f64::consts::TAU;

/// All lines that may bound a region, and exact answers about them.
pub(super) struct Lines<'a> {
    image: &'a ContourImage,
    kernel: Kernel,
    horizon: exact::Splitter,
    /// Ascending by key.
    edges: Vec<Edge>,
}

/// An edge that ends a polygon, or folds it, and that is on the horizon at most with an end.
#[derive(Clone, Copy)]
struct Edge {
    /// The cosine of its great circle's normal with a fixed axis, without its sign: the same for the same great circle, but for rounding.
    key: f64,
    id: EdgeId,
    /// Equal for edges on one line.
    line: LineId,
    /// Of its great circle.
    normal: DVec3,
    /// Unit directions to its ends.
    ends: [DVec3; 2],
}

/// Any axis that great circles of scenes do not know.
const AXIS: DVec3 = DVec3::new(0.541_196_1, 0.306_562_96, 0.783_036_4);
/// Great circles with keys as near as that are compared exactly. Rounding moves the normal of an edge seen under 1e-6 radian or more by less.
const NEAR: f64 = 1e-9;
/// What is shorter is no overlap, as ends are rounded.
const SHORTEST: f64 = 1e-9;

impl<'a> Lines<'a> {
    /// `None` if there is no horizon.
    pub(super) fn new(image: &'a ContourImage, normal: DVec3) -> Option<Self> {
        let scene = image.scene();
        let horizon = match image.domain().horizon()? {
            Horizon::Normal(normal) => exact::Splitter::Given(normal),
            Horizon::Surface => {
                let (piece, _) = image.viewpoint().surface_piece()?;
                scene.resolve_splitter(Splitter::Parallel(scene.piece(piece).plane()))
            }
        };
        let kernel = Kernel::new(scene.vertices().iter().copied(), image.viewpoint().eye());
        let mut lines = Self { image, kernel, horizon, edges: Vec::new() };
        let ends = lines.ends_of_polygons();
        let edges = ends.into_iter().filter_map(|id| lines.edge(id, normal));
        lines.edges = edges.collect();
        lines.edges.sort_by(|a, b| a.key.total_cmp(&b.key).then(a.id.cmp(&b.id)));
        Some(lines)
    }

    /// The edges where polygons end. Where one is not planar, those between its triangles too.
    fn ends_of_polygons(&self) -> Vec<EdgeId> {
        let scene = self.image.scene();
        let mut is_end = vec![false; scene.edges().len()];
        for polygon in scene.polygons() {
            let pairs = polygon.rings().iter().flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)));
            let ends: HashSet<[VertexId; 2]> = pairs.map(|(&a, &b)| [a.min(b), a.max(b)]).collect();
            for &edge in polygon.pieces().flat_map(PieceRef::edges) {
                let is_fold = polygon.shape() == Shape::NonPlanar;
                is_end[edge.index()] |= is_fold || ends.contains(&scene.edges()[edge.index()]);
            }
        }
        (0..is_end.len() as u32).filter(|&k| is_end[k as usize]).map(EdgeId).collect()
    }

    /// `None` for an edge below the horizon, along it, or seen end-on, which is no arc.
    fn edge(&mut self, id: EdgeId, up: DVec3) -> Option<Edge> {
        let points = self.image.scene().edges()[id.index()].map(|v| self.image.scene().vertex(v));
        let [a, b] = points.map(|p| p - self.image.viewpoint().eye());
        if a.dot(up) <= 0.0 && b.dot(up) <= 0.0 {
            return None;
        }
        let normal = a.cross(b - a).try_normalize()?;
        if normal.dot(up).abs() > 1.0 - NEAR && self.is_horizon(&exact::Splitter::Edge(points)) {
            return None;
        }
        let line = self.image.skeleton().representative(LineId(id.0)).0;
        Some(Edge { key: normal.dot(AXIS).abs(), id, line, normal, ends: [a.normalize(), b.normalize()] })
    }

    fn splitter(&self, edge: &Edge) -> exact::Splitter {
        exact::Splitter::Edge(self.image.scene().edges()[edge.id.index()].map(|v| self.image.scene().vertex(v)))
    }

    fn is_horizon(&mut self, circle: &exact::Splitter) -> bool {
        self.kernel.compare_circles(circle, &self.horizon) != CircleRelation::Different
    }

    /// Refuses eyes in the planes of polygons that reach above the horizon.
    pub(super) fn check_edge_on(&mut self, normal: DVec3) -> Result<(), GradientError> {
        let scene = self.image.scene();
        let eye = self.image.viewpoint().eye();
        for piece in scene.pieces() {
            if self.image.skeleton().position_side(piece.plane_id(), eye) == Sign::Zero
                && piece.points().any(|p| normal.dot(p - eye) > 0.0)
                && !self.is_horizon(&exact::Splitter::Parallel(scene.resolve_plane(piece.plane())))
            {
                return Err(GradientError::EdgeOn { polygon: piece.polygon() });
            }
        }
        Ok(())
    }

    fn are_one_circle(&mut self, one: &Edge, other: &Edge) -> bool {
        let circles = [one, other].map(|edge| self.splitter(edge));
        one.normal.cross(other.normal).length() < NEAR
            && (one.line == other.line
                || self.kernel.compare_circles(&circles[0], &circles[1]) != CircleRelation::Different)
    }

    /// Refuses eyes from which edges on different lines are in line: one may come out from behind the other, be it visible now or not.
    pub(super) fn check_in_line(&mut self) -> Result<(), GradientError> {
        let edges = std::mem::take(&mut self.edges);
        for near in edges.chunk_by(|a, b| b.key - a.key < NEAR).filter(|near| near.len() > 1) {
            // By great circle.
            let mut groups: Vec<Vec<&Edge>> = Vec::new();
            for edge in near {
                let known = groups.iter_mut().find(|group| self.are_one_circle(group[0], edge));
                match known {
                    Some(group) => group.push(edge),
                    None => groups.push(vec![edge]),
                }
            }
            for group in groups {
                if let Some(pair) = overlapping(&group) {
                    let edges = pair.map(|edge| self.image.scene().edges()[edge.id.index()]);
                    return Err(GradientError::InLine { edges });
                }
            }
        }
        self.edges = edges;
        Ok(())
    }

    /// The line behind a side; `None` if it does not move, or where that does not count.
    pub(super) fn behind(
        &mut self,
        side: &RegionSide,
        polygon: Option<PolygonId>,
    ) -> Result<Option<Line>, GradientError> {
        let eye = self.image.viewpoint().eye();
        let circle = self.image.scene().resolve_splitter(side.splitter);
        if self.is_horizon(&circle) {
            return Ok(None);
        }
        let (normal, along, relation) = match (self.edge_along(side, &circle), circle) {
            (Some((edge, relation)), _) => {
                let exact::Splitter::Edge([a, b]) = self.splitter(&edge) else { return Ok(None) };
                ((a - eye).cross(b - a), b - a, relation)
            }
            (None, exact::Splitter::Edge([a, b])) => ((a - eye).cross(b - a), b - a, CircleRelation::Same),
            // h2 N1 - h1 N2 changes by (N2.dr) N1 - (N1.dr) N2 = (N2 x N1) x dr.
            (None, exact::Splitter::Crease(planes)) => {
                let [n1, n2] = planes.map(plane_normal);
                (rough_normal(&circle, eye), n2.cross(n1), CircleRelation::Same)
            }
            (None, _) => return Err(GradientError::Unknown { polygon }),
        };
        let same = if relation == CircleRelation::Opposite { -1.0 } else { 1.0 };
        let sign = if side.inside == Sign::Negative { -same } else { same };
        Ok(Some(Line { inward: normal * sign, along: along * sign }))
    }

    /// An edge on the great circle of a side that overlaps it, and how its great circle is turned. Of those in line all are on one line.
    fn edge_along(&mut self, side: &RegionSide, circle: &exact::Splitter) -> Option<(Edge, CircleRelation)> {
        // A great circle may have the name of an axis or of another edge.
        let normal = rough_normal(circle, self.image.viewpoint().eye()).normalize_or_zero();
        let key = normal.dot(AXIS).abs();
        let first = self.edges.partition_point(|edge| edge.key < key - NEAR);
        let inward = if side.inside == Sign::Negative { -normal } else { normal };
        let ahead = inward.cross(side.from);
        for k in first..self.edges.len() {
            let edge = self.edges[k];
            if edge.key > key + NEAR {
                break;
            }
            if edge.normal.cross(normal).length() < NEAR && lies_over(&edge, side.from, ahead, side.length) {
                let relation = self.kernel.compare_circles(circle, &self.splitter(&edge));
                if relation != CircleRelation::Different {
                    return Some((edge, relation));
                }
            }
        }
        None
    }
}

/// A pair of edges of one great circle, on different lines, that overlap.
fn overlapping<'e>(group: &[&'e Edge]) -> Option<[&'e Edge; 2]> {
    let normal = group[0].normal;
    let (x, y) = (group[0].ends[0], normal.cross(group[0].ends[0]));
    let angle = |p: DVec3| p.dot(y).atan2(p.dot(x));
    let mut spans: Vec<(f64, f64, &Edge)> = Vec::new();
    for edge in group {
        let (start, length) = span(edge.ends.map(angle));
        // Twice around, so that what lies over the seam meets all that it should.
        spans.extend([0.0, TAU].map(|turn| (start + turn, start + turn + length, *edge)));
    }
    spans.sort_by(|a, b| a.0.total_cmp(&b.0));
    // The one that reaches farthest so far, and the one on another line that does.
    let mut far: [Option<(f64, &Edge)>; 2] = [None; 2];
    for (start, end, edge) in spans {
        for (reach, other) in far.into_iter().flatten() {
            if other.line != edge.line && reach.min(end) - start > SHORTEST {
                return Some([other, edge]);
            }
        }
        match far[0] {
            Some((reach, other)) if reach >= end => {
                if other.line != edge.line && far[1].is_none_or(|(reach, _)| reach < end) {
                    far[1] = Some((end, edge));
                }
            }
            Some((_, other)) => {
                if other.line != edge.line {
                    far[1] = far[0];
                }
                far[0] = Some((end, edge));
            }
            None => far[0] = Some((end, edge)),
        }
    }
    None
}

/// True if an edge lies over more than a point of an arc on its great circle, of that length, that starts at a point and goes ahead from there.
fn lies_over(edge: &Edge, from: DVec3, ahead: DVec3, length: f64) -> bool {
    let place = |p: DVec3| p.dot(ahead).atan2(p.dot(from));
    let (start, size) = span(edge.ends.map(place));
    [-TAU, 0.0, TAU].iter().any(|turn| (start + size + turn).min(length) - (start + turn).max(0.0) > SHORTEST)
}

/// Where the shorter way between two angles starts, and its length.
fn span([a, b]: [f64; 2]) -> (f64, f64) {
    let length = (b - a).rem_euclid(TAU);
    if length <= TAU / 2.0 { (a, length) } else { (b, TAU - length) }
}

/// The normal of a splitter in floating point.
fn rough_normal(splitter: &exact::Splitter, eye: DVec3) -> DVec3 {
    match *splitter {
        exact::Splitter::Edge([a, b]) => (a - eye).cross(b - a),
        exact::Splitter::Crease(planes) => {
            let [n1, n2] = planes.map(plane_normal);
            let [h1, h2] = planes.map(|plane| plane_normal(plane).dot(eye - plane_point(plane)));
            n1 * h2 - n2 * h1
        }
        exact::Splitter::Given(normal) => normal,
        exact::Splitter::Parallel(plane) => plane_normal(plane),
    }
}

fn plane_normal(plane: Plane) -> DVec3 {
    match plane {
        Plane::Axis { axis, .. } => DVec3::AXES[axis],
        Plane::Points([a, b, c]) => (b - a).cross(c - a),
    }
}

fn plane_point(plane: Plane) -> DVec3 {
    match plane {
        Plane::Axis { axis, value } => DVec3::AXES[axis] * value,
        Plane::Points([a, ..]) => a,
    }
}
