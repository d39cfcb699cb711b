//! Scenes with objects moved: what moves is judged anew, all else is taken over.

mod vertices;

use super::assemble::{Assembly, next_id};
use super::facets::Facets;
use super::flat::box_diagonal;
use super::judge::{Broken, Judge};
use super::weld::without_repeats;
use super::{
    Data, Dropped, DuplicatePolicy, EdgeId, ObjectId, Piece, PieceId, PlaneId, Polygon, PolygonId, Scene, SceneError,
    SceneProblem, Shape, SupportingPlane, VertexId,
};
use crate::exact::orient3d;
use glam::{DAffine3, DVec3};
use std::sync::Arc;
use vertices::Places;

/// Why objects cannot be moved.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MoveError {
    /// An object that is not in the scene.
    #[error("object {object} is to move, but there are {count} objects")]
    UnknownObject {
        /// The object.
        object: ObjectId,
        /// How many there are.
        count: usize,
    },
    /// An object that two transforms are given for.
    #[error("object {object} is to move twice; multiply its transforms")]
    MovedTwice {
        /// The object.
        object: ObjectId,
    },
    /// A transform with a number that is infinite or not a number.
    #[error("the transform of object {object} is not finite")]
    NotFinite {
        /// The object.
        object: ObjectId,
    },
    /// Coordinates that are too large for f64 after the move.
    #[error("object {object} is to move farther than numbers reach")]
    Overflow {
        /// The object.
        object: ObjectId,
    },
    /// Polygons that are broken where they come to be: all of them. The [`Repair`](super::Repair) that the scene was built with decides.
    #[error(transparent)]
    Broken(#[from] SceneError),
}

/// What a scene with objects moved has of the scene before: of all that is in it the number it had, if it was there and
/// has not moved.
#[derive(Debug, Default)]
pub(crate) struct Carried {
    pub(crate) edges: Vec<Option<EdgeId>>,
    pub(crate) planes: Vec<Option<PlaneId>>,
    pub(crate) pieces: Vec<Option<PieceId>>,
}

impl Scene {
    /// The scene with objects moved, each by a transform. Numbers of polygons, objects and materials stay, this scene too.
    ///
    /// It is the scene that a [`SceneBuilder`](super::SceneBuilder) makes of the moved coordinates, in time proportional to
    /// what moves, and for copying what does not. Coordinates are rounded to f64, so that a quad that is turned need not
    /// stay planar: the polygons of the moved objects are judged anew, also by the [`Repair`](super::Repair) that the scene was
    /// built with, but for welding within a tolerance. Roundings add up from move to move: for an animation, move the first
    /// scene each time instead of the last one.
    ///
    /// - Vertices that an object shares with what does not move stay where they are; the object gets its own. Vertices that come
    ///   to have equal coordinates are one, as always: corners of a polygon that coincide are one from then on, and no later move
    ///   parts them. A polygon that is dropped does not come back, whatever moves.
    /// - A transform that mirrors keeps the sides: the rings run the other way around from their first vertices. One that
    ///   flattens is taken too; what has no area then hides nothing.
    ///
    /// ```
    /// use glam::{DAffine3, DVec3};
    /// use nusselt::scene::{FaceSpec, Material, ObjectId, PolygonId, Scene, Shape};
    ///
    /// let mut builder = Scene::builder();
    /// let grey = builder.add_material(Material::new("grey"));
    /// for (object, z) in [("floor", 0.0), ("table", 1.0)] {
    ///     let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    ///     let ring = corners.map(|[x, y]| builder.add_vertex(DVec3::new(x, y, z))).to_vec();
    ///     let object = builder.add_object(object);
    ///     builder.add_face(FaceSpec { rings: vec![ring], object, material: grey });
    /// }
    /// let scene = builder.build()?;
    /// let table = ObjectId(1);
    ///
    /// let lower = scene.with_moved(&[(table, DAffine3::from_translation(DVec3::Z * -0.25))])?;
    /// let heights: Vec<f64> = lower.vertices().iter().map(|p| p.z).collect();
    /// assert_eq!(heights, [0.0, 0.0, 0.0, 0.0, 0.75, 0.75, 0.75, 0.75]);
    ///
    /// // Turned by an odd angle its corners are rounded, each on its own: it takes two triangles.
    /// let tilted = scene.with_moved(&[(table, DAffine3::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 0.1))])?;
    /// assert_eq!(tilted.polygon(PolygonId(0)).shape(), Shape::Convex);
    /// assert!(tilted.polygon(PolygonId(1)).pieces().len() <= 2);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If there is no such object, if one is named twice, if a transform is not finite or coordinates overflow, or if polygons are
    /// not as they should be where they come to be.
    pub fn with_moved(&self, moves: &[(ObjectId, DAffine3)]) -> Result<Self, MoveError> {
        Ok(self.carried_over(moves)?.0)
    }

    /// The same, with what it has of this scene.
    pub(crate) fn carried_over(&self, moves: &[(ObjectId, DAffine3)]) -> Result<(Self, Carried), MoveError> {
        let old = &*self.data;
        let moves = Moves::new(moves, old.objects.len())?;
        let places = Places::new(old, &moves)?;
        let mut replay = Replay::new(old, places);
        replay.run(&moves)?;
        Ok(replay.finish())
    }
}

/// A transform of one object.
struct Move {
    object: ObjectId,
    transform: DAffine3,
    mirrors: bool,
}

/// The transforms, and for each object which is its.
struct Moves {
    all: Vec<Move>,
    of_object: Vec<Option<u32>>,
}

impl Moves {
    fn new(moves: &[(ObjectId, DAffine3)], count: usize) -> Result<Self, MoveError> {
        let mut of_object = vec![None; count];
        let mut all = Vec::with_capacity(moves.len());
        for &(object, transform) in moves {
            let place = of_object.get_mut(object.index()).ok_or(MoveError::UnknownObject { object, count })?;
            if place.replace(all.len() as u32).is_some() {
                return Err(MoveError::MovedTwice { object });
            }
            if !transform.is_finite() {
                return Err(MoveError::NotFinite { object });
            }
            let axes = transform.matrix3;
            let mirrors = orient3d(DVec3::ZERO, axes.x_axis, axes.y_axis, axes.z_axis).is_negative();
            all.push(Move { object, transform, mirrors });
        }
        Ok(Self { all, of_object })
    }

    /// The number of the move of a polygon.
    fn of(&self, polygon: &Polygon) -> Option<u32> {
        self.of_object[polygon.object.index()]
    }
}

/// The old scene's polygons put together once more, in order.
struct Replay<'a> {
    old: &'a Data,
    places: Places,
    assembly: Assembly,
    /// The new numbers of old edges and planes that do not move, as far as they have come up.
    edges: Vec<Option<EdgeId>>,
    planes: Vec<Option<PlaneId>>,
    carried: Carried,
}

impl<'a> Replay<'a> {
    fn new(old: &'a Data, mut places: Places) -> Self {
        Self {
            old,
            assembly: Assembly::with_room_for(std::mem::take(&mut places.positions), old),
            places,
            edges: vec![None; old.edges.len()],
            planes: vec![None; old.planes.len()],
            carried: Carried {
                edges: vec![None; old.edges.len()],
                planes: vec![None; old.planes.len()],
                pieces: vec![None; old.pieces.len()],
            },
        }
    }

    fn run(&mut self, moves: &Moves) -> Result<(), SceneError> {
        let old = self.old;
        let mut judge = Judge::new(&old.repair);
        let mut problems = Vec::new();
        let mut dropped = Vec::new();
        for (k, polygon) in old.polygons.iter().enumerate() {
            let id = PolygonId(k as u32);
            let result = match moves.of(polygon) {
                Some(number) => self.judge(id, polygon, (number, &moves.all[number as usize]), &mut judge),
                None => self.carry(id, polygon, &mut judge),
            };
            let broken = match result {
                Ok(()) => continue,
                Err(broken) => broken,
            };
            let Some(cause) = broken.cause else {
                problems.push(broken.problem);
                continue;
            };
            let size = box_diagonal(self.rings(polygon, moves.of(polygon)).iter().flatten().map(|&v| self.position(v)));
            dropped.push(Dropped { polygon: id, cause, problem: broken.problem, size });
            let owner = (polygon.object, polygon.material);
            if let Err(problem) = self.assembly.add_polygon(owner, Vec::new(), Facets::dropped()) {
                problems.push(problem);
            }
        }
        if !problems.is_empty() {
            return Err(SceneError { problems });
        }
        let data = &mut self.assembly.data;
        if !dropped.is_empty() {
            data.leave_out_unused_vertices();
        }
        data.repairs = old.repairs.clone();
        data.repairs.dropped.extend(dropped);
        data.repairs.dropped.sort_by_key(|dropped| dropped.polygon);
        Ok(())
    }

    /// Adds a polygon that moves.
    fn judge(
        &mut self,
        id: PolygonId,
        polygon: &Polygon,
        (number, change): (u32, &Move),
        judge: &mut Judge<'_>,
    ) -> Result<(), Broken> {
        let owner = (polygon.object, polygon.material);
        let mut rings = self.rings(polygon, Some(number));
        if polygon.shape == Shape::Dropped {
            return Ok(self.assembly.add_polygon(owner, rings, Facets::dropped())?);
        }
        for ring in &mut rings {
            *ring = without_repeats(std::mem::take(ring));
            if change.mirrors && !ring.is_empty() {
                ring[1..].reverse();
            }
        }
        let facets = judge.judge(id, &rings, &self.assembly.data.vertices)?;
        Ok(self.assembly.add_polygon(owner, rings, facets)?)
    }

    /// Adds a polygon that stays as it is.
    fn carry(&mut self, id: PolygonId, polygon: &Polygon, judge: &mut Judge<'_>) -> Result<(), Broken> {
        let is_same = polygon.rings.iter().flatten().all(|&v| self.places.stays(v) == v);
        let rings = if is_same { Arc::clone(&polygon.rings) } else { self.rings(polygon, None).into() };
        // Only what has come to it may be the same.
        if self.old.repair.duplicates != DuplicatePolicy::Keep
            && !polygon.pieces.is_empty()
            && rings.iter().flatten().all(|&v| self.places.is_approached(v))
        {
            judge.check_duplicate(id, &rings)?;
        }
        let first = next_id(self.assembly.data.pieces.len(), "pieces")?;
        for piece in polygon.pieces.clone() {
            self.carry_piece(PieceId(piece), &self.old.pieces[piece as usize])?;
        }
        let pieces = first..self.assembly.data.pieces.len() as u32;
        self.assembly.data.polygons.push(Polygon { rings, pieces, ..*polygon });
        Ok(())
    }

    fn carry_piece(&mut self, id: PieceId, piece: &Piece) -> Result<(), SceneProblem> {
        next_id(self.assembly.data.pieces.len(), "pieces")?;
        let start = next_id(self.assembly.data.piece_vertices.len(), "corners of pieces")?;
        let plane = self.carry_plane(piece.plane)?;
        let range = piece.start as usize..(piece.start + piece.len) as usize;
        for k in range {
            let vertex = self.places.stays(self.old.piece_vertices[k]);
            let edge = self.carry_edge(self.old.piece_edges[k])?;
            self.assembly.data.piece_vertices.push(vertex);
            self.assembly.data.piece_edges.push(edge);
        }
        next_id(self.assembly.data.piece_vertices.len(), "corners of pieces")?;
        note(&mut self.carried.pieces, self.assembly.data.pieces.len(), id);
        self.assembly.data.pieces.push(Piece { plane, start, ..*piece });
        Ok(())
    }

    fn carry_edge(&mut self, id: EdgeId) -> Result<EdgeId, SceneProblem> {
        if let Some(known) = self.edges[id.index()] {
            return Ok(known);
        }
        // The order of vertices that stay does not change.
        let ends = self.old.edges[id.index()].map(|v| self.places.stays(v));
        let edge = if ends.iter().all(|&v| self.places.is_approached(v)) {
            self.assembly.edge(ends[0], ends[1])?
        } else {
            self.assembly.push_edge(ends)?
        };
        self.edges[id.index()] = Some(edge);
        note(&mut self.carried.edges, edge.index(), id);
        Ok(edge)
    }

    fn carry_plane(&mut self, id: PlaneId) -> Result<PlaneId, SceneProblem> {
        if let Some(known) = self.planes[id.index()] {
            return Ok(known);
        }
        let plane = self.assembly.add_plane(match self.old.planes[id.index()] {
            SupportingPlane::Points(points) => SupportingPlane::Points(points.map(|v| self.places.stays(v))),
            axis @ SupportingPlane::Axis { .. } => axis,
        })?;
        self.planes[id.index()] = Some(plane);
        note(&mut self.carried.planes, plane.index(), id);
        Ok(plane)
    }

    /// The rings of a polygon in new numbers, for the move it takes part in.
    fn rings(&self, polygon: &Polygon, number: Option<u32>) -> Vec<Vec<VertexId>> {
        let place = |&v: &VertexId| match number {
            Some(number) => self.places.moved(v, number),
            None => self.places.stays(v),
        };
        polygon.rings.iter().map(|ring| ring.iter().map(place).collect()).collect()
    }

    fn position(&self, vertex: VertexId) -> DVec3 {
        self.assembly.data.vertices[vertex.index()]
    }

    fn finish(self) -> (Scene, Carried) {
        let Self { old, assembly, mut carried, .. } = self;
        let mut data = assembly.data;
        carried.edges.resize(data.edges.len(), None);
        carried.planes.resize(data.planes.len(), None);
        carried.pieces.resize(data.pieces.len(), None);
        data.objects.clone_from(&old.objects);
        data.materials.clone_from(&old.materials);
        data.repair = old.repair;
        (Scene { data: Arc::new(data) }, carried)
    }
}

/// Notes which number something had before.
fn note<T: Copy>(before: &mut Vec<Option<T>>, place: usize, id: T) {
    if before.len() <= place {
        before.resize(place + 1, None);
    }
    before[place] = Some(id);
}

impl From<SceneProblem> for Broken {
    fn from(problem: SceneProblem) -> Self {
        Self { problem, cause: None }
    }
}
