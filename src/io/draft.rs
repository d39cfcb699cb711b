//! A scene as a reader gathers it, and the step in which all readers end.

use super::error::{Faults, Place};
use super::{Loaded, ReadError, ReadOptions};
use crate::scene::{DropCause, FaceSpec, MaterialId, ObjectId, OrDrop, Scene, SceneBuilder, SceneProblem, Shape};
use glam::DVec3;
use std::fmt::Display;

/// What has been read so far: the faces in the order of the file, what is wrong, what is worth a warning.
pub(super) struct Draft<'a> {
    name: &'a str,
    pub(super) builder: SceneBuilder,
    pub(super) faults: Faults,
    pub(super) warnings: Vec<String>,
    /// Whether malformed faces are left to the builder, which drops them.
    pub(super) drops: bool,
    /// If they are: the place of the first fault of a vertex or a face, what is wrong, and how many there are.
    unusable: Option<(Place, String)>,
    unusable_count: usize,
    /// The last vertex that cannot be used, in the same words.
    bad_vertex: Option<(Place, String)>,
    has_bad_vertices: bool,
    /// A vertex for faces that cannot be used.
    stand_in: Option<usize>,
}

impl<'a> Draft<'a> {
    /// Nothing yet, from a file of that name.
    pub(super) fn new(name: &'a str, options: &ReadOptions) -> Self {
        Self {
            name,
            builder: Scene::builder().repair(options.repair),
            faults: Faults::default(),
            warnings: Vec::new(),
            drops: options.repair.malformed == OrDrop::Drop,
            unusable: None,
            unusable_count: 0,
            bad_vertex: None,
            has_bad_vertices: false,
            stand_in: None,
        }
    }

    /// What messages call the file.
    #[cfg(feature = "gltf")]
    pub(super) fn name(&self) -> &'a str {
        self.name
    }

    /// Notes what is wrong: there will be no scene.
    pub(super) fn fault(&mut self, place: Place, what: impl Display) {
        self.faults.note(self.name, place, what);
    }

    /// Notes what is wrong with a vertex: its coordinates must not be finite. Faces cannot be judged then, unless those that name
    /// it are dropped. The same fault in the same place is one, for places may be triangles.
    pub(super) fn refuse_vertex(&mut self, place: Place, what: impl Display) {
        self.has_bad_vertices |= !self.drops;
        let fault = (place, what.to_string());
        if self.bad_vertex.as_ref() != Some(&fault) {
            self.refuse(fault.0.clone(), &fault.1);
            self.bad_vertex = Some(fault);
        }
    }

    /// Notes what is wrong with a vertex or a face: a fault, unless malformed faces are dropped.
    fn refuse(&mut self, place: Place, what: impl Display) {
        if !self.drops {
            self.faults.note_cause(DropCause::Malformed);
            return self.fault(place, what);
        }
        self.unusable_count += 1;
        let is_first = match (&self.unusable, &place) {
            (None, _) => true,
            (Some((Place::Line(first), _)), Place::Line(line)) => line < first,
            _ => false,
        };
        if is_first {
            self.unusable = Some((place, what.to_string()));
        }
    }

    /// Notes what a user should know.
    pub(super) fn warn(&mut self, place: &Place, what: impl Display) {
        self.warnings.push(format!("{}: {what}", place.within(self.name)));
    }

    /// Adds a vertex, which is a fault if it is not finite.
    pub(super) fn add_vertex(&mut self, position: DVec3, place: impl FnOnce() -> Place) -> usize {
        if !position.is_finite() {
            self.refuse_vertex(place(), "a coordinate is not finite; correct it");
        }
        self.builder.add_vertex(position)
    }

    /// Adds the next face.
    pub(super) fn add_face(&mut self, rings: Vec<Vec<usize>>, object: ObjectId, material: MaterialId) {
        self.builder.add_face(FaceSpec { rings, object, material });
    }

    /// Notes what is wrong with a face that is added later.
    pub(super) fn refuse_face(&mut self, place: Place, what: impl Display) {
        self.refuse(place, what);
    }

    /// Adds the next face, which cannot be used for what was noted, `why` at first: it keeps its number. `rings` are its corners as far
    /// as they are known.
    pub(super) fn add_broken_face(
        &mut self,
        why: String,
        rings: Vec<Vec<usize>>,
        object: ObjectId,
        material: MaterialId,
    ) {
        if self.drops {
            return self.builder.add_unreadable_face(FaceSpec { rings, object, material }, why);
        }
        // For the messages about the others.
        let stand_in = match self.stand_in {
            Some(vertex) => vertex,
            None => self.builder.add_vertex(DVec3::ZERO),
        };
        self.stand_in = Some(stand_in);
        self.add_face(vec![vec![stand_in; 3]], object, material);
    }

    /// Ends with what is wrong.
    pub(super) fn into_error(mut self) -> ReadError {
        self.faults.sort();
        ReadError::Invalid(self.faults)
    }

    /// Builds the scene, or says all that is wrong. The closures tell where a face is, and where a material is
    /// defined, if it is.
    pub(super) fn finish(
        mut self,
        face: impl Fn(usize) -> Place,
        material: impl Fn(usize) -> Option<(String, Place)>,
    ) -> Result<Loaded, ReadError> {
        if self.has_bad_vertices {
            return Err(self.into_error());
        }
        let scene = match std::mem::take(&mut self.builder).build() {
            Ok(scene) if self.faults.is_empty() => scene,
            Ok(_) => return Err(self.into_error()),
            Err(error) => {
                for problem in &error.problems {
                    if let Some(cause) = problem.dropped_by() {
                        self.faults.note_cause(cause);
                    }
                    let (file, place) = match problem {
                        SceneProblem::BadMaterial { material: id, .. } => material(*id as usize),
                        _ => problem.polygon().map(|polygon| (self.name.to_owned(), face(polygon.index()))),
                    }
                    .unwrap_or_else(|| (self.name.to_owned(), Place::File));
                    self.faults.note(&file, place, problem);
                }
                return Err(self.into_error());
            }
        };
        let empty = || scene.polygons().filter(|polygon| polygon.shape() == Shape::Degenerate);
        if let Some(first) = empty().next() {
            let count = empty().count();
            let what = format_args!("this face has no area, {count} in all; they keep their numbers and hide nothing");
            self.warn(&face(first.id().index()), what);
        }
        if let Some((place, what)) = self.unusable.take() {
            let count = self.unusable_count;
            self.warn(&place, format_args!("{what} (faults of vertices and faces: {count} in all)"));
        }
        if scene.polygon_count() == 0 {
            self.warn(&Place::File, "there are no faces");
        }
        let place = |k: usize| {
            let (file, place) = material(k).unwrap_or_else(|| (self.name.to_owned(), Place::File));
            place.within(&file)
        };
        let material_places = (0..scene.materials().len()).map(place).collect();
        Ok(Loaded { scene, warnings: self.warnings, files: Vec::new(), material_places })
    }
}

/// How many corners of faces a file may unfold to by naming parts of itself again and again (instances of meshes,
/// templates): three for each of its bytes, or three times [`Unfolding::FACES`] if that is more.
#[derive(Debug)]
#[cfg(any(feature = "gltf", feature = "cityjson"))]
pub(super) struct Unfolding {
    left: u64,
    limit: u64,
}

#[cfg(any(feature = "gltf", feature = "cityjson"))]
impl Unfolding {
    /// So many triangles any file may have, however small it is.
    const FACES: u64 = 1 << 22;

    /// For a file of so many bytes, all that it refers to included.
    pub(super) fn of(bytes: u64) -> Self {
        let limit = 3 * bytes.clamp(Self::FACES, u64::from(u32::MAX));
        Self { left: limit, limit }
    }

    /// Takes so many corners off; otherwise says what the limit is.
    pub(super) fn take(&mut self, corners: u64) -> Result<(), String> {
        match self.left.checked_sub(corners) {
            Some(left) => {
                self.left = left;
                Ok(())
            }
            None => Err(format!(
                "it unfolds to more than {} corners of faces, the most for a file of this size; \
                 repeat fewer instances, or write them out",
                self.limit
            )),
        }
    }
}
