//! Putting facets together: edges and axis-aligned planes are shared across the scene.

use super::facets::Facets;
use super::flat::orientation;
use super::{Axis, Data, EdgeId, MaterialId, ObjectId, Piece, PlaneId, Polygon, PolygonId, SceneProblem, Shape, Side};
use super::{SupportingPlane, VertexId};
use glam::DVec3;
use std::collections::HashMap;
use std::sync::Arc;

/// As many of anything as a 32-bit id can name.
pub(super) const LIMIT: usize = u32::MAX as usize;

/// The next id of something of which there are `count`.
pub(super) fn next_id(count: usize, what: &'static str) -> Result<u32, SceneProblem> {
    if count < LIMIT { Ok(count as u32) } else { Err(SceneProblem::TooLarge { what, limit: LIMIT as u64 }) }
}

/// A scene in the making.
#[derive(Default)]
pub(super) struct Assembly {
    pub(super) data: Data,
    edges: HashMap<[VertexId; 2], EdgeId>,
    axis_planes: HashMap<(Axis, u64), PlaneId>,
}

impl Assembly {
    /// Starts from the vertices.
    pub(super) fn new(vertices: Vec<DVec3>) -> Self {
        Self { data: Data { vertices, ..Data::default() }, ..Self::default() }
    }

    /// The same with room for as much as there is in another scene.
    pub(super) fn with_room_for(vertices: Vec<DVec3>, other: &Data) -> Self {
        let mut assembly = Self::new(vertices);
        let data = &mut assembly.data;
        data.edges.reserve(other.edges.len());
        data.planes.reserve(other.planes.len());
        data.polygons.reserve(other.polygons.len());
        data.pieces.reserve(other.pieces.len());
        data.piece_vertices.reserve(other.piece_vertices.len());
        data.piece_edges.reserve(other.piece_edges.len());
        assembly
    }

    /// Adds the next polygon with its facets.
    pub(super) fn add_polygon(
        &mut self,
        (object, material): (ObjectId, MaterialId),
        rings: Vec<Vec<VertexId>>,
        facets: Facets,
    ) -> Result<(), SceneProblem> {
        let polygon = PolygonId(next_id(self.data.polygons.len(), "polygons")?);
        let shape = facets.shape;
        debug_assert!(matches!(shape, Shape::Degenerate | Shape::Dropped) || !facets.outlines.is_empty());
        let first = next_id(self.data.pieces.len(), "pieces")?;
        let shared = facets.plane.map(|corners| self.plane(corners)).transpose()?;
        for ring in facets.outlines {
            let (plane, facing) = match shared {
                Some(shared) => shared,
                None => self.plane([ring[0], ring[1], ring[2]])?,
            };
            self.add_piece(polygon, plane, facing, &ring)?;
        }
        let pieces = first..self.data.pieces.len() as u32;
        self.data.polygons.push(Polygon { object, material, shape, rings: rings.into(), pieces });
        Ok(())
    }

    fn add_piece(
        &mut self,
        polygon: PolygonId,
        plane: PlaneId,
        facing: Side,
        ring: &[VertexId],
    ) -> Result<(), SceneProblem> {
        next_id(self.data.pieces.len(), "pieces")?;
        let start = next_id(self.data.piece_vertices.len(), "corners of pieces")?;
        for (k, &from) in ring.iter().enumerate() {
            let edge = self.edge(from, ring[(k + 1) % ring.len()])?;
            self.data.piece_vertices.push(from);
            self.data.piece_edges.push(edge);
        }
        next_id(self.data.piece_vertices.len(), "corners of pieces")?;
        self.data.pieces.push(Piece { polygon, plane, facing, start, len: ring.len() as u32 });
        Ok(())
    }

    /// The edge between two vertices, made if there is none yet.
    pub(super) fn edge(&mut self, a: VertexId, b: VertexId) -> Result<EdgeId, SceneProblem> {
        let ends = [a.min(b), a.max(b)];
        if let Some(&known) = self.edges.get(&ends) {
            return Ok(known);
        }
        let id = self.push_edge(ends)?;
        self.edges.insert(ends, id);
        Ok(id)
    }

    /// Adds an edge, with the smaller vertex first, that [`Assembly::edge`] will not be asked for.
    pub(super) fn push_edge(&mut self, ends: [VertexId; 2]) -> Result<EdgeId, SceneProblem> {
        let id = EdgeId(next_id(self.data.edges.len(), "edges")?);
        self.data.edges.push(ends);
        Ok(id)
    }

    /// The plane through three vertices, which run counter-clockwise seen from the front of the
    /// facets on it.
    fn plane(&mut self, corners: [VertexId; 3]) -> Result<(PlaneId, Side), SceneProblem> {
        let triangle = corners.map(|v| self.data.vertices[v.index()]);
        let Some((axis, value)) = axis_plane(triangle) else {
            return Ok((self.add_plane(SupportingPlane::Points(corners))?, Side::Front));
        };
        let facing = if orientation(triangle, axis).is_positive() { Side::Front } else { Side::Back };
        Ok((self.add_plane(SupportingPlane::Axis { axis, value })?, facing))
    }

    /// Adds a plane; an axis-aligned one only if there is none yet.
    pub(super) fn add_plane(&mut self, plane: SupportingPlane) -> Result<PlaneId, SceneProblem> {
        let id = PlaneId(next_id(self.data.planes.len(), "planes")?);
        if let SupportingPlane::Axis { axis, value } = plane {
            let known = *self.axis_planes.entry((axis, value.to_bits())).or_insert(id);
            if known != id {
                return Ok(known);
            }
        }
        self.data.planes.push(plane);
        Ok(id)
    }
}

impl Data {
    /// Leaves out the vertices that no polygon names, and numbers the others anew, in the same order.
    pub(super) fn leave_out_unused_vertices(&mut self) {
        let mut used = vec![false; self.vertices.len()];
        for vertex in self.polygons.iter().flat_map(|polygon| &*polygon.rings).flatten() {
            used[vertex.index()] = true;
        }
        let mut ids = Vec::with_capacity(used.len());
        let mut kept = Vec::new();
        for (&position, used) in self.vertices.iter().zip(used) {
            // What is not used has no id that counts.
            ids.push(VertexId(kept.len() as u32));
            if used {
                kept.push(position);
            }
        }
        self.vertices = kept;
        let rings = self.polygons.iter_mut().flat_map(|polygon| Arc::make_mut(&mut polygon.rings)).flatten();
        let planes = self.planes.iter_mut().filter_map(|plane| match plane {
            SupportingPlane::Points(points) => Some(points),
            SupportingPlane::Axis { .. } => None,
        });
        let vertices = rings.chain(&mut self.piece_vertices).chain(self.edges.iter_mut().flatten());
        for vertex in vertices.chain(planes.flatten()) {
            *vertex = ids[vertex.index()];
        }
    }
}

/// The axis-aligned plane that a triangle with area lies in, if it does.
#[expect(clippy::float_cmp, reason = "a plane is axis-aligned if the coordinates are exactly equal")]
fn axis_plane([a, b, c]: [DVec3; 3]) -> Option<(Axis, f64)> {
    Axis::ALL.into_iter().find_map(|axis| {
        let k = axis as usize;
        (a[k] == b[k] && b[k] == c[k]).then(|| (axis, a[k]))
    })
}
