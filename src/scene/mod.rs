//! Scenes: planar polygons with names and materials, checked once and then immutable.
//!
//! A polygon of the input keeps its number for good. Inside it is one or more *pieces*: convex,
//! exactly planar facets. A polygon that is exactly planar and convex is one piece, or a few
//! if it has more than 64 vertices; any other is triangulated; a polygon without area has none, nor has one that a
//! [`Repair`] dropped.

mod assemble;
mod builder;
mod corners;
mod facets;
mod flat;
mod judge;
mod material;
mod moved;
mod origin;
mod problem;
mod repair;
mod report;
mod splitter;
mod triangulate;
mod validate;
mod weld;

pub use builder::{FaceSpec, SceneBuilder};
pub use material::{Material, MetallicRoughness};
pub use moved::MoveError;
pub use problem::{SceneError, SceneProblem};
pub use repair::{
    DropCause, Dropped, DuplicatePolicy, MovedVertex, NonPlanarPolicy, OrDrop, Repair, RepairSpecError, Repairs,
    ZeroAreaPolicy,
};
pub use report::{
    Component, CoplanarOverlap, CrowdedEdge, Fronts, MeshReport, NonPlanarPolygon, OpenEdge, Orientation, TJunction,
};
pub use splitter::Splitter;

pub(crate) use flat::unit_scale;
pub(crate) use moved::Carried;
pub(crate) use origin::origin_near;

use glam::DVec3;
use std::ops::Range;
use std::sync::Arc;

macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub u32);

        impl $name {
            /// The number as an index.
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                self.0.fmt(f)
            }
        }
    };
}

id!(
    /// A vertex of the scene. Vertices with equal coordinates are one vertex (-0 = +0).
    VertexId
);
id!(
    /// A straight edge between two vertices of one or more pieces, diagonals of triangulations included.
    EdgeId
);
id!(
    /// A polygon: the k-th face of the input, from 0.
    PolygonId
);
id!(
    /// A convex, exactly planar facet of a polygon.
    PieceId
);
id!(
    /// A supporting plane. Pieces in one axis-aligned plane share it.
    PlaneId
);
id!(
    /// A named object.
    ObjectId
);
id!(
    /// A material.
    MaterialId
);

/// A coordinate axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Axis {
    /// The first coordinate.
    X = 0,
    /// The second coordinate.
    Y = 1,
    /// The third coordinate.
    Z = 2,
}

impl Axis {
    /// All three, in order.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];
}

/// A plane, defined exactly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SupportingPlane {
    /// All points whose coordinate on `axis` is `value`; its front is the side of larger coordinates.
    Axis {
        /// The axis the plane is perpendicular to.
        axis: Axis,
        /// The coordinate of its points.
        value: f64,
    },
    /// The plane through three vertices that are not collinear; its front is the side from which
    /// they run counter-clockwise.
    Points([VertexId; 3]),
}

impl SupportingPlane {
    /// The three vertices, if it is given by those.
    pub fn points(&self) -> Option<[VertexId; 3]> {
        match *self {
            Self::Points(points) => Some(points),
            Self::Axis { .. } => None,
        }
    }
}

/// Which side of a polygon is meant or seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Side {
    /// The side from which the vertices run counter-clockwise.
    Front,
    /// The other one.
    Back,
}

impl Side {
    /// The side opposite to this one.
    #[must_use]
    pub fn opposite(self) -> Self {
        match self {
            Self::Front => Self::Back,
            Self::Back => Self::Front,
        }
    }
}

/// Why a polygon is not one whole piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shape {
    /// Exactly planar and convex (exactly collinear vertices allowed): one piece, or with more than 64
    /// vertices, pieces of at most 64, cut by diagonals, all in one plane.
    Convex,
    /// Exactly planar, but concave or with holes: triangulated.
    Concave,
    /// Not exactly planar: triangulated.
    NonPlanar,
    /// No area: no piece; hides nothing.
    Degenerate,
    /// Dropped by a [`Repair`]: neither rings nor pieces; hides nothing.
    Dropped,
}

#[derive(Clone, Debug, PartialEq)]
struct Polygon {
    object: ObjectId,
    material: MaterialId,
    shape: Shape,
    /// Outer ring first, then holes, as vertex ids; consecutive duplicates removed. Shared with scenes in which it is the same.
    rings: Arc<[Vec<VertexId>]>,
    pieces: Range<u32>,
}

#[derive(Clone, Debug, PartialEq)]
struct Piece {
    polygon: PolygonId,
    plane: PlaneId,
    /// The side of the plane on which the piece's front is.
    facing: Side,
    /// Its boundary in `piece_vertices` and `piece_edges`.
    start: u32,
    len: u32,
}

#[derive(Debug, Default, PartialEq)]
struct Data {
    vertices: Vec<DVec3>,
    edges: Vec<[VertexId; 2]>,
    planes: Vec<SupportingPlane>,
    polygons: Vec<Polygon>,
    pieces: Vec<Piece>,
    piece_vertices: Vec<VertexId>,
    piece_edges: Vec<EdgeId>,
    objects: Vec<String>,
    materials: Vec<Material>,
    /// What becomes of broken faces, also when they move.
    repair: Repair,
    repairs: Repairs,
}

/// A checked, immutable scene. Cloning it is cheap: clones share their data.
#[derive(Clone, Debug)]
pub struct Scene {
    data: Arc<Data>,
}

impl Scene {
    /// Starts an empty scene.
    pub fn builder() -> SceneBuilder {
        SceneBuilder::default()
    }

    /// The vertices, each once.
    pub fn vertices(&self) -> &[DVec3] {
        &self.data.vertices
    }

    /// The position of a vertex.
    pub fn vertex(&self, id: VertexId) -> DVec3 {
        self.data.vertices[id.index()]
    }

    /// The edges, each once, with the smaller vertex id first.
    pub fn edges(&self) -> &[[VertexId; 2]] {
        &self.data.edges
    }

    /// The supporting planes of the pieces.
    pub fn planes(&self) -> &[SupportingPlane] {
        &self.data.planes
    }

    /// The number of polygons, those without area and those dropped included.
    pub fn polygon_count(&self) -> usize {
        self.data.polygons.len()
    }

    /// A polygon by its number.
    ///
    /// # Panics
    /// If there is no polygon of that number.
    pub fn polygon(&self, id: PolygonId) -> PolygonRef<'_> {
        PolygonRef { scene: self, id, polygon: &self.data.polygons[id.index()] }
    }

    /// All polygons, in order of their numbers.
    pub fn polygons(&self) -> impl ExactSizeIterator<Item = PolygonRef<'_>> {
        (0..self.data.polygons.len() as u32).map(|k| self.polygon(PolygonId(k)))
    }

    /// The number of pieces.
    pub fn piece_count(&self) -> usize {
        self.data.pieces.len()
    }

    /// A piece by its id.
    ///
    /// # Panics
    /// If there is no such piece.
    pub fn piece(&self, id: PieceId) -> PieceRef<'_> {
        PieceRef { scene: self, id, piece: &self.data.pieces[id.index()] }
    }

    /// All pieces, grouped by polygon, in order.
    pub fn pieces(&self) -> impl ExactSizeIterator<Item = PieceRef<'_>> {
        (0..self.data.pieces.len() as u32).map(|k| self.piece(PieceId(k)))
    }

    /// The names of the objects, in order of first appearance.
    pub fn objects(&self) -> &[String] {
        &self.data.objects
    }

    /// The materials.
    pub fn materials(&self) -> &[Material] {
        &self.data.materials
    }

    /// What the builder's [`Repair`] changed; empty by default.
    pub fn repairs(&self) -> &Repairs {
        &self.data.repairs
    }

    /// The smallest axis-aligned box around all vertices, as its least and greatest corner; `None`
    /// for a scene without vertices.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let mut vertices = self.data.vertices.iter().copied();
        let first = vertices.next()?;
        Some(vertices.fold((first, first), |(low, high), p| (low.min(p), high.max(p))))
    }

    /// The length of the diagonal of [`Scene::bounds`]; 0 for an empty scene, the largest f64 if it is
    /// longer than that.
    pub fn diagonal(&self) -> f64 {
        let Some((low, high)) = self.bounds() else { return 0.0 };
        // Halves cannot overflow, and squares of what is at most 1 do not.
        let half = high * 0.5 - low * 0.5;
        let most = half.max_element();
        if most == 0.0 { 0.0 } else { ((half / most).length() * most * 2.0).min(f64::MAX) }
    }
}

/// A polygon of a [`Scene`].
#[derive(Clone, Copy, Debug)]
pub struct PolygonRef<'a> {
    scene: &'a Scene,
    id: PolygonId,
    polygon: &'a Polygon,
}

impl<'a> PolygonRef<'a> {
    /// Its number.
    pub fn id(self) -> PolygonId {
        self.id
    }

    /// The object it belongs to.
    pub fn object(self) -> ObjectId {
        self.polygon.object
    }

    /// The name of the object it belongs to.
    pub fn object_name(self) -> &'a str {
        &self.scene.data.objects[self.polygon.object.index()]
    }

    /// Its material's id.
    pub fn material_id(self) -> MaterialId {
        self.polygon.material
    }

    /// Its material.
    pub fn material(self) -> &'a Material {
        &self.scene.data.materials[self.polygon.material.index()]
    }

    /// Whether it is whole, triangulated, without area or dropped.
    pub fn shape(self) -> Shape {
        self.polygon.shape
    }

    /// Its rings: the outer one first, then the holes; none if it was dropped.
    /// Consecutive equal vertices are merged.
    pub fn rings(self) -> &'a [Vec<VertexId>] {
        &self.polygon.rings
    }

    /// Its pieces; none if it has no area or was dropped.
    pub fn pieces(self) -> impl ExactSizeIterator<Item = PieceRef<'a>> {
        let scene = self.scene;
        self.polygon.pieces.clone().map(move |k| scene.piece(PieceId(k)))
    }
}

/// A convex, exactly planar facet of a polygon of a [`Scene`].
#[derive(Clone, Copy, Debug)]
pub struct PieceRef<'a> {
    scene: &'a Scene,
    id: PieceId,
    piece: &'a Piece,
}

impl<'a> PieceRef<'a> {
    /// The scene it is part of.
    pub fn scene(self) -> &'a Scene {
        self.scene
    }

    /// Its id.
    pub fn id(self) -> PieceId {
        self.id
    }

    /// The polygon it is part of.
    pub fn polygon(self) -> PolygonId {
        self.piece.polygon
    }

    /// The id of its supporting plane.
    pub fn plane_id(self) -> PlaneId {
        self.piece.plane
    }

    /// Its supporting plane.
    pub fn plane(self) -> SupportingPlane {
        self.scene.data.planes[self.piece.plane.index()]
    }

    /// The side of the supporting plane from which its vertices run counter-clockwise.
    pub fn facing(self) -> Side {
        self.piece.facing
    }

    /// Its vertices, counter-clockwise seen from its front. Three consecutive ones may be exactly
    /// collinear.
    pub fn vertices(self) -> &'a [VertexId] {
        &self.scene.data.piece_vertices[self.range()]
    }

    /// Its edges: number `k` joins vertex `k` with vertex `k + 1`, cyclically.
    pub fn edges(self) -> &'a [EdgeId] {
        &self.scene.data.piece_edges[self.range()]
    }

    /// The positions of its vertices.
    pub fn points(self) -> impl ExactSizeIterator<Item = DVec3> + 'a {
        let scene = self.scene;
        self.vertices().iter().map(move |&v| scene.vertex(v))
    }

    fn range(self) -> Range<usize> {
        let start = self.piece.start as usize;
        start..start + self.piece.len as usize
    }
}
