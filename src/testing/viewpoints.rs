//! Strategies for eyes: anywhere, or where they coincide with something of the scene.

use super::{Faces, Mode, point};
use glam::DVec3;
use proptest::prelude::*;
use proptest::sample::Index;

/// An eye anywhere.
pub fn free_viewpoint(mode: Mode) -> impl Strategy<Value = DVec3> {
    point(mode)
}

/// An eye on a vertex; the origin if there is none.
pub fn viewpoint_on_vertex(faces: &Faces) -> impl Strategy<Value = DVec3> + use<> {
    drawn(Kind::Vertex, faces)
}

/// An eye in the middle of an edge, up to rounding (none on a grid); the origin if there is none.
pub fn viewpoint_on_edge(faces: &Faces) -> impl Strategy<Value = DVec3> + use<> {
    drawn(Kind::Edge, faces)
}

/// An eye in the plane of a face, inside or outside of the face, up to rounding (none on a grid); the
/// origin if there is none.
pub fn viewpoint_in_plane(faces: &Faces) -> impl Strategy<Value = DVec3> + use<> {
    drawn(Kind::Plane, faces)
}

/// An eye of any of these kinds.
pub fn viewpoint(mode: Mode, faces: &Faces) -> impl Strategy<Value = DVec3> + use<> {
    let faces = faces.clone();
    eye(mode).prop_map(move |eye| eye.among(&faces))
}

fn drawn(kind: Kind, faces: &Faces) -> impl Strategy<Value = DVec3> + use<> {
    let faces = faces.clone();
    eye_of(Just(kind), Just(DVec3::ZERO)).prop_map(move |eye| eye.among(&faces))
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    Free,
    Vertex,
    Edge,
    Plane,
}

/// An eye before it is known which scene it looks at.
#[derive(Clone, Copy, Debug)]
pub(super) struct Eye {
    kind: Kind,
    free: DVec3,
    face: Index,
    corner: Index,
    steps: [i8; 2],
}

/// Eyes of all kinds.
pub(super) fn eye(mode: Mode) -> impl Strategy<Value = Eye> {
    let kind =
        prop_oneof![3 => Just(Kind::Free), 1 => Just(Kind::Vertex), 1 => Just(Kind::Edge), 2 => Just(Kind::Plane)];
    eye_of(kind, point(mode))
}

fn eye_of(kind: impl Strategy<Value = Kind>, free: impl Strategy<Value = DVec3>) -> impl Strategy<Value = Eye> {
    (kind, free, any::<Index>(), any::<Index>(), [-2i8..=4, -2i8..=4])
        .prop_map(|(kind, free, face, corner, steps)| Eye { kind, free, face, corner, steps })
}

impl Eye {
    /// Its place for a scene.
    pub(super) fn among(&self, faces: &Faces) -> DVec3 {
        if matches!(self.kind, Kind::Free) || faces.is_empty() {
            return self.free;
        }
        let corners = self.face.get(faces.loops());
        if corners.is_empty() {
            return self.free;
        }
        let first = self.corner.index(corners.len());
        let [a, b, c] = [0, 1, 2].map(|k| corners[(first + k) % corners.len()]);
        let eye = match self.kind {
            Kind::Free => self.free,
            Kind::Vertex => a,
            Kind::Edge => a * 0.5 + b * 0.5,
            // Quarters of a step lie inside of the face, too.
            Kind::Plane => {
                a + (b - a) * (f64::from(self.steps[0]) * 0.25) + (c - a) * (f64::from(self.steps[1]) * 0.25)
            }
        };
        if eye.is_finite() { eye } else { self.free }
    }
}
