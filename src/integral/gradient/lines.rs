//! The lines of a scene behind the sides of visible regions.

use super::cells::{Cells, Stretch};
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
    cells: Cells,
}

/// An edge, and how its great circle is turned.
type Turned = (Edge, CircleRelation);

/// From an angle to another one, and the edge that is seen there.
type Along = ([f64; 2], Option<Turned>);

/// A part of a side of a region, from an angle to another one counted from the side's start, and the line behind it.
pub(super) struct Part {
    pub(super) line: Line,
    pub(super) angles: [f64; 2],
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
        let mut lines = Self { image, kernel, horizon, edges: Vec::new(), cells: Cells::default() };
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

    /// Refuses eyes in the planes of polygons that reach above the horizon, unless they are hidden.
    pub(super) fn check_edge_on(&mut self, normal: DVec3) -> Result<(), GradientError> {
        let image = self.image;
        let scene = image.scene();
        let eye = image.viewpoint().eye();
        for piece in scene.pieces() {
            if image.skeleton().position_side(piece.plane_id(), eye) != Sign::Zero
                || piece.points().all(|p| normal.dot(p - eye) <= 0.0)
            {
                continue;
            }
            let circle = exact::Splitter::Parallel(scene.resolve_plane(piece.plane()));
            if self.is_horizon(&circle) {
                continue;
            }
            let points: Vec<DVec3> = piece.points().collect();
            let circle = rough_normal(&circle, eye).normalize_or_zero();
            let stretch = Stretch::around(circle, points.iter().map(|&p| p - eye));
            if !self.cells.hide(image, &points, &stretch) {
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

    /// Refuses eyes from which edges on different lines are in line, unless one is hidden where they are: else it may come out from behind the other.
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
                if let Some(pair) = self.seen_in_line(&group) {
                    let edges = pair.map(|edge| self.image.scene().edges()[edge.id.index()]);
                    return Err(GradientError::InLine { edges });
                }
            }
        }
        self.edges = edges;
        Ok(())
    }

    /// A pair of edges of one great circle, on different lines, that overlap where neither is hidden.
    fn seen_in_line<'e>(&mut self, group: &[&'e Edge]) -> Option<[&'e Edge; 2]> {
        let normal = group[0].normal;
        let spans: Vec<(f64, f64)> = group.iter().map(|edge| edge.span(normal, group[0].ends[0])).collect();
        // Those that are hidden all along are out; few are left then.
        let mut seen = Vec::new();
        for k in 0..group.len() {
            let is_in_line = |j: usize| group[j].line != group[k].line && !overlaps(spans[k], spans[j]).is_empty();
            if (0..group.len()).any(is_in_line) && !self.is_hidden(group[k], normal, group[0].ends[0], spans[k]) {
                seen.push(k);
            }
        }
        for (n, &k) in seen.iter().enumerate() {
            for &j in seen[..n].iter().filter(|&&j| group[j].line != group[k].line) {
                for both in overlaps(spans[k], spans[j]) {
                    let [one, other] = [k, j].map(|k| self.is_hidden(group[k], normal, group[0].ends[0], both));
                    if !one && !other {
                        return Some([group[j], group[k]]);
                    }
                }
            }
        }
        None
    }

    /// True if an edge is hidden along a span of its great circle, which is counted about a normal from a unit direction.
    fn is_hidden(&mut self, edge: &Edge, normal: DVec3, zero: DVec3, (start, length): (f64, f64)) -> bool {
        let [from, to] = [start, start + length].map(|angle| zero * angle.cos() + normal.cross(zero) * angle.sin());
        let scene = self.image.scene();
        let points = scene.edges()[edge.id.index()].map(|v| scene.vertex(v));
        self.cells.hide(self.image, &points, &Stretch::between(normal, from, to))
    }

    /// The lines behind a side, which may be several one after the other; none if it does not move, or where that does not count.
    pub(super) fn behind(&mut self, side: &RegionSide, polygon: Option<PolygonId>) -> Result<Vec<Part>, GradientError> {
        let eye = self.image.viewpoint().eye();
        let circle = self.image.scene().resolve_splitter(side.splitter);
        if self.is_horizon(&circle) {
            return Ok(Vec::new());
        }
        // Where no edge is, it is what the great circle is named for.
        let rest = match circle {
            exact::Splitter::Edge([a, b]) => Some(((a - eye).cross(b - a), b - a)),
            // h2 N1 - h1 N2 changes by (N2.dr) N1 - (N1.dr) N2 = (N2 x N1) x dr.
            exact::Splitter::Crease(planes) => {
                let [n1, n2] = planes.map(plane_normal);
                Some((rough_normal(&circle, eye), n2.cross(n1)))
            }
            _ => None,
        };
        let sign = if side.inside == Sign::Negative { -1.0 } else { 1.0 };
        let line = |(normal, along): (DVec3, DVec3), sign: f64| Line { inward: normal * sign, along: along * sign };
        let mut parts = Vec::new();
        for (angles, edge) in self.edges_along(side, &circle)? {
            let line = match edge {
                None => line(rest.ok_or(GradientError::Unknown { polygon })?, sign),
                Some((edge, relation)) => {
                    let exact::Splitter::Edge([a, b]) = self.splitter(&edge) else { continue };
                    let same = if relation == CircleRelation::Opposite { -sign } else { sign };
                    line(((a - eye).cross(b - a), b - a), same)
                }
            };
            parts.push(Part { line, angles });
        }
        Ok(parts)
    }

    /// A side cut where edges on its great circle begin and end, with the one that is seen along each part, if there is one, and how its great circle is turned.
    fn edges_along(&mut self, side: &RegionSide, circle: &exact::Splitter) -> Result<Vec<Along>, GradientError> {
        // A great circle may have the name of an axis or of another edge.
        let normal = rough_normal(circle, self.image.viewpoint().eye()).normalize_or_zero();
        let key = normal.dot(AXIS).abs();
        let inward = if side.inside == Sign::Negative { -normal } else { normal };
        let whole = (0.0, side.length);
        let first = self.edges.partition_point(|edge| edge.key < key - NEAR);
        let mut along: Vec<(Turned, Vec<(f64, f64)>)> = Vec::new();
        for k in first..self.edges.len() {
            let edge = self.edges[k];
            if edge.key > key + NEAR {
                break;
            }
            if edge.normal.cross(normal).length() < NEAR {
                let spans = overlaps(whole, edge.span(inward, side.from));
                let relation = self.kernel.compare_circles(circle, &self.splitter(&edge));
                if !spans.is_empty() && relation != CircleRelation::Different {
                    along.push(((edge, relation), spans));
                }
            }
        }
        let ends =
            along.iter().flat_map(|(_, spans)| spans.iter().flat_map(|&(start, length)| [start, start + length]));
        let mut cuts: Vec<f64> = ends.chain([0.0, side.length]).collect();
        cuts.sort_by(f64::total_cmp);
        let mut parts: Vec<Along> = Vec::new();
        for ends in cuts.windows(2) {
            let [from, to] = [ends[0], ends[1]];
            if to - from <= 0.0 {
                continue;
            }
            let part = (from, to - from);
            let middle = 0.5 * (from + to);
            let covers =
                |spans: &[(f64, f64)]| spans.iter().any(|&(start, length)| start < middle && middle < start + length);
            let mut here: Vec<Turned> =
                along.iter().filter(|(_, spans)| covers(spans)).map(|&(edge, _)| edge).collect();
            // Of edges on different lines all but one are hidden, or are in line on a stretch that is nothing but rounding.
            if part.1 > SHORTEST && here.iter().any(|(edge, _)| edge.line != here[0].0.line) {
                here.retain(|(edge, _)| !self.is_hidden(edge, inward, side.from, part));
                if let Some(&(other, _)) = here.iter().find(|(edge, _)| edge.line != here[0].0.line) {
                    let edges = [here[0].0, other].map(|edge| self.image.scene().edges()[edge.id.index()]);
                    return Err(GradientError::InLine { edges });
                }
            }
            let edge = here.first().copied();
            match parts.last_mut() {
                Some((angles, known)) if known.map(|(edge, _)| edge.line) == edge.map(|(edge, _)| edge.line) => {
                    angles[1] = to;
                }
                _ => parts.push(([from, to], edge)),
            }
        }
        Ok(parts)
    }
}

impl Edge {
    /// Where it starts, and its length, on its great circle, counted about a unit normal from a unit direction on it.
    fn span(&self, normal: DVec3, zero: DVec3) -> (f64, f64) {
        let ahead = normal.cross(zero);
        span(self.ends.map(|p| p.dot(ahead).atan2(p.dot(zero))))
    }
}

/// Where a span lies over more than a point of another one, in turns of the first.
fn overlaps(one: (f64, f64), other: (f64, f64)) -> Vec<(f64, f64)> {
    let turned = [-TAU, 0.0, TAU].map(|turn| {
        let start = one.0.max(other.0 + turn);
        (start, (one.0 + one.1).min(other.0 + turn + other.1) - start)
    });
    turned.into_iter().filter(|&(_, length)| length > SHORTEST).collect()
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
