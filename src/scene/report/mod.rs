//! What a user should know about a mesh: where it is open, doubled, turned or badly joined.

mod clip;
mod components;
mod edges;
mod halves;
mod overlaps;
mod planarity;
mod planes;
mod t_junctions;
mod tree;
mod volume;

use super::corners::canonical;
use super::flat::distance;
use super::{PolygonId, Scene, Shape, VertexId};
use edges::Use;
use rustc_hash::FxHashMap;

/// The state of a scene's surfaces. None of it is an error; each may explain a surprising view.
///
/// Edges are those of the polygons' rings, without the diagonals of triangulations; polygons without area and those
/// dropped do not count as surfaces. What a [`Repair`](super::Repair) changed is in [`Scene::repairs`].
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct MeshReport {
    /// Edges along which a polygon has no neighbour, ascending. T-junctions leave such edges too.
    pub open_edges: Vec<OpenEdge>,
    /// Edges along which more than two boundaries run (non-manifold edges), ascending.
    pub crowded_edges: Vec<CrowdedEdge>,
    /// Edges of exactly two polygons whose fronts are on different sides, ascending.
    pub turned_edges: Vec<[VertexId; 2]>,
    /// Polygons that are not exactly planar, ascending.
    pub non_planar: Vec<NonPlanarPolygon>,
    /// Polygons without area, ascending.
    pub degenerate: Vec<PolygonId>,
    /// Polygons with the same corners as one before: that one and the later one, by the later one.
    pub duplicates: Vec<[PolygonId; 2]>,
    /// Vertices inside edges that they are no end of, by edge and vertex.
    pub t_junctions: Vec<TJunction>,
    /// False if the search for T-junctions was given up, with a hundred thousand found or after looking
    /// at a hundred million pairs: in a mesh, there are nearly none.
    pub all_t_junctions: bool,
    /// Surfaces that hang together along edges of exactly two polygons, by their first polygons.
    pub components: Vec<Component>,
    /// Polygons whose fronts are not on the side on which the greater part of their component, by area, has
    /// them, ascending.
    pub inverted: Vec<PolygonId>,
    /// Pairs of polygons that lie on each other in exactly one plane, by their numbers. Duplicates do.
    pub overlaps: Vec<CoplanarOverlap>,
    /// False if the search for overlaps was given up, with a hundred thousand found or after fifty million comparisons and
    /// two hundred more for each piece: many polygons in one plane that no lines tell apart.
    pub all_overlaps: bool,
}

/// An edge along which a polygon has no neighbour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenEdge {
    /// The edge, with the smaller vertex first.
    pub edge: [VertexId; 2],
    /// The polygon.
    pub polygon: PolygonId,
    /// Its length in scene units, rounded.
    pub length: f64,
}

/// An edge along which more than two boundaries run.
#[derive(Clone, Debug, PartialEq)]
pub struct CrowdedEdge {
    /// The edge, with the smaller vertex first.
    pub edge: [VertexId; 2],
    /// The polygons that meet there, each once, ascending.
    pub polygons: Vec<PolygonId>,
    /// Its length in scene units, rounded.
    pub length: f64,
}

/// A polygon that is not exactly planar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NonPlanarPolygon {
    /// The polygon.
    pub polygon: PolygonId,
    /// Half of its extent along its area normal, in scene units, rounded: no vertex is farther from the plane across
    /// that normal midway between the outermost ones. 0 if it is less than rounding.
    pub deviation: f64,
}

/// A vertex in the inside of an edge: two polygons meet there without sharing the edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TJunction {
    /// The edge.
    pub edge: [VertexId; 2],
    /// The vertex.
    pub vertex: VertexId,
    /// True if it lies on the edge exactly, false if within 1e-9 of the scene's diagonal: there is a crack.
    pub exact: bool,
    /// Its distance from the edge in scene units, rounded; 0 if it lies on it exactly.
    pub gap: f64,
}

/// Polygons that hang together: neighbours share an edge of exactly two boundaries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Component {
    /// Its polygon of the lowest number.
    pub first: PolygonId,
    /// How many polygons it consists of.
    pub polygons: usize,
    /// True if exactly two boundaries run along each of its edges.
    pub closed: bool,
    /// Whether the fronts of its polygons agree.
    pub orientation: Orientation,
    /// Whether its fronts are outside or inside, by the exact sign of its volume; `None` if it is not closed,
    /// if its fronts do not agree, or if it has no volume.
    pub fronts: Option<Fronts>,
    /// The volume that it encloses, in cubic scene units, rounded, negative if fronts are inside; `None` if it is not
    /// closed or if its fronts do not agree. Polygons that are not planar count as fans from their first vertices.
    pub volume: Option<f64>,
}

/// Whether the fronts of a [`Component`] agree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Orientation {
    /// Along every shared edge.
    Consistent,
    /// If some polygons are turned, which have less area than the others: they are [`MeshReport::inverted`].
    SomeInverted,
    /// If some polygons are turned, but which ones cannot be told: rounded areas are too close.
    Undecided,
    /// Not however its polygons are turned, as on a Moebius strip.
    NonOrientable,
}

/// Where the fronts of a closed [`Component`] are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Fronts {
    /// Outside: a solid.
    Outwards,
    /// Inside: a room, or a solid turned inside out.
    Inwards,
}

/// Two polygons with parts in exactly one plane whose insides share area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoplanarOverlap {
    /// The polygons, the lower number first.
    pub polygons: [PolygonId; 2],
    /// True if their fronts are on different sides (of polygons that are not planar: where most area is shared).
    pub opposed: bool,
    /// The area that they share, in square scene units, rounded.
    pub area: f64,
}

impl Scene {
    /// Looks over the mesh. Expected time n log n in the number of vertices, and linear in the number of vertices near edges and
    /// of pairs of pieces in one plane that lines do not separate, up to limits.
    ///
    /// ```
    /// use nusselt::scene::{Material, Scene};
    /// // A square with a vertex of a second one in the middle of its right edge.
    /// let vertices = [[0., 0., 0.], [2., 0., 0.], [2., 2., 0.], [0., 2., 0.], [2., 1., 0.], [3., 1., 0.], [3., 2., 0.]];
    /// let faces = [vec![0, 1, 2, 3], vec![4, 5, 6, 2]];
    /// let report = Scene::builder().mesh(&vertices, &faces, Material::new("grey")).build()?.report();
    /// assert_eq!(report.t_junctions.len(), 1);
    /// assert_eq!(report.open_edges.len(), 8);
    /// assert!(report.overlaps.is_empty());
    /// # Ok::<(), nusselt::scene::SceneError>(())
    /// ```
    pub fn report(&self) -> MeshReport {
        let mut report = MeshReport::default();
        let mut known: FxHashMap<_, PolygonId> = FxHashMap::default();
        for polygon in self.polygons() {
            let id = polygon.id();
            match polygon.shape() {
                Shape::NonPlanar => {
                    report.non_planar.push(NonPlanarPolygon { polygon: id, deviation: planarity::deviation(polygon) });
                }
                Shape::Degenerate => report.degenerate.push(id),
                Shape::Convex | Shape::Concave | Shape::Dropped => {}
            }
            if polygon.pieces().len() > 0 {
                let first = *known.entry(canonical(polygon.rings())).or_insert(id);
                if first != id {
                    report.duplicates.push([first, id]);
                }
            }
        }
        let uses = edges::uses(self);
        for group in uses.chunk_by(|a, b| a.edge == b.edge) {
            self.note_edge(group, &mut report);
        }
        let edges = uses.chunk_by(|a, b| a.edge == b.edge).map(|group| group[0].edge);
        (report.t_junctions, report.all_t_junctions) = t_junctions::t_junctions(self, edges);
        (report.components, report.inverted) = components::components(self, &uses);
        (report.overlaps, report.all_overlaps) = overlaps::overlaps(self);
        report
    }

    /// The pairs of polygons whose insides share area in one plane; false if there may be more.
    pub(crate) fn coplanar_overlaps(&self) -> (Vec<CoplanarOverlap>, bool) {
        overlaps::overlaps(self)
    }

    fn note_edge(&self, group: &[Use], report: &mut MeshReport) {
        let edge = group[0].edge;
        let length = || distance(self.vertex(edge[0]), self.vertex(edge[1]));
        match group {
            [only] => report.open_edges.push(OpenEdge { edge, polygon: only.polygon, length: length() }),
            [a, b] if a.against != b.against => {}
            [_, _] => report.turned_edges.push(edge),
            _ => {
                let mut polygons: Vec<_> = group.iter().map(|pass| pass.polygon).collect();
                polygons.dedup();
                report.crowded_edges.push(CrowdedEdge { edge, polygons, length: length() });
            }
        }
    }
}
