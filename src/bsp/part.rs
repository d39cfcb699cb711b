//! Subtrees that grow apart from one another: each on a skeleton of its own, made of what its fragments need, so that threads share
//! nothing. Putting the subtrees back in a fixed order gives the same tree for any number of threads.
//!
//! Numbers in a part follow the order of the numbers in the whole, so that pairs and triples that are kept
//! in order stay in order.

use super::build::BspError;
use super::fragment::{Fragment, FragmentSide};
use super::grow::{Grower, Item, Job, Link, Rules};
use super::skeleton::{LineDef, LineId, PointDef, PointId, Skeleton};
use super::{Node, UncutSliver};
use crate::scene::{PlaneId, SupportingPlane, VertexId};
use std::ops::Range;

/// Numbers of the whole that are used in a part, ascending: number k of the part is the k-th.
#[derive(Debug, Default)]
struct Used(Vec<u32>);

impl Used {
    fn new(mut numbers: Vec<u32>) -> Self {
        numbers.sort_unstable();
        numbers.dedup();
        Self(numbers)
    }

    /// The number in the part of what is used there.
    fn place(&self, number: u32) -> u32 {
        let place = self.0.partition_point(|&known| known < number);
        debug_assert_eq!(self.0.get(place), Some(&number), "not part of this part");
        place as u32
    }
}

/// What of the whole a part consists of.
#[derive(Debug)]
struct Members {
    vertices: Used,
    planes: Used,
    edges: Used,
    /// Creases and constructed points, by their numbers in the whole.
    creases: Used,
    constructed: Used,
}

/// A subtree that was grown, with the numbers of its part.
#[derive(Debug)]
pub(super) struct Subtree {
    grower: Grower,
    members: Members,
    link: Option<Link>,
}

impl Subtree {
    /// Grows all nodes of a job on a skeleton of its own.
    ///
    /// # Errors
    /// If there are too many fragments.
    pub(super) fn grow(whole: &Skeleton, mut job: Job, rules: &Rules) -> Result<Self, BspError> {
        let members = Members::of(whole, &job.items);
        let mut grower = Grower::new(members.skeleton(whole));
        for item in &mut job.items {
            members.take(whole, item);
        }
        let link = job.link.take();
        grower.grow(job, 0, rules)?;
        Ok(Self { grower, members, link })
    }

    /// Adds the subtree to the whole tree.
    pub(super) fn graft(self, whole: &mut Grower) {
        let Self { grower: part, members, link } = self;
        let back = Back::new(&mut whole.skeleton, &part.skeleton, &members);
        let first_node = whole.nodes.len() as u32;
        let first_fragment = whole.fragments.len() as u32;
        let first_side = whole.sides.len() as u32;
        if !part.nodes.is_empty() {
            whole.link(link, first_node);
        }
        whole.nodes.extend(part.nodes.into_iter().map(|node| Node {
            plane: back.plane(node.plane),
            back: node.back.map(|child| child + first_node),
            front: node.front.map(|child| child + first_node),
            fragments: moved(&node.fragments, first_fragment),
            bounds: node.bounds,
        }));
        whole.fragments.extend(part.fragments.into_iter().map(|f| Fragment { start: f.start + first_side, ..f }));
        whole.sides.extend(part.sides.into_iter().map(|side| FragmentSide {
            point: back.point(side.point),
            line: back.line(side.line),
            forward: side.forward,
        }));
        whole.slivers.extend(
            part.slivers.into_iter().map(|sliver| UncutSliver { plane: members.back_plane(sliver.plane), ..sliver }),
        );
        whole.axis_nodes += part.axis_nodes;
        whole.splits += part.splits;
        whole.depth = whole.depth.max(part.depth);
    }
}

fn moved(range: &Range<u32>, by: u32) -> Range<u32> {
    range.start + by..range.end + by
}

impl Members {
    fn of(whole: &Skeleton, items: &[Item]) -> Self {
        let (mut vertices, mut planes, mut edges) = (Vec::new(), Vec::new(), Vec::new());
        let (mut creases, mut constructed) = (Vec::new(), Vec::new());
        for item in items {
            planes.push(item.own.0);
            for side in &item.sides {
                match whole.point(side.point) {
                    PointDef::Vertex(vertex) => vertices.push(vertex.0),
                    PointDef::EdgePlane(ends, plane) => {
                        constructed.push(side.point.0);
                        vertices.extend(ends.map(|v| v.0));
                        planes.push(plane.0);
                    }
                    PointDef::Planes(three) => {
                        constructed.push(side.point.0);
                        planes.extend(three.map(|p| p.0));
                    }
                }
                match whole.line(side.line) {
                    LineDef::Edge(_) => {
                        edges.push(side.line.0);
                        edges.push(whole.representative(side.line).0.0);
                    }
                    LineDef::Crease(two) => {
                        creases.push(side.line.0);
                        planes.extend(two.map(|p| p.0));
                    }
                }
            }
        }
        let (planes, edges) = (Used::new(planes), Used::new(edges));
        for &edge in &edges.0 {
            if let LineDef::Edge(ends) = whole.line(LineId(edge)) {
                vertices.extend(ends.map(|v| v.0));
            }
        }
        for &plane in &planes.0 {
            if let SupportingPlane::Points(points) = whole.plane(PlaneId(plane)) {
                vertices.extend(points.map(|v| v.0));
            }
        }
        let (creases, constructed) = (Used::new(creases), Used::new(constructed));
        Self { vertices: Used::new(vertices), planes, edges, creases, constructed }
    }

    fn vertex(&self, id: VertexId) -> VertexId {
        VertexId(self.vertices.place(id.0))
    }

    fn plane(&self, id: PlaneId) -> PlaneId {
        PlaneId(self.planes.place(id.0))
    }

    fn line(&self, whole: &Skeleton, id: LineId) -> LineId {
        match whole.line(id) {
            LineDef::Edge(_) => LineId(self.edges.place(id.0)),
            LineDef::Crease(_) => LineId(self.edges.0.len() as u32 + self.creases.place(id.0)),
        }
    }

    fn point(&self, whole: &Skeleton, id: PointId) -> PointId {
        match whole.point(id) {
            PointDef::Vertex(vertex) => PointId(self.vertex(vertex).0),
            _ => PointId(self.vertices.0.len() as u32 + self.constructed.place(id.0)),
        }
    }

    /// The item by the numbers of the part.
    fn take(&self, whole: &Skeleton, item: &mut Item) {
        item.own = self.plane(item.own);
        for side in &mut item.sides {
            side.point = self.point(whole, side.point);
            side.line = self.line(whole, side.line);
        }
    }

    /// The skeleton of the part.
    fn skeleton(&self, whole: &Skeleton) -> Skeleton {
        let edges = self.edges.0.iter().map(|&edge| {
            let LineDef::Edge(ends) = whole.line(LineId(edge)) else { unreachable!("the line of an edge is an edge") };
            let (stands_for_it, same_way) = whole.representative(LineId(edge));
            (ends.map(|v| self.vertex(v)), (self.edges.place(stands_for_it.0), same_way))
        });
        let vertices = self.vertices.0.iter().map(|&v| whole.vertex(VertexId(v))).collect();
        let mut part = whole.part(vertices, edges.unzip());
        for &plane in &self.planes.0 {
            let id = PlaneId(plane);
            let plane = match whole.plane(id) {
                SupportingPlane::Points(points) => SupportingPlane::Points(points.map(|v| self.vertex(v))),
                axis @ SupportingPlane::Axis { .. } => axis,
            };
            part.add_plane(plane, *whole.approx_plane(id));
        }
        for &crease in &self.creases.0 {
            if let LineDef::Crease([a, b]) = whole.line(LineId(crease)) {
                part.crease(self.plane(a), self.plane(b));
            }
        }
        for &point in &self.constructed.0 {
            let def = match whole.point(PointId(point)) {
                PointDef::Vertex(vertex) => PointDef::Vertex(self.vertex(vertex)),
                PointDef::EdgePlane(ends, plane) => {
                    PointDef::EdgePlane(ends.map(|v| self.vertex(v)), self.plane(plane))
                }
                PointDef::Planes(planes) => PointDef::Planes(planes.map(|p| self.plane(p))),
            };
            part.add_constructed(def, whole.approx_point(PointId(point)));
        }
        part
    }

    /// A plane by the vertices of the whole.
    fn back_plane(&self, plane: SupportingPlane) -> SupportingPlane {
        match plane {
            SupportingPlane::Points(points) => {
                SupportingPlane::Points(points.map(|v| VertexId(self.vertices.0[v.index()])))
            }
            axis @ SupportingPlane::Axis { .. } => axis,
        }
    }
}

/// From the numbers of a part to those of the whole, with what is new added to the whole.
struct Back<'a> {
    members: &'a Members,
    planes: Vec<PlaneId>,
    lines: Vec<LineId>,
    constructed: Vec<PointId>,
}

impl<'a> Back<'a> {
    fn new(whole: &mut Skeleton, part: &Skeleton, members: &'a Members) -> Self {
        let mut back = Self { members, planes: Vec::new(), lines: Vec::new(), constructed: Vec::new() };
        back.planes.extend(members.planes.0.iter().map(|&plane| PlaneId(plane)));
        for k in back.planes.len()..part.plane_count() {
            back.planes.push(match members.back_plane(part.plane(PlaneId(k as u32))) {
                SupportingPlane::Axis { axis, value } => whole.axis_plane(axis, value),
                SupportingPlane::Points(vertices) => whole.vertex_plane(vertices),
            });
        }
        back.lines.extend(members.edges.0.iter().map(|&edge| LineId(edge)));
        for k in back.lines.len()..part.line_count() {
            if let LineDef::Crease([a, b]) = part.line(LineId(k as u32)) {
                back.lines.push(whole.crease(back.plane(a), back.plane(b)));
            }
        }
        for k in members.vertices.0.len()..part.point_count() {
            let point = PointId(k as u32);
            let def = match part.point(point) {
                PointDef::Vertex(vertex) => PointDef::Vertex(VertexId(members.vertices.0[vertex.index()])),
                PointDef::EdgePlane(ends, plane) => {
                    PointDef::EdgePlane(ends.map(|v| VertexId(members.vertices.0[v.index()])), back.plane(plane))
                }
                PointDef::Planes(planes) => {
                    let mut planes = planes.map(|p| back.plane(p));
                    planes.sort_unstable();
                    PointDef::Planes(planes)
                }
            };
            let id = whole.constructed(def, part.approx_point(point));
            for line in part.lines_through(point) {
                whole.note_incidence(id, back.line(line));
            }
            back.constructed.push(id);
        }
        back
    }

    fn plane(&self, id: PlaneId) -> PlaneId {
        self.planes[id.index()]
    }

    fn line(&self, id: LineId) -> LineId {
        self.lines[id.0 as usize]
    }

    fn point(&self, id: PointId) -> PointId {
        match self.members.vertices.0.get(id.0 as usize) {
            Some(&vertex) => PointId(vertex),
            None => self.constructed[id.0 as usize - self.members.vertices.0.len()],
        }
    }
}
