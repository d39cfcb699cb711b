//! Planes, lines and points by exact definition: those of the scene and those that splits made.
//!
//! A constructed point is never just rounded coordinates: it is an edge cut by a plane, or three
//! planes. Fragments that share a line or a point share its id, so that the most frequent zeros
//! are known by identity.

use super::collinear::Collinear;
use crate::exact::{Approx3, Arena, Ball, BitRange, Frame, Num, Num3, Sign, U, orient3d};
use crate::scene::{Axis, PlaneId, Scene, SupportingPlane, VertexId};
use glam::DVec3;
use rustc_hash::FxHashMap;

/// A point: scene vertices first, under their own numbers, then constructed ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct PointId(pub(crate) u32);

/// A line: scene edges first, under their own numbers, then creases.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct LineId(pub(crate) u32);

/// What a point is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum PointDef {
    /// A vertex of the scene.
    Vertex(VertexId),
    /// Where an edge of the scene, from one vertex to another, crosses a plane that separates them.
    EdgePlane([VertexId; 2], PlaneId),
    /// Where three planes meet.
    Planes([PlaneId; 3]),
}

/// What a line is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum LineDef {
    /// Through two vertices of the scene, in the order of their numbers.
    Edge([VertexId; 2]),
    /// Where two planes meet, in the order of their numbers.
    Crease([PlaneId; 2]),
}

/// A position with a bound on the error of each coordinate; 0 where a coordinate is exact.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ApproxPoint {
    pub(crate) position: DVec3,
    pub(crate) err: DVec3,
}

/// A plane in floating point: `normal . (p - anchor)` is the height of `p` times a positive number.
#[derive(Clone, Copy, Debug)]
struct ApproxPlane {
    normal: Approx3,
    anchor: DVec3,
}

const NO_LINE: u32 = u32::MAX;

#[derive(Clone, Debug)]
pub(crate) struct Skeleton {
    pub(crate) bits: BitRange,
    vertices: Vec<DVec3>,
    planes: Vec<SupportingPlane>,
    approx_planes: Vec<ApproxPlane>,
    axis_planes: FxHashMap<(Axis, u64), PlaneId>,
    edges: Vec<[VertexId; 2]>,
    collinear: Collinear,
    /// The lines through each vertex, one vertex after the other, and where each begins.
    vertex_lines: Vec<LineId>,
    vertex_lines_start: Vec<u32>,
    creases: Vec<[PlaneId; 2]>,
    crease_ids: FxHashMap<[PlaneId; 2], LineId>,
    constructed: Vec<PointDef>,
    constructed_ids: FxHashMap<PointDef, PointId>,
    approx_points: Vec<ApproxPoint>,
    /// Up to four lines that a constructed point is known to lie on.
    incident: Vec<[u32; 4]>,
    /// The scene's own frame, for decisions that no viewpoint takes part in.
    frame: Frame,
}

impl Skeleton {
    pub(crate) fn new(scene: &Scene) -> Self {
        let bits = BitRange::of(scene.vertices().iter().copied());
        let origin = scene.vertices().first().copied().unwrap_or_default();
        let frame = Frame::new(bits, origin);
        let collinear = Collinear::new(scene.vertices(), scene.edges(), &frame);
        let (vertex_lines, vertex_lines_start) = lines_through_vertices(scene, &collinear);
        let mut skeleton = Self {
            bits,
            collinear,
            vertex_lines,
            vertex_lines_start,
            vertices: scene.vertices().to_vec(),
            planes: Vec::new(),
            approx_planes: Vec::new(),
            axis_planes: FxHashMap::default(),
            edges: scene.edges().to_vec(),
            creases: Vec::new(),
            crease_ids: FxHashMap::default(),
            constructed: Vec::new(),
            constructed_ids: FxHashMap::default(),
            approx_points: scene
                .vertices()
                .iter()
                .map(|&position| ApproxPoint { position, err: DVec3::ZERO })
                .collect(),
            incident: Vec::new(),
            frame,
        };
        for &plane in scene.planes() {
            skeleton.push_plane(plane);
        }
        skeleton
    }

    fn push_plane(&mut self, plane: SupportingPlane) -> PlaneId {
        let id = PlaneId(self.planes.len() as u32);
        self.planes.push(plane);
        self.approx_planes.push(match plane {
            SupportingPlane::Axis { axis, value } => {
                self.axis_planes.insert((axis, value.to_bits()), id);
                let mut anchor = DVec3::ZERO;
                anchor[axis as usize] = value;
                ApproxPlane { normal: Approx3::given(DVec3::AXES[axis as usize]), anchor }
            }
            SupportingPlane::Points([a, b, c]) => {
                let [a, b, c] = [a, b, c].map(|v| self.vertices[v.index()]);
                ApproxPlane { normal: Approx3::edge_normal(a, b, c), anchor: a }
            }
        });
        id
    }

    /// The axis-aligned plane, made if there is none yet. `value` must be a coordinate of a vertex,
    /// so that it lies on the scene's grid.
    pub(crate) fn axis_plane(&mut self, axis: Axis, value: f64) -> PlaneId {
        let known = self.axis_planes.get(&(axis, value.to_bits())).copied();
        known.unwrap_or_else(|| self.push_plane(SupportingPlane::Axis { axis, value }))
    }

    pub(crate) fn plane(&self, id: PlaneId) -> SupportingPlane {
        self.planes[id.index()]
    }

    pub(crate) fn vertex(&self, id: VertexId) -> DVec3 {
        self.vertices[id.index()]
    }

    pub(crate) fn line_count(&self) -> usize {
        self.edges.len() + self.creases.len()
    }

    pub(crate) fn line(&self, id: LineId) -> LineDef {
        match self.edges.get(id.0 as usize) {
            Some(&edge) => LineDef::Edge(edge),
            None => LineDef::Crease(self.creases[id.0 as usize - self.edges.len()]),
        }
    }

    /// The line that stands for all that are known to be the same as this one, and whether it runs
    /// the same way.
    pub(crate) fn representative(&self, line: LineId) -> (LineId, bool) {
        if (line.0 as usize) < self.edges.len() {
            let (edge, same_way) = self.collinear.representative(line.0);
            (LineId(edge), same_way)
        } else {
            (line, true)
        }
    }

    pub(crate) fn crease(&mut self, a: PlaneId, b: PlaneId) -> LineId {
        let key = [a.min(b), a.max(b)];
        let next = LineId(self.line_count() as u32);
        *self.crease_ids.entry(key).or_insert_with(|| {
            self.creases.push(key);
            next
        })
    }

    pub(crate) fn point_count(&self) -> usize {
        self.approx_points.len()
    }

    pub(crate) fn point(&self, id: PointId) -> PointDef {
        match (id.0 as usize).checked_sub(self.vertices.len()) {
            None => PointDef::Vertex(VertexId(id.0)),
            Some(k) => self.constructed[k],
        }
    }

    pub(crate) fn approx_point(&self, id: PointId) -> ApproxPoint {
        self.approx_points[id.0 as usize]
    }

    /// True if the point is known by identity to lie on the line, which stands for itself; false says
    /// nothing.
    pub(crate) fn known_on_line(&self, point: PointId, line: LineId) -> bool {
        match (point.0 as usize).checked_sub(self.vertices.len()) {
            None => {
                let [start, end] = [point.0, point.0 + 1].map(|k| self.vertex_lines_start[k as usize] as usize);
                self.vertex_lines[start..end].contains(&line)
            }
            Some(k) => self.incident[k].contains(&line.0),
        }
    }

    fn note_incidence(&mut self, point: PointId, line: LineId) {
        let Some(k) = (point.0 as usize).checked_sub(self.vertices.len()) else { return };
        if let Some(free) = self.incident[k].iter_mut().find(|l| **l == NO_LINE || **l == line.0) {
            *free = line.0;
        }
    }

    /// The point where the stretch of `line` from `from` to `to`, which lie on opposite sides of
    /// `plane`, crosses it. `crease` is where `plane` meets the plane of the fragment that is cut.
    pub(crate) fn crossing(
        &mut self,
        line: LineId,
        plane: PlaneId,
        ends: [PointId; 2],
        crease: LineId,
        arena: &mut Arena,
    ) -> PointId {
        let def = match self.line(line) {
            LineDef::Edge(edge) => PointDef::EdgePlane(edge, plane),
            LineDef::Crease([a, b]) => {
                let mut planes = [a, b, plane];
                planes.sort_unstable();
                PointDef::Planes(planes)
            }
        };
        let id = match self.constructed_ids.get(&def) {
            Some(&id) => id,
            None => self.push_constructed(def, plane, ends, arena),
        };
        self.note_incidence(id, self.representative(line).0);
        self.note_incidence(id, crease);
        id
    }

    fn push_constructed(
        &mut self,
        def: PointDef,
        plane: PlaneId,
        [from, to]: [PointId; 2],
        arena: &mut Arena,
    ) -> PointId {
        let id = PointId(self.approx_points.len() as u32);
        // On an edge of the scene interpolate between its exact ends.
        let [from, to] = match def {
            PointDef::EdgePlane([a, b], _) => [a, b].map(|v| self.approx_points[v.index()]),
            _ => [from, to].map(|p| self.approx_point(p)),
        };
        let mut approx = interpolate(from, to, self.height(plane, from), self.height(plane, to));
        let poor = 1e-13 * (from.position.abs() + to.position.abs());
        if !approx.err.cmple(poor).all() {
            let mark = arena.mark();
            let (x, w) = self.exact_point(&self.frame, arena, def);
            let (position, err) = self.frame.position(arena, x, w);
            approx = ApproxPoint { position, err };
            arena.release(mark);
        }
        let pinned = match &def {
            PointDef::Planes(planes) => planes.as_slice(),
            _ => std::slice::from_ref(&plane),
        };
        for &p in pinned {
            if let SupportingPlane::Axis { axis, value } = self.plane(p) {
                approx.position[axis as usize] = value;
                approx.err[axis as usize] = 0.0;
            }
        }
        self.approx_points.push(approx);
        self.constructed.push(def);
        self.constructed_ids.insert(def, id);
        self.incident.push([NO_LINE; 4]);
        id
    }

    /// The height of a point over a plane, times a positive number that is the same for all points.
    fn height(&self, plane: PlaneId, point: ApproxPoint) -> Ball {
        let coordinate = |k: usize| Ball::new(point.position[k], point.err[k]);
        if let SupportingPlane::Axis { axis, value } = self.plane(plane) {
            return coordinate(axis as usize) - Ball::exact(value);
        }
        let ApproxPlane { normal, anchor } = &self.approx_planes[plane.index()];
        let term = |k: usize| (coordinate(k) - Ball::exact(anchor[k])) * Ball::new(normal.v[k], normal.slack / 8.0);
        term(0) + term(1) + term(2)
    }

    /// The height of a point over a plane in scene units, rounded; for choices that need not be exact.
    pub(crate) fn rounded_height(&self, plane: PlaneId, point: PointId) -> f64 {
        let p = self.approx_point(point).position;
        if let SupportingPlane::Axis { axis, value } = self.plane(plane) {
            return p[axis as usize] - value;
        }
        let ApproxPlane { normal, anchor } = &self.approx_planes[plane.index()];
        let length = normal.v.length();
        if length > 0.0 { normal.v.dot(p - *anchor) / length } else { 0.0 }
    }

    /// The exact side of a plane that a point is on.
    pub(crate) fn side(&self, plane: PlaneId, point: PointId, arena: &mut Arena) -> Sign {
        let def = self.point(point);
        let approx = self.approx_point(point);
        if let SupportingPlane::Axis { axis, value } = self.plane(plane) {
            let (x, err) = (approx.position[axis as usize], approx.err[axis as usize]);
            if err == 0.0 {
                return compare(x, value);
            }
            // The gap is off by at most u relatively.
            let gap = x - value;
            if gap.abs() * (1.0 - 4.0 * U) > err {
                return Sign::of(gap);
            }
        } else {
            if let PointDef::Vertex(vertex) = def {
                return self.vertex_side(plane, vertex);
            }
            let height = self.height(plane, approx);
            if height.mid.abs() > height.rad {
                return Sign::of(height.mid);
            }
        }
        self.side_of_constructed(plane, def, arena)
    }

    /// The exact side of a plane that a position is on.
    pub(crate) fn position_side(&self, plane: PlaneId, position: DVec3) -> Sign {
        match self.plane(plane) {
            SupportingPlane::Axis { axis, value } => compare(position[axis as usize], value),
            SupportingPlane::Points([a, b, c]) => orient3d(self.vertex(a), self.vertex(b), self.vertex(c), position),
        }
    }

    fn vertex_side(&self, plane: PlaneId, vertex: VertexId) -> Sign {
        if let SupportingPlane::Points(points) = self.plane(plane)
            && points.contains(&vertex)
        {
            return Sign::Zero;
        }
        self.position_side(plane, self.vertex(vertex))
    }

    fn side_of_constructed(&self, plane: PlaneId, def: PointDef, arena: &mut Arena) -> Sign {
        match def {
            PointDef::Vertex(vertex) => self.vertex_side(plane, vertex),
            PointDef::EdgePlane(_, cut) if cut == plane => Sign::Zero,
            PointDef::Planes(planes) if planes.contains(&plane) => Sign::Zero,
            PointDef::EdgePlane([a, b], _)
                if self.vertex_side(plane, a).is_zero() && self.vertex_side(plane, b).is_zero() =>
            {
                Sign::Zero
            }
            _ => {
                let mark = arena.mark();
                let (x, w) = self.exact_point(&self.frame, arena, def);
                let (normal, height) = self.exact_plane(&self.frame, arena, plane);
                let along = arena.dot(normal, x);
                let offset = arena.mul(height, w);
                let sign = arena.add(along, offset).sign();
                arena.release(mark);
                sign
            }
        }
    }

    /// A plane relative to the frame's origin: `normal . x + height * w` has the sign of the side
    /// that the point `x / w` (relative to the origin) is on, for `w > 0`.
    pub(crate) fn exact_plane(&self, frame: &Frame, arena: &mut Arena, plane: PlaneId) -> (Num3, Num) {
        match self.plane(plane) {
            SupportingPlane::Axis { axis, value } => {
                let mut normal = [Num::ZERO; 3];
                normal[axis as usize] = arena.integer(1);
                (normal, frame.relative_coordinate(arena, axis as usize, value).negated())
            }
            SupportingPlane::Points(points) => {
                let [a, b, c] = points.map(|v| frame.relative(arena, self.vertex(v)));
                let ab = arena.sub3(b, a);
                let ac = arena.sub3(c, a);
                let normal = arena.cross(ab, ac);
                (normal, arena.dot(normal, a).negated())
            }
        }
    }

    /// A point relative to the frame's origin, in homogeneous coordinates `x / w` with `w > 0`.
    pub(crate) fn exact_point(&self, frame: &Frame, arena: &mut Arena, def: PointDef) -> (Num3, Num) {
        match def {
            PointDef::Vertex(v) => (frame.relative(arena, self.vertex(v)), arena.integer(1)),
            PointDef::EdgePlane(ends, plane) => {
                let [a, b] = ends.map(|v| frame.relative(arena, self.vertex(v)));
                let (normal, height) = self.exact_plane(frame, arena, plane);
                let [at_a, at_b] = [a, b].map(|p| {
                    let along = arena.dot(normal, p);
                    arena.add(along, height)
                });
                debug_assert_eq!(at_a.sign(), -at_b.sign(), "the plane separates the ends");
                // a |h_b| + b |h_a| over |h_a| + |h_b|; the heights' signs differ.
                let sign = at_a.sign();
                let (to_a, to_b) = (at_b.negated().times_sign(sign), at_a.times_sign(sign));
                let (from_a, from_b) = (arena.scale3(to_a, a), arena.scale3(to_b, b));
                (arena.add3(from_a, from_b), arena.add(to_a, to_b))
            }
            PointDef::Planes(planes) => {
                // Cramer's rule for N_i . x = -h_i.
                let [(n1, h1), (n2, h2), (n3, h3)] = planes.map(|p| self.exact_plane(frame, arena, p));
                let (n23, n31, n12) = (arena.cross(n2, n3), arena.cross(n3, n1), arena.cross(n1, n2));
                let det = arena.dot(n1, n23);
                let terms = [(h1, n23), (h2, n31), (h3, n12)].map(|(h, n)| arena.scale3(h, n));
                let sum = arena.add3(terms[0], terms[1]);
                let sum = arena.add3(sum, terms[2]);
                let sign = det.sign();
                (sum.map(|x| x.times_sign(-sign)), det.times_sign(sign))
            }
        }
    }

    /// The normal of the plane through a line and the frame's origin: for an edge `(a - o) x (b - o)`,
    /// for a crease `h_2 N_1 - h_1 N_2`.
    pub(crate) fn exact_line_normal(&self, frame: &Frame, arena: &mut Arena, line: LineId) -> Num3 {
        match self.line(line) {
            LineDef::Edge(ends) => {
                let [a, b] = ends.map(|v| frame.relative(arena, self.vertex(v)));
                arena.cross(a, b)
            }
            LineDef::Crease(planes) => {
                let [(n1, h1), (n2, h2)] = planes.map(|p| self.exact_plane(frame, arena, p));
                let (first, second) = (arena.scale3(h2, n1), arena.scale3(h1, n2));
                arena.sub3(first, second)
            }
        }
    }

    /// The same normal in floating point.
    pub(crate) fn approx_line_normal(&self, eye: DVec3, line: LineId) -> Approx3 {
        match self.line(line) {
            LineDef::Edge([a, b]) => Approx3::edge_normal(eye, self.vertex(a), self.vertex(b)),
            LineDef::Crease([p, q]) => {
                let at = ApproxPoint { position: eye, err: DVec3::ZERO };
                let [(n1, h1), (n2, h2)] = [p, q].map(|plane| {
                    let normal = &self.approx_planes[plane.index()].normal;
                    (normal, self.height(plane, at))
                });
                let component =
                    |k: usize| h2 * Ball::new(n1.v[k], n1.slack / 8.0) - h1 * Ball::new(n2.v[k], n2.slack / 8.0);
                let m = [component(0), component(1), component(2)];
                let err = m[0].rad.max(m[1].rad).max(m[2].rad);
                let err = if m.iter().any(|b| b.rad.is_nan()) { f64::NAN } else { err };
                Approx3::known(DVec3::new(m[0].mid, m[1].mid, m[2].mid), err)
            }
        }
    }

    /// A plane's normal, pointing to its front.
    pub(crate) fn approx_normal(&self, plane: PlaneId) -> Approx3 {
        self.approx_planes[plane.index()].normal
    }

    /// A point on the plane.
    pub(crate) fn anchor(&self, plane: PlaneId) -> DVec3 {
        self.approx_planes[plane.index()].anchor
    }
}

/// The point at height 0 between two points whose heights have opposite signs.
fn interpolate(from: ApproxPoint, to: ApproxPoint, at_from: Ball, at_to: Ball) -> ApproxPoint {
    let t = at_from.div(at_from - at_to);
    let mut result = from;
    for k in 0..3 {
        let (a, b) = (Ball::new(from.position[k], from.err[k]), Ball::new(to.position[k], to.err[k]));
        // Exact where both ends are, and the same.
        if a.rad == 0.0 && b.rad == 0.0 && compare(a.mid, b.mid).is_zero() {
            continue;
        }
        let x = a + t * (b - a);
        result.position[k] = x.mid;
        result.err[k] = if x.rad.is_nan() { f64::INFINITY } else { x.rad };
    }
    result
}

fn compare(x: f64, y: f64) -> Sign {
    if x > y {
        Sign::Positive
    } else if x < y {
        Sign::Negative
    } else {
        Sign::Zero
    }
}

/// For every vertex the lines of its edges, each once; with the place where each vertex's lines begin.
fn lines_through_vertices(scene: &Scene, collinear: &Collinear) -> (Vec<LineId>, Vec<u32>) {
    let mut pairs: Vec<(VertexId, LineId)> = Vec::with_capacity(2 * scene.edges().len());
    for (k, edge) in scene.edges().iter().enumerate() {
        let line = LineId(collinear.representative(k as u32).0);
        pairs.extend(edge.map(|vertex| (vertex, line)));
    }
    pairs.sort_unstable();
    pairs.dedup();
    let mut starts = vec![0; scene.vertices().len() + 1];
    for (vertex, _) in &pairs {
        starts[vertex.index() + 1] += 1;
    }
    for k in 1..starts.len() {
        starts[k] += starts[k - 1];
    }
    (pairs.into_iter().map(|(_, line)| line).collect(), starts)
}
