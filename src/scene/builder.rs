//! Building a scene: collects everything, checks everything, reports every problem at once.

use super::assemble::{Assembly, next_id};
use super::facets::facets;
use super::triangulate::{Fault, RANGE};
use super::validate::{Counts, check_face, check_materials, check_vertices};
use super::weld::{Welded, merged, weld};
use super::{Data, Material, MaterialId, ObjectId, PolygonId, Scene, SceneError, SceneProblem};
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

    /// Checks everything and builds the scene.
    ///
    /// Vertices with exactly equal coordinates become one, those that no face names are left out.
    /// Exactly planar and convex faces stay whole (those with more than 64 vertices are cut by diagonals),
    /// others are triangulated on their own vertices; faces without area stay as polygons without pieces. Expected time n log n in the size of the input,
    /// n log^2 n for concave rings.
    ///
    /// # Errors
    /// All problems of the input at once.
    pub fn build(self) -> Result<Scene, SceneError> {
        let mut problems = Vec::new();
        check_vertices(&self.vertices, &mut problems);
        let mut data = self.assemble(&mut problems);
        check_materials(&self.materials, &mut problems);
        if !problems.is_empty() {
            return Err(SceneError { problems });
        }
        data.objects = self.objects;
        data.materials = self.materials;
        Ok(Scene { data: Arc::new(data) })
    }

    /// Builds all sound polygons and notes what is wrong with the others.
    fn assemble(&self, problems: &mut Vec<SceneProblem>) -> Data {
        let counts =
            Counts { vertices: self.vertices.len(), objects: self.objects.len(), materials: self.materials.len() };
        if let Err(problem) = next_id(counts.vertices, "vertices") {
            problems.push(problem);
            return Data::default();
        }
        let mut used = vec![false; counts.vertices];
        for &vertex in self.faces.iter().flat_map(|face| &face.rings).flatten() {
            if let Some(used) = used.get_mut(vertex) {
                *used = self.vertices[vertex].is_finite();
            }
        }
        let Welded { vertices, ids } = weld(&self.vertices, &used);
        let mut assembly = Assembly::new(vertices);
        for (index, face) in self.faces.iter().enumerate() {
            let result = next_id(index, "polygons").and_then(|index| {
                let polygon = PolygonId(index);
                let is_sound = check_face(polygon, face, counts, problems);
                if !is_sound || face.rings.iter().flatten().any(|&vertex| ids[vertex].is_none()) {
                    return Ok(());
                }
                let rings: Vec<_> = face.rings.iter().map(|ring| merged(ring, &ids)).collect();
                match facets(&rings, &assembly.data.vertices) {
                    Ok(facets) => assembly.add_polygon(face, rings, facets)?,
                    Err(fault) => problems.push(fault_of(polygon, fault)),
                }
                Ok(())
            });
            if let Err(too_large) = result {
                problems.push(too_large);
                break;
            }
        }
        assembly.data
    }
}

fn fault_of(polygon: PolygonId, fault: Fault) -> SceneProblem {
    match fault {
        Fault::Crossing => SceneProblem::SelfCrossing { polygon },
        Fault::HoleOutside => SceneProblem::HoleOutside { polygon },
        Fault::TooMuchWork => SceneProblem::TooMuchWork { polygon },
        Fault::OutOfRange => SceneProblem::OutOfRange { polygon, limit: RANGE },
    }
}
