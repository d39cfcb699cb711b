//! Building a scene: collects everything, checks everything, reports every problem at once.

use super::assemble::{Assembly, next_id};
use super::facets::Facets;
use super::flat::box_diagonal;
use super::judge::{Broken, Judge};
use super::repair::{note_welding, snap};
use super::validate::{Counts, check_face, check_materials, check_vertices};
use super::weld::{Welded, merged, weld};
use super::{Data, DropCause, Dropped, Material, MaterialId, ObjectId, OrDrop, PolygonId, Repair, Repairs};
use super::{Scene, SceneError, SceneProblem};
use glam::DVec3;
use std::collections::HashMap;
use std::sync::Arc;

/// One face of the input.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceSpec {
    /// Its rings as indices of vertices: the outer one counter-clockwise seen from the front, then
    /// holes in either direction.
    pub rings: Vec<Vec<usize>>,
    /// The object it belongs to.
    pub object: ObjectId,
    /// Its material.
    pub material: MaterialId,
}

/// Collects vertices, faces, objects and materials for a [`Scene`].
///
/// ```
/// use nusselt::scene::{Material, Scene, Shape};
///
/// // A square, and an L-shaped roof above it.
/// let scene = Scene::builder()
///     .mesh(
///         &[[0., 0., 0.], [2., 0., 0.], [2., 2., 0.], [0., 2., 0.], [0., 0., 1.], [2., 0., 1.], [2., 1., 1.], [1., 1., 1.], [1., 2., 1.], [0., 2., 1.]],
///         &[vec![0, 1, 2, 3], vec![4, 5, 6, 7, 8, 9]],
///         Material::new("grey"),
///     )
///     .build()?;
/// let shapes: Vec<_> = scene.polygons().map(|polygon| polygon.shape()).collect();
/// assert_eq!(shapes, [Shape::Convex, Shape::Concave]);
/// assert_eq!(scene.piece_count(), 1 + 4);
///
/// // Every problem is reported, not only the first.
/// let faces = [vec![0, 1], vec![0, 1, 7]];
/// let error = Scene::builder().mesh(&[[0.; 3], [f64::NAN; 3]], &faces, Material::new("grey")).build();
/// assert_eq!(error.unwrap_err().problems.len(), 3);
/// # Ok::<(), nusselt::scene::SceneError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct SceneBuilder {
    vertices: Vec<DVec3>,
    faces: Vec<FaceSpec>,
    objects: Vec<String>,
    object_ids: HashMap<String, ObjectId>,
    materials: Vec<Material>,
    repair: Repair,
    /// What is wrong with faces that could not be read, by their numbers.
    unreadable: HashMap<usize, String>,
}

impl SceneBuilder {
    /// Adds a material.
    pub fn add_material(&mut self, material: Material) -> MaterialId {
        self.materials.push(material);
        MaterialId(self.materials.len() as u32 - 1)
    }

    /// The object of that name, added if there is none yet.
    pub fn add_object(&mut self, name: &str) -> ObjectId {
        if let Some(&known) = self.object_ids.get(name) {
            return known;
        }
        let id = ObjectId(self.objects.len() as u32);
        self.objects.push(name.to_owned());
        self.object_ids.insert(name.to_owned(), id);
        id
    }

    /// Adds a vertex and gives its index.
    pub fn add_vertex(&mut self, position: DVec3) -> usize {
        self.vertices.push(position);
        self.vertices.len() - 1
    }

    /// Adds a face; the k-th face added is polygon k.
    pub fn add_face(&mut self, face: FaceSpec) {
        self.faces.push(face);
    }

    /// Adds a face that cannot be read, for that reason: it keeps its number, and is a problem unless malformed faces are dropped.
    /// Its rings are what is known of it, if anything is: they tell how large it is.
    pub fn add_unreadable_face(&mut self, face: FaceSpec, why: String) {
        self.unreadable.insert(self.faces.len(), why);
        self.add_face(face);
    }

    /// Adds a mesh of simple faces in one go: object `default`, one material.
    #[must_use]
    pub fn mesh(mut self, vertices: &[[f64; 3]], faces: &[Vec<usize>], material: Material) -> Self {
        let material = self.add_material(material);
        let object = self.add_object("default");
        let first = self.vertices.len();
        self.vertices.extend(vertices.iter().map(|&p| DVec3::from(p)));
        for face in faces {
            let ring = face.iter().map(|&k| k.saturating_add(first)).collect();
            self.add_face(FaceSpec { rings: vec![ring], object, material });
        }
        self
    }

    /// Chooses what becomes of broken faces.
    ///
    /// ```
    /// use nusselt::scene::{Material, OrDrop, Repair, Scene, Shape};
    ///
    /// // A bow tie, and a square whose last corner has come off by a hair.
    /// let vertices = [[0., 0., 0.], [1., 1., 0.], [1., 0., 0.], [0., 1., 0.], [1e-6, 0., 0.]];
    /// let faces = [vec![0, 1, 2, 3], vec![4, 2, 1, 3]];
    /// let repair = Repair { self_crossing: OrDrop::Drop, weld: Some(1e-3), ..Repair::default() };
    /// let scene = Scene::builder().repair(repair).mesh(&vertices, &faces, Material::new("grey")).build()?;
    /// assert_eq!(scene.polygon(scene.repairs().dropped[0].polygon).shape(), Shape::Dropped);
    /// assert_eq!(scene.repairs().moved[0].vertex, 4);
    /// assert_eq!(scene.polygon_count(), 2);
    /// # Ok::<(), nusselt::scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn repair(mut self, repair: Repair) -> Self {
        self.repair = repair;
        self
    }

    /// Checks everything and builds the scene.
    ///
    /// Vertices with exactly equal coordinates become one, those that no face names are left out.
    /// Exactly planar and convex faces stay whole (those with more than 64 vertices are cut by diagonals),
    /// others are triangulated on their own vertices; faces without area stay as polygons without pieces; all else
    /// that is not as it should be is a problem. A [`Repair`] can choose otherwise. Expected time n log n in the
    /// size of the input, n log^2 n for concave rings.
    ///
    /// # Errors
    /// All problems of the input at once.
    pub fn build(self) -> Result<Scene, SceneError> {
        let mut problems = Vec::new();
        if self.repair.malformed == OrDrop::Reject {
            check_vertices(&self.vertices, &mut problems);
        }
        let mut data = self.assemble(&mut problems);
        check_materials(&self.materials, &mut problems);
        if !problems.is_empty() {
            return Err(SceneError { problems });
        }
        data.objects = self.objects;
        data.materials = self.materials;
        data.repair = self.repair;
        Ok(Scene { data: Arc::new(data) })
    }

    /// Builds all sound polygons, drops those that are to be dropped, and notes what is wrong with the others.
    fn assemble(&self, problems: &mut Vec<SceneProblem>) -> Data {
        let tolerance = self.repair.weld.unwrap_or(0.0);
        if !(tolerance.is_finite() && tolerance >= 0.0) {
            problems.push(SceneProblem::BadTolerance { tolerance });
            return Data::default();
        }
        if let Err(problem) = next_id(self.vertices.len(), "vertices") {
            problems.push(problem);
            return Data::default();
        }
        let used = self.used_vertices();
        let (positions, moved) = snap(&self.vertices, &used, tolerance);
        let Welded { vertices, ids } = weld(&positions, &used);
        let mut assembly = Assembly::new(vertices);
        let mut repairs = Repairs { moved, ..Repairs::default() };
        let mut judge = Judge::new(&self.repair);
        for (index, face) in self.faces.iter().enumerate() {
            let result = next_id(index, "polygons").map(PolygonId).and_then(|polygon| {
                let Some(verdict) = self.check(polygon, face, problems) else { return Ok(()) };
                let rings: Vec<_> = face.rings.iter().map(|ring| merged(ring, &ids)).collect();
                match verdict.and_then(|()| judge.judge(polygon, &rings, &assembly.data.vertices)) {
                    Ok(facets) => {
                        if !repairs.moved.is_empty() {
                            note_welding(polygon, face, facets.shape, [&self.vertices, &positions], &mut repairs);
                        }
                        assembly.add_polygon((face.object, face.material), rings, facets)
                    }
                    Err(Broken { problem, cause: None }) => {
                        problems.push(problem);
                        Ok(())
                    }
                    Err(Broken { problem, cause: Some(cause) }) => {
                        repairs.dropped.push(Dropped { polygon, cause, problem, size: self.size(face) });
                        assembly.add_polygon((face.object, face.material), Vec::new(), Facets::dropped())
                    }
                }
            });
            if let Err(too_large) = result {
                problems.push(too_large);
                break;
            }
        }
        let mut data = assembly.data;
        if !repairs.dropped.is_empty() {
            data.leave_out_unused_vertices();
        }
        data.repairs = repairs;
        data
    }

    /// The finite vertices that faces name. With a repair, malformed faces do not count: they will be dropped.
    fn used_vertices(&self) -> Vec<bool> {
        let is_fine = |&vertex: &usize| self.vertices.get(vertex).is_some_and(|p| p.is_finite());
        let mut used = vec![false; self.vertices.len()];
        for (index, face) in self.faces.iter().enumerate() {
            let is_read = || !self.unreadable.contains_key(&index);
            let is_whole = || face.rings.iter().all(|ring| ring.len() >= 3 && ring.iter().all(is_fine));
            if self.repair.malformed == OrDrop::Reject || is_read() && is_whole() {
                for &vertex in face.rings.iter().flatten().filter(|vertex| is_fine(vertex)) {
                    used[vertex] = true;
                }
            }
        }
        used
    }

    /// Checks what a face names. `None` if what is wrong with it is noted already.
    fn check(
        &self,
        polygon: PolygonId,
        face: &FaceSpec,
        problems: &mut Vec<SceneProblem>,
    ) -> Option<Result<(), Broken>> {
        let counts =
            Counts { vertices: self.vertices.len(), objects: self.objects.len(), materials: self.materials.len() };
        let mut found = Vec::new();
        let mut is_sound = check_face(polygon, face, counts, &mut found);
        // Names of objects and materials are no matter of the face's shape: they are problems all the same.
        let is_shape = |problem: &SceneProblem| {
            use SceneProblem::{TooFewVertices, UnknownVertex, Unreadable};
            matches!(problem, TooFewVertices { .. } | UnknownVertex { .. } | Unreadable { .. })
        };
        if let Some(why) = self.unreadable.get(&polygon.index()) {
            let unreadable = SceneProblem::Unreadable { polygon, what: why.clone() };
            // That says it all.
            found.retain(|problem| !is_shape(problem));
            found.insert(0, unreadable);
            is_sound = false;
        }
        let infinite = face.rings.iter().flatten().find(|&&v| self.vertices.get(v).is_some_and(|p| !p.is_finite()));
        if self.repair.malformed == OrDrop::Reject || (is_sound && infinite.is_none()) {
            problems.extend(found);
            return (is_sound && infinite.is_none()).then_some(Ok(()));
        }
        let (shape, names): (Vec<_>, Vec<_>) = found.into_iter().partition(is_shape);
        problems.extend(names);
        let infinite = infinite.map(|&vertex| SceneProblem::NotFinite { vertex });
        let problem = shape.into_iter().next().or(infinite)?;
        Some(Err(Broken { problem, cause: Some(DropCause::Malformed) }))
    }

    /// The diagonal of the box around the vertices of a face that exist and are finite.
    fn size(&self, face: &FaceSpec) -> f64 {
        let positions = face.rings.iter().flatten().filter_map(|&v| self.vertices.get(v));
        box_diagonal(positions.copied().filter(|p| p.is_finite()))
    }
}
