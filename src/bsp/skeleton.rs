//! Planes, lines and points by exact definition: those of the scene and those that splits made.
//!
//! A constructed point is never just rounded coordinates: it is an edge cut by a plane, or three
//! planes. Fragments that share a line or a point share its id, so that the most frequent zeros
//! are known by identity.

use super::collinear::Collinear;
use crate::exact::{
    Approx3, ApproxPlane, ApproxPoint, Arena, BitRange, Constructor, Frame, Plane, Point, Sign, Splitter, U, orient3d,
};
use crate::scene::{Axis, Carried, PieceRef, PlaneId, Scene, Side, SupportingPlane, VertexId};
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

const NO_LINE: u32 = u32::MAX;

#[derive(Clone, Debug)]
pub(crate) struct Skeleton {
    pub(crate) bits: BitRange,
    vertices: Vec<DVec3>,
    planes: Vec<SupportingPlane>,
    approx_planes: Vec<ApproxPlane>,
    axis_planes: FxHashMap<(Axis, u64), PlaneId>,
    /// Planes that were chosen, through vertices in ascending order.
    vertex_planes: FxHashMap<[VertexId; 3], PlaneId>,
    edges: Vec<[VertexId; 2]>,
    collinear: Collinear,
    /// The lines through each vertex, one vertex after the other, and where each begins.
    vertex_lines: Vec<LineId>,
    vertex_lines_start: Vec<u32>,
    creases: Vec<[PlaneId; 2]>,
    crease_ids: FxHashMap<[PlaneId; 2], LineId>,
    constructed: Vec<PointDef>,
    constructed_ids: FxHashMap<PointDef, PointId>,
    /// Approximations of constructed points; vertices are exact.
    approx_points: Vec<ApproxPoint>,
    /// Up to four lines that a constructed point is known to lie on.
    incident: Vec<[u32; 4]>,
    /// The scene's own frame, for decisions that no viewpoint takes part in.
    frame: Frame,
}

impl Skeleton {
    pub(crate) fn new(scene: &Scene) -> Self {
        let (bits, frame) = grid(scene);
        let collinear = Collinear::new(scene.vertices(), scene.edges(), &frame);
        let mut skeleton = Self::without_planes(scene, bits, frame, collinear);
        for &plane in scene.planes() {
            skeleton.push_plane(plane);
        }
        skeleton
    }

    /// The skeleton of this one's scene with objects moved: what has not moved is taken over. Planes and lines that are not the
    /// scene's are left out.
    pub(crate) fn moved(&self, scene: &Scene, carried: &Carried) -> Self {
        let (bits, frame) = grid(scene);
        let collinear = self.collinear.moved(scene.vertices(), scene.edges(), &frame, &carried.edges);
        let mut skeleton = Self::without_planes(scene, bits, frame, collinear);
        for (&plane, before) in scene.planes().iter().zip(&carried.planes) {
            match before {
                Some(before) => skeleton.add_plane(plane, self.approx_planes[before.index()]),
                None => skeleton.push_plane(plane),
            };
        }
        skeleton
    }

    fn without_planes(scene: &Scene, bits: BitRange, frame: Frame, collinear: Collinear) -> Self {
        let (vertex_lines, vertex_lines_start) = lines_through_vertices(scene, &collinear);
        Self {
            bits,
            collinear,
            vertex_lines,
            vertex_lines_start,
            vertices: scene.vertices().to_vec(),
            planes: Vec::with_capacity(scene.planes().len()),
            approx_planes: Vec::with_capacity(scene.planes().len()),
            axis_planes: FxHashMap::default(),
            vertex_planes: FxHashMap::default(),
            edges: scene.edges().to_vec(),
            creases: Vec::new(),
            crease_ids: FxHashMap::default(),
            constructed: Vec::new(),
            constructed_ids: FxHashMap::default(),
            approx_points: Vec::new(),
            incident: Vec::new(),
            frame,
        }
    }

    /// A skeleton without planes for a part of the scene: `vertices` and `edges` by numbers of their own, with the edges that stand
    /// for others.
    pub(super) fn part(&self, vertices: Vec<DVec3>, (edges, lines): (Vec<[VertexId; 2]>, Vec<(u32, bool)>)) -> Self {
        Self {
            bits: self.bits,
            collinear: Collinear::known(lines),
            vertex_lines: Vec::new(),
            vertex_lines_start: vec![0; vertices.len() + 1],
            planes: Vec::new(),
            approx_planes: Vec::new(),
            axis_planes: FxHashMap::default(),
            vertex_planes: FxHashMap::default(),
            edges,
            creases: Vec::new(),
            crease_ids: FxHashMap::default(),
            constructed: Vec::new(),
            constructed_ids: FxHashMap::default(),
            approx_points: Vec::new(),
            vertices,
            incident: Vec::new(),
            frame: self.frame,
        }
    }

    fn push_plane(&mut self, plane: SupportingPlane) -> PlaneId {
        let approx = ApproxPlane::refined(&self.resolved(plane));
        self.add_plane(plane, approx)
    }

    /// Adds a plane of which the approximation is known.
    pub(super) fn add_plane(&mut self, plane: SupportingPlane, approx: ApproxPlane) -> PlaneId {
        let id = PlaneId(self.planes.len() as u32);
        self.planes.push(plane);
        if let SupportingPlane::Axis { axis, value } = plane {
            self.axis_planes.insert((axis, value.to_bits()), id);
        }
        self.approx_planes.push(approx);
        id
    }

    pub(super) fn plane_count(&self) -> usize {
        self.planes.len()
    }

    /// The axis-aligned plane, made if there is none yet. `value` must be a coordinate of a vertex,
    /// so that it lies on the scene's grid.
    pub(crate) fn axis_plane(&mut self, axis: Axis, value: f64) -> PlaneId {
        let known = self.axis_planes.get(&(axis, value.to_bits())).copied();
        known.unwrap_or_else(|| self.push_plane(SupportingPlane::Axis { axis, value }))
    }

    /// A plane through three vertices; `None` if they are on a line.
    pub(super) fn plane_through(&self, vertices: [VertexId; 3]) -> Option<ApproxPlane> {
        let plane = ApproxPlane::refined(&Plane::Points(vertices.map(|v| self.vertex(v))));
        (!plane.normal.is_poor()).then_some(plane)
    }

    /// The plane through three vertices that are not on a line, in ascending order; made if it was not chosen before.
    pub(super) fn vertex_plane(&mut self, vertices: [VertexId; 3]) -> PlaneId {
        let known = self.vertex_planes.get(&vertices).copied();
        known.unwrap_or_else(|| {
            let id = self.push_plane(SupportingPlane::Points(vertices));
            self.vertex_planes.insert(vertices, id);
            id
        })
    }

    pub(super) fn approx_plane(&self, id: PlaneId) -> &ApproxPlane {
        &self.approx_planes[id.index()]
    }

    /// The vertex of the scene that a point is, if it is one.
    pub(super) fn scene_vertex(&self, point: PointId) -> Option<VertexId> {
        ((point.0 as usize) < self.vertices.len()).then_some(VertexId(point.0))
    }

    pub(crate) fn plane(&self, id: PlaneId) -> SupportingPlane {
        self.planes[id.index()]
    }

    /// The plane by its coordinates.
    pub(crate) fn resolved_plane(&self, id: PlaneId) -> Plane {
        self.resolved(self.plane(id))
    }

    fn resolved(&self, plane: SupportingPlane) -> Plane {
        match plane {
            SupportingPlane::Axis { axis, value } => Plane::Axis { axis: axis as usize, value },
            SupportingPlane::Points(points) => Plane::Points(points.map(|v| self.vertex(v))),
        }
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
        self.vertices.len() + self.constructed.len()
    }

    pub(crate) fn point(&self, id: PointId) -> PointDef {
        match (id.0 as usize).checked_sub(self.vertices.len()) {
            None => PointDef::Vertex(VertexId(id.0)),
            Some(k) => self.constructed[k],
        }
    }

    /// The point by its coordinates.
    pub(crate) fn resolved_point(&self, def: PointDef) -> Point {
        match def {
            PointDef::Vertex(v) => Point::Given(self.vertex(v)),
            PointDef::EdgePlane(ends, plane) => {
                Point::EdgePlane(ends.map(|v| self.vertex(v)), self.resolved_plane(plane))
            }
            PointDef::Planes(planes) => Point::Planes(planes.map(|p| self.resolved_plane(p))),
        }
    }

    /// The great circle of a line by its coordinates.
    pub(crate) fn resolved_line(&self, line: LineId) -> Splitter {
        match self.line(line) {
            LineDef::Edge(ends) => Splitter::Edge(ends.map(|v| self.vertex(v))),
            LineDef::Crease(planes) => Splitter::Crease(planes.map(|p| self.resolved_plane(p))),
        }
    }

    #[inline]
    pub(crate) fn approx_point(&self, id: PointId) -> ApproxPoint {
        match (id.0 as usize).checked_sub(self.vertices.len()) {
            None => ApproxPoint::exact(self.vertices[id.0 as usize]),
            Some(k) => self.approx_points[k],
        }
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

    pub(super) fn note_incidence(&mut self, point: PointId, line: LineId) {
        let Some(k) = (point.0 as usize).checked_sub(self.vertices.len()) else { return };
        if let Some(free) = self.incident[k].iter_mut().find(|l| **l == NO_LINE || **l == line.0) {
            *free = line.0;
        }
    }

    /// The point where a stretch of `line`, the ends of which lie on opposite sides of
    /// `plane`, crosses it. `crease` is where `plane` meets the plane of the fragment that is cut.
    pub(crate) fn crossing(&mut self, line: LineId, plane: PlaneId, crease: LineId, arena: &mut Arena) -> PointId {
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
            None => self.push_constructed(def, plane, arena),
        };
        self.note_incidence(id, self.representative(line).0);
        self.note_incidence(id, crease);
        id
    }

    fn push_constructed(&mut self, def: PointDef, plane: PlaneId, arena: &mut Arena) -> PointId {
        // On an edge of the scene interpolated between its exact ends, where that is good. Of three planes made from these alone: whatever
        // fragment comes to the point first, it is the same, and so are the planes that are chosen by it.
        let interpolated = match def {
            PointDef::EdgePlane(ends, _) => {
                let [from, to] = ends.map(|v| ApproxPoint::exact(self.vertex(v)));
                let cut = &self.approx_planes[plane.index()];
                let approx = ApproxPoint::between(from, to, cut.height(&from), cut.height(&to));
                let poor = 1e-13 * (from.position.abs() + to.position.abs());
                approx.err.cmple(poor).all().then_some(approx)
            }
            PointDef::Vertex(_) | PointDef::Planes(_) => None,
        };
        let mut approx = interpolated.unwrap_or_else(|| {
            let mark = arena.mark();
            let (x, w) = Constructor { frame: &self.frame, arena }.point(&self.resolved_point(def));
            let (position, err) = self.frame.position(arena, x, w);
            arena.release(mark);
            ApproxPoint { position, err }
        });
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
        self.add_constructed(def, approx)
    }

    /// Adds a constructed point of which the approximation is known.
    pub(super) fn add_constructed(&mut self, def: PointDef, approx: ApproxPoint) -> PointId {
        let id = PointId(self.point_count() as u32);
        self.approx_points.push(approx);
        self.constructed.push(def);
        self.constructed_ids.insert(def, id);
        self.incident.push([NO_LINE; 4]);
        id
    }

    /// The constructed point of that definition; if there is none yet, it is added with this approximation.
    pub(super) fn constructed(&mut self, def: PointDef, approx: ApproxPoint) -> PointId {
        let known = self.constructed_ids.get(&def).copied();
        known.unwrap_or_else(|| self.add_constructed(def, approx))
    }

    /// The lines that a constructed point is known to lie on.
    pub(super) fn lines_through(&self, point: PointId) -> impl Iterator<Item = LineId> {
        let lines = (point.0 as usize).checked_sub(self.vertices.len()).map(|k| self.incident[k]);
        lines.into_iter().flatten().filter(|&line| line != NO_LINE).map(LineId)
    }

    /// The height of a point over a plane in scene units, rounded; for choices that need not be exact.
    pub(crate) fn rounded_height(&self, plane: PlaneId, point: PointId) -> f64 {
        self.approx_planes[plane.index()].rounded_height(self.approx_point(point).position)
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
            let height = self.approx_planes[plane.index()].height(&approx);
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

    /// The side of a piece that the eye is on; `None` if the eye is in its plane.
    pub(crate) fn shown_side(&self, piece: PieceRef<'_>, eye: DVec3) -> Option<Side> {
        match self.position_side(piece.plane_id(), eye) {
            Sign::Zero => None,
            Sign::Positive => Some(piece.facing()),
            Sign::Negative => Some(piece.facing().opposite()),
        }
    }

    /// The exact side of a plane that a vertex is on.
    pub(crate) fn vertex_side(&self, plane: PlaneId, vertex: VertexId) -> Sign {
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
                let mut exact = Constructor { frame: &self.frame, arena };
                let (x, w) = exact.point(&self.resolved_point(def));
                let (normal, height) = exact.plane(&self.resolved_plane(plane));
                let sign = arena.height_sign(normal, height, x, w);
                arena.release(mark);
                sign
            }
        }
    }

    /// The normal of a line's great circle in floating point.
    pub(crate) fn approx_line_normal(&self, eye: DVec3, line: LineId) -> Approx3 {
        match self.line(line) {
            LineDef::Edge([a, b]) => Approx3::edge_normal(eye, self.vertex(a), self.vertex(b)),
            LineDef::Crease(planes) => self.approx_crease_normal(eye, planes),
        }
    }

    /// The normal of the great circle through the line where two planes meet.
    pub(crate) fn approx_crease_normal(&self, eye: DVec3, planes: [PlaneId; 2]) -> Approx3 {
        ApproxPlane::crease(planes.map(|p| &self.approx_planes[p.index()]), eye)
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

fn compare(x: f64, y: f64) -> Sign {
    if x > y {
        Sign::Positive
    } else if x < y {
        Sign::Negative
    } else {
        Sign::Zero
    }
}

/// The grid on which the vertices of a scene lie.
fn grid(scene: &Scene) -> (BitRange, Frame) {
    let bits = BitRange::of(scene.vertices().iter().copied());
    let origin = scene.vertices().first().copied().unwrap_or_default();
    (bits, Frame::new(bits, origin))
}

/// For every vertex the lines of its edges, each once; with the place where each vertex's lines begin.
fn lines_through_vertices(scene: &Scene, collinear: &Collinear) -> (Vec<LineId>, Vec<u32>) {
    let mut starts = vec![0; scene.vertices().len() + 1];
    for end in scene.edges().iter().flatten() {
        starts[end.index() + 1] += 1;
    }
    for k in 1..starts.len() {
        starts[k] += starts[k - 1];
    }
    let mut all = vec![LineId(0); 2 * scene.edges().len()];
    let mut next = starts.clone();
    for (edge, ends) in (0..).zip(scene.edges()) {
        let line = LineId(collinear.representative(edge).0);
        for end in ends {
            all[next[end.index()] as usize] = line;
            next[end.index()] += 1;
        }
    }
    let mut lines = Vec::with_capacity(all.len());
    for vertex in 0..scene.vertices().len() {
        let here = &mut all[starts[vertex] as usize..starts[vertex + 1] as usize];
        here.sort_unstable();
        let start = lines.len();
        starts[vertex] = start as u32;
        for &line in &*here {
            if lines.len() == start || lines.last() != Some(&line) {
                lines.push(line);
            }
        }
    }
    starts[scene.vertices().len()] = lines.len() as u32;
    (lines, starts)
}
